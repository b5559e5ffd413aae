"""The option `--memory` of every command that reads logs."""

from __future__ import annotations

import re
from typing import Annotated

import typer

UNITS = {"": 1, "K": 10**3, "M": 10**6, "G": 10**9, "T": 10**12}
SIZE = re.compile(r"(\d+(?:\.\d*)?)\s*([KMGT]?)B?", re.IGNORECASE)
HELP = (
    "Most memory for the numbers of the logs, such as 500MB or 8GB. If left out: a quarter of this machine's memory. "
    "A log that holds more is refused before it is read."
)


def size_in_bytes(text: str) -> int:
    """A size as people write it, in bytes. Raises typer.BadParameter."""
    found = SIZE.fullmatch(text.strip())
    size = int(float(found[1]) * UNITS[found[2].upper()]) if found else 0
    if size < 1:
        raise typer.BadParameter(f"'{text}' is not a size (valid: 500MB, 8GB, ...)")
    return size


Memory = Annotated[int | None, typer.Option("--memory", parser=size_in_bytes, metavar="SIZE", help=HELP)]
