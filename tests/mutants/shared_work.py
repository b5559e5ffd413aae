"""Changes to how work is shared between cores, and to how plain lines of numbers are read."""

from __future__ import annotations

from mutant import Mutant

SHARED_WORK = (
    Mutant("cores.py", "copies work for nothing", "found |= copy.found()", "copy.found()", ("test_cores.py",)),
    Mutant(
        "cores.py", "an error here is not looked for before", "with suppress(Exception):  # it comes",
        "with suppress(OSError):  # it comes", ("test_cores.py",),
    ),
    Mutant(
        "cores.py", "beside threads copies are made", " or threading.active_count() > 1", "", ("test_cores.py",),
    ),
    Mutant(
        "handed_back.py", "everything is sent back", "return id(value) if id(value) in self._held else None",
        "return None", ("test_cores.py",),
    ),
    Mutant(
        "feet/prepare.py", "a lower cutoff is not used where all was done", "if cutoff < highest or None in done:",
        "if None in done:", ("feet/test_prepare.py",),
    ),
    Mutant(
        "logs/inputs.py", "packed files may come in any order",
        "if plain else np.inf", "if True else np.inf",
        ("feet/test_shared_work.py",),
    ),
    Mutant(
        "logs/readers/tables/csv_file.py", "plain lines are counted anew in each piece", "count += plain",
        "count = plain", ("logs/readers/test_tables_in_pieces.py",),
    ),
)  # fmt: skip
