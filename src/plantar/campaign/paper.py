"""What the paper reports, as data to set results beside.

Mikami, Moulard, Yoshida, Venture: "Study on Dynamics Identification of the Foot Viscoelasticity of a Humanoid
Robot", tables 1 to 3 (HRP-2, composed motion of four manual sways and Tilt3).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

Place = tuple[str, str]  # foot, axis


@dataclass(frozen=True)
class Published:
    """A number of table 1 with the relative standard deviation beside it [%]."""

    value: float
    relative_std_percent: float


@dataclass(frozen=True)
class PublishedError:
    """A row of table 2: mean error, largest torque [N·m], and the one in percent of the other."""

    mean_abs_error: float
    max_abs: float
    percent_of_max: float


# Stiffness [N·m/rad], damping [N·m·s/rad] and offset [N·m].
TABLE_1: Final[Mapping[tuple[str, str, str], Published]] = MappingProxyType(
    {
        ("right", "pitch", "stiffness"): Published(434.0, 0.2),
        ("right", "pitch", "damping"): Published(15.89, 4.2),
        ("right", "pitch", "offset"): Published(4.79, 0.6),
        ("right", "roll", "stiffness"): Published(323.0, 0.3),
        ("right", "roll", "damping"): Published(17.53, 2.8),
        ("right", "roll", "offset"): Published(-0.05, 38.6),
        ("left", "pitch", "stiffness"): Published(480.0, 0.3),
        ("left", "pitch", "damping"): Published(24.27, 2.4),
        ("left", "pitch", "offset"): Published(5.66, 0.6),
        ("left", "roll", "stiffness"): Published(352.0, 0.3),
        ("left", "roll", "damping"): Published(28.15, 1.6),
        ("left", "roll", "offset"): Published(-4.12, 0.6),
    }
)

TABLE_2: Final[Mapping[Place, PublishedError]] = MappingProxyType(
    {
        ("right", "pitch"): PublishedError(6.54, 70.1, 9.3),
        ("left", "pitch"): PublishedError(7.54, 60.7, 12.4),
        ("right", "roll"): PublishedError(3.78, 20.9, 18.1),
        ("left", "roll"): PublishedError(4.85, 26.7, 18.2),
    }
)

# Mean error of the reconstructed torque [N·m], by motion; right pitch, left pitch, right roll, left roll.
_ERRORS: Final = {
    "Tilt1": (0.79, 0.49, 0.95, 2.47),
    "Squat": (0.38, 0.78, 0.65, 2.39),
    "Myrand4": (2.16, 0.83, 1.08, 1.10),
    "Manual_both_pitch": (1.99, 1.33, 1.35, 2.03),
}
TABLE_3: Final[Mapping[str, Mapping[Place, float]]] = MappingProxyType(
    {motion: dict(zip(TABLE_2, errors, strict=True)) for motion, errors in _ERRORS.items()}
)
