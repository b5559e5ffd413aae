"""Numbers and units as people read them."""

from __future__ import annotations

import math
from typing import Final

MISSING: Final = "–"

LARGE: Final = 1e7
"""From here on numbers have an exponent."""

_UNITS: Final = {
    "1": "",
    "N.m/rad": "N·m/rad",
    "N.m/rad3": "N·m/rad³",
    "N.m.s/rad": "N·m·s/rad",
    "N.s/m": "N·s/m",
    "kg.m2": "kg·m²",
}


def unit(name: str) -> str:
    """A contract unit in print: `N.m/rad` -> `N·m/rad`; nothing for a number without a unit."""
    return _UNITS.get(name, name.replace(".", "·"))


def number(value: float | None, digits: int = 4) -> str:
    """`digits` significant digits, an exponent only for odd sizes; a dash for none, NaN or infinity."""
    if value is None or not math.isfinite(value):
        return MISSING
    if value == 0:
        return "0"
    magnitude = math.floor(math.log10(abs(value)))
    if not -4 <= magnitude < digits + 3:
        mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
        return _minus(f"{mantissa}e{int(exponent)}")
    return _minus(f"{value:.{max(0, digits - 1 - magnitude)}f}")


def decimals_for(uncertainty: float) -> int:
    """Decimals that show `uncertainty` with one digit, or two where the first is 1 or 2.

    From ten on always two: negative decimals, as `round` takes them.
    """
    exponent = math.floor(math.log10(uncertainty))
    leading = uncertainty / 10.0**exponent
    return min(12, (1 if leading < 2.95 or exponent > 0 else 0) - exponent)


def with_uncertainty(value: float | None, half_width: float | None) -> str:
    """`480.0 ± 1.1`: the value rounded to the digits that its uncertainty leaves."""
    if value is None or not math.isfinite(value):
        return MISSING
    if half_width is None or not math.isfinite(half_width) or half_width <= 0:
        return number(value)
    if half_width < 1e-6:
        return f"{number(value)} ± {number(half_width, 2)}"
    return " ± ".join(_alike((value, half_width), half_width))


def interval(bounds: tuple[float, float] | None) -> str:
    """`947.0 to 951.4`, rounded to the digits that the width leaves."""
    if bounds is None or not all(map(math.isfinite, bounds)):
        return MISSING
    low, high = bounds
    if high <= low or high - low < 1e-6:
        return f"{number(low)} to {number(high)}"
    # Under a common exponent an end near zero needs a digit more, or nothing is left of it.
    finer = 10 if max(abs(low), abs(high)) >= LARGE else 1
    return " to ".join(_alike((low, high), (high - low) / 2 / finer))


def _alike(values: tuple[float, float], uncertainty: float) -> list[str]:
    """Both values with the decimals that the uncertainty leaves; large ones with the same exponent."""
    largest = max(map(abs, values))
    exponent = math.floor(math.log10(largest)) if largest >= LARGE else 0
    scale = 10.0**exponent
    decimals, mark = decimals_for(uncertainty / scale), f"e{exponent}" if exponent else ""
    rounded = (round(value / scale, decimals) for value in values)
    return [_minus(f"{value:.{max(0, decimals)}f}{mark}") for value in rounded]


def percent(value: float | None) -> str:
    """A percentage with two digits, `0.31 %`."""
    return MISSING if value is None or not math.isfinite(value) else f"{number(value, 2)} %"


def _minus(text: str) -> str:
    """With the sign that is as wide as a plus; none before what is rounded to zero."""
    return text.replace("-", "−") if float(text) else text.removeprefix("-")
