"""What plantar says when it cannot go on.

Every error that a user can cause is a `PlantarError`: one line that names the file, the column, the time and
the value, and says what would be valid. The command line prints that line and exits with 1.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

SIX_DIGITS = 1e5  # s: of more, six digits leave whole seconds


def clock(time: float) -> str:
    """A log's time [s] in a message: to six digits, or to so many that an epoch's clock tells milliseconds."""
    return f"{time:.6g}" if abs(time) < SIX_DIGITS else f"{time:.13g}"


class PlantarError(Exception):
    """A problem with the input that the user can mend; the message is one line. The kinds below are all of this.

    Args: what is wrong; the line has it in a fixed order: `path`, `column`, `time` [s], `value`, message, what would be
        `valid`.

    Example:
        >>> import plantar
        >>> try:
        ...     plantar.open_log("nowhere.csv")
        ... except plantar.PlantarError as error:
        ...     print(error)
        nowhere.csv: does not exist
    """

    def __init__(
        self,
        message: str,
        *,
        path: str | os.PathLike[str] | None = None,
        column: str | None = None,
        time: float | None = None,
        value: object | None = None,
        valid: str | None = None,
    ) -> None:
        where = [str(path)] if path is not None else []
        if column is not None:
            where.append(f"column '{column}'")
        if time is not None:
            where.append(f"t = {clock(time)} s")
        if value is not None:
            where.append(f"value {value!r}" if isinstance(value, str) else f"value {value}")
        line = ": ".join([", ".join(where), message] if where else [message])
        if valid is not None:
            line += f" (valid: {valid})"
        super().__init__(" ".join(line.split()))


class RobotError(PlantarError):
    """The robot file or its URDF is wrong."""


class LogError(PlantarError):
    """A log cannot be read or does not hold what is needed."""


class NoRoom(LogError):
    """A log does not fit in the memory that it may take: another machine, or another `memory`, would read it."""


class DataError(PlantarError):
    """The logs are readable, but what is asked cannot be computed from them."""


class SettingsError(PlantarError):
    """A setting is not one of its choices, or out of its range."""


class MotionError(PlantarError):
    """A planned motion cannot be played: out of reach, out of limits or out of balance; then `fell` says when [s]."""

    def __init__(self, message: str, *, fell: float | None = None, **where: Any) -> None:
        super().__init__(message, **where)
        self.fell = fell


class ExportError(PlantarError):
    """A result cannot be written to the target asked for."""


class MissingExtra(PlantarError):
    """An optional dependency is not installed."""

    def __init__(self, package: str, extra: str, purpose: str) -> None:
        super().__init__(f"{purpose} needs the package '{package}': pip install 'plantar[{extra}]'")


@contextmanager
def needs(package: str, extra: str, purpose: str) -> Iterator[None]:
    """A `with` block that imports an optional dependency. Raises MissingExtra where it is not installed.

    package: to name where the import does not say which is missing. extra: of plantar, that brings it.
    """
    try:
        yield
    except ImportError as error:
        raise MissingExtra(error.name or package, extra, purpose) from error
