"""What a caller may choose, checked where it is chosen: a wrong choice is one line that names the valid ones."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable
from typing import TypeVar

from plantar.errors import SettingsError

Settings = TypeVar("Settings")


def one_of(name: str, value: object, choices: Iterable[str]) -> None:
    """Raise SettingsError unless `value` is one of `choices`; `name` is what the caller set."""
    known = tuple(choices)
    if not isinstance(value, str) or value not in known:
        raise SettingsError(f"{name} is not a choice", value=value, valid=", ".join(known))


def nearest(name: str, names: Iterable[str], most: int = 5) -> str:
    """What may have been meant by a wrong name, as an error's `valid`; the first of the names where none is like it."""
    known = list(names)
    return ", ".join(difflib.get_close_matches(name, known, n=3) or known[:most])


def settings_of(given: Settings | None, kind: type[Settings]) -> Settings:
    """The settings given, or the defaults of that kind. SettingsError where something else is given, such as a dict."""
    if given is None:
        return kind()
    if not isinstance(given, kind):
        valid = f"plantar.{kind.__name__}(...)"
        raise SettingsError("settings are not settings", value=type(given).__name__, valid=valid)
    return given


def number_in(
    name: str, value: object, low: float, high: float, unit: str, *, optional: str | None = None
) -> None:
    """Raise SettingsError unless `value` is a number from `low` to `high` [`unit`].

    optional: what None stands for; where it is left out, None is an error.
    """
    if value is None and optional is not None:
        return
    number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    if not number or not low <= float(value) <= high:  # type: ignore[arg-type]
        valid = f"{low:g} to {high:g} {unit}" if math.isfinite(high) else f"at least {low:g} {unit}"
        valid += "" if optional is None else f", or None: {optional}"
        raise SettingsError(f"{name} is not valid", value=value, valid=valid)
