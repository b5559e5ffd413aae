"""HRP-2 as published: joints, limits, geometry, totals; and what had to be chosen between the facts.

No public model of HRP-2 gives its links' masses. Torque and velocity limits, the first guess of the masses and the
boxes' sizes are chosen; everything else is published.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from plantar.motions.campaign import Postures

Vector = tuple[float, float, float]


class Row(NamedTuple):
    """A joint and the link that it carries: axis, origin in the parent [m], limits [rad], torque [N·m] and speed
    [rad/s]; the link's mass [kg], the centre and the size of its box [m]."""

    axis: Vector
    xyz: Vector
    limits: tuple[float, float]
    effort: float
    velocity: float
    mass: float
    centre: Vector
    size: Vector


NAME: Final = "hrp2_like"
MASS: Final = 56.87  # kg
HALF_SITTING_HEIGHT: Final = 0.648702  # waist above the ground [m]
CENTRE_OF_MASS: Final = (0.0136, 0.0015, 0.8077)  # half-sitting, over the middle of the feet [m]
INERTIA: Final = (8.16, 6.94, 1.73)  # half-sitting, about the centre of mass [kg·m²]
SOLE_SIZE: Final = (0.2172, 0.138)  # m
SOLE_HEIGHT: Final = -0.105  # below the ankle [m]
BUSH_HEIGHT: Final = -0.085  # below the ankle [m]
IMU_LINK: Final = "CHEST_LINK1"
IMU_XYZ: Final = (-0.13, 0.0, 0.118)

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)

# the right side; the left mirrors y, and the limits of yaw and roll
LEG: Final = (
    Row(Z, (0, -0.06, 0), (-0.785, 0.524), 120, 4.0, 0.9, (0, -0.02, 0.02), (0.08, 0.07, 0.09)),
    Row(X, (0, -0.035, 0), (-0.611, 0.349), 200, 4.0, 1.6, (-0.01, 0, 0.0), (0.10, 0.09, 0.10)),
    Row(Y, (0, 0, 0), (-2.182, 0.733), 260, 4.5, 3.9, (0.0, 0, -0.15), (0.10, 0.10, 0.28)),
    Row(Y, (0, 0, -0.3), (-0.035, 2.618), 260, 5.5, 2.5, (0.0, 0, -0.14), (0.09, 0.09, 0.26)),
    Row(Y, (0, 0, -0.3), (-1.309, 0.733), 200, 5.0, 0.6, (0, 0, 0.0), (0.07, 0.08, 0.07)),
    Row(X, (0, 0, 0), (-0.349, 0.611), 150, 5.0, 1.6, (0.0, 0, -0.085), (SOLE_SIZE[0], SOLE_SIZE[1], 0.04)),
)
ARM: Final = (
    Row(Y, (0.0, -0.25, 0.18), (-3.142, 1.047), 90, 5.0, 1.2, (0, 0.03, 0), (0.10, 0.12, 0.10)),
    Row(X, (0, 0, 0), (-1.658, 0.175), 80, 5.0, 0.7, (0, 0, -0.02), (0.08, 0.08, 0.10)),
    Row(Z, (0, 0, 0), (-1.606, 1.606), 60, 6.0, 1.3, (0, 0, -0.16), (0.08, 0.08, 0.18)),
    Row(Y, (0, 0, -0.25), (-2.391, 0.035), 60, 6.0, 0.7, (0, 0, -0.04), (0.07, 0.07, 0.12)),
    Row(Z, (0, 0, 0), (-1.606, 1.606), 25, 6.0, 0.8, (0, 0, -0.16), (0.06, 0.06, 0.14)),
    Row(Y, (0, 0, -0.25), (-1.606, 1.606), 20, 6.0, 0.4, (0, 0, -0.04), (0.06, 0.05, 0.08)),
    Row(X, (0, 0, -0.08), (-1.0, 1.0), 10, 6.0, 0.2, (0, 0, -0.04), (0.06, 0.03, 0.08)),
)
TRUNK: Final = (
    (
        "CHEST_JOINT0",
        Row(Z, (0.032, 0, 0.351), (-0.785, 0.785), 150, 3.0, 1.5, (0, 0, -0.06), (0.14, 0.16, 0.08)),
    ),
    (
        "CHEST_JOINT1",
        Row(Y, (0, 0, 0), (-0.087, 1.047), 200, 3.0, 15.5, (-0.02, 0, 0.12), (0.18, 0.30, 0.32)),
    ),
    ("HEAD_JOINT0", Row(Z, (-0.007, 0, 0.30), (-0.785, 0.785), 15, 5.0, 0.4, (0, 0, 0), (0.08, 0.08, 0.06))),
    ("HEAD_JOINT1", Row(Y, (0, 0, 0), (-0.524, 0.785), 15, 5.0, 1.6, (0.02, 0, 0.08), (0.17, 0.15, 0.20))),
)
WAIST: Final = (7.5, (-0.02, 0, 0.10), (0.16, 0.26, 0.20))

HALF_SITTING_LEG: Final = (0.0, 0.0, -0.453786, 0.872665, -0.418879, 0.0)
HALF_SITTING_ARM: Final = (0.261799, -0.17453, 0.0, -0.523599, 0.0, 0.0, 0.1)


def half_sitting() -> dict[str, float]:
    """Joint positions of the half-sitting posture [rad]."""
    posture = {name: 0.0 for name, *_ in TRUNK}
    for side, mirror in (("R", 1.0), ("L", -1.0)):
        for place, angle in enumerate(HALF_SITTING_LEG):
            posture[f"{side}LEG_JOINT{place}"] = angle
        for place, angle in enumerate(HALF_SITTING_ARM):
            mirrored = ARM[place].axis != Y
            posture[f"{side}ARM_JOINT{place}"] = angle * (mirror if mirrored else 1.0)
    return posture


def postures() -> Postures:
    """Half-sitting, and the arm states D (aside) and E (forward) of the manual sways."""
    aside = {"RARM_JOINT0": 0.0, "LARM_JOINT0": 0.0, "RARM_JOINT1": -0.8, "LARM_JOINT1": 0.8}
    forward = {"RARM_JOINT0": -0.7, "LARM_JOINT0": -0.7, "RARM_JOINT3": -0.6, "LARM_JOINT3": -0.6}
    return Postures(half_sitting(), aside, forward)
