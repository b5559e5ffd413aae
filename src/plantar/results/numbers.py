"""Numbers and units as people read them."""

from __future__ import annotations

import math
from typing import Final

MISSING: Final = "–"

_UNITS: Final = {
    "N.m/rad": "N·m/rad",
    "N.m/rad3": "N·m/rad³",
    "N.m.s/rad": "N·m·s/rad",
    "N.s/m": "N·s/m",
    "kg.m2": "kg·m²",
}


def unit(name: str) -> str:
    """A contract unit in print: `N.m/rad` -> `N·m/rad`."""
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
    """Decimals that show `uncertainty` with one digit, or two where the first is 1 or 2."""
    exponent = math.floor(math.log10(uncertainty))
    leading = uncertainty / 10.0**exponent
    return min(12, max(0, (1 if leading < 2.95 else 0) - exponent))


def with_uncertainty(value: float | None, half_width: float | None) -> str:
    """`480.0 ± 1.1`: the value rounded to the digits that its uncertainty leaves."""
    if value is None or not math.isfinite(value):
        return MISSING
    if half_width is None or not math.isfinite(half_width) or half_width <= 0:
        return number(value)
    if abs(value) >= 1e7 or half_width < 1e-6:
        return f"{number(value)} ± {number(half_width, 2)}"
    decimals = decimals_for(half_width)
    return _minus(f"{value:.{decimals}f} ± {half_width:.{decimals}f}")


def interval(bounds: tuple[float, float] | None) -> str:
    """`947.0 to 951.4`, rounded to the digits that the width leaves."""
    if bounds is None or not all(map(math.isfinite, bounds)):
        return MISSING
    low, high = bounds
    if high <= low or max(abs(low), abs(high)) >= 1e7 or high - low < 1e-6:
        return f"{number(low)} to {number(high)}"
    decimals = decimals_for((high - low) / 2)
    return _minus(f"{low:.{decimals}f} to {high:.{decimals}f}")


def percent(value: float | None) -> str:
    """A percentage with two digits, `0.31 %`."""
    return MISSING if value is None or not math.isfinite(value) else f"{number(value, 2)} %"


def _minus(text: str) -> str:
    return text.replace("-", "−")
