"""A fault of plantar in the fit of one axis: that axis is given up with the reason, the others go on."""

from __future__ import annotations

import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from plantar.conventions import Axis
from plantar.errors import PlantarError
from plantar.notes import Note

PACKAGE = Path(__file__).resolve().parents[1]


@contextmanager
def gives_up(axis: Axis, reasons: dict[Axis, str]) -> Iterator[None]:
    """The work on one axis. What nobody thought of ends it and becomes the axis' entry in `reasons`.

    What a user can mend, a lack of memory, and warnings that somebody wants as errors are raised on.
    """
    try:
        yield
    except (PlantarError, MemoryError, Warning):
        raise
    except Exception as error:
        reasons[axis] = f"an error inside plantar, please report: {described(error)}"


def internal_errors(foot: str, reasons: dict[Axis, str]) -> tuple[Note, ...]:
    """One note for each axis of a foot that was given up."""
    return tuple(
        Note("internal_error", "warning", f"{foot} {axis}: {reason}") for axis, reason in reasons.items()
    )


def described(error: Exception) -> str:
    """Type, innermost place inside plantar, and message of an exception, in one line."""
    place = "outside plantar"
    for frame in traceback.extract_tb(error.__traceback__):
        path = Path(frame.filename).resolve()
        if path.is_relative_to(PACKAGE):
            place = f"in {path.relative_to(PACKAGE).as_posix()}, line {frame.lineno}"
    return " ".join(f"{type(error).__name__} {place}: {error}".split())
