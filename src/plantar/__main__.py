"""`python -m plantar` is `plantar`."""

from plantar.cli import main

main()
