"""Hysteresis of a bush in MuJoCo: what slips in the rubber is a joint with friction, bound to the bush by a tendon.

MuJoCo has no elastoplastic element, but its parts: a fixed tendon is a spring between the bush's angle and that of a
weightless body beside it, whose joint has a dry friction of the slip torque. Below that torque the body stands and the
tendon is a spring beside the bush's own; above it the body goes along. Together they are a Jenkins element.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Final

from plantar.exporters.bush import FootBush
from plantar.exporters.spring import Spring
from plantar.exporters.xml_file import child_of, numbers

# The slipping body's inertia is the tendon's stiffness times this squared. Heavier, it lags behind what it should
# slip; lighter, it creeps while it should stand: MuJoCo's dry friction lets slip_angle * IMPERFECT * step / time²
# pass. With 10 ms the angle of a bush alone is right to half a percent, at steps of 0.25 to 4 ms, and a step of 1 ms
# creeps by 0.1 percent of the slip angle a second.
SLIPPING_TIME: Final = 0.01  # s
IMPERFECT: Final = 1e-4  # of the friction, MuJoCo's least
MASS: Final = 1e-3  # kg: MuJoCo wants some
SIZE: Final = 0.005  # m: radius of the body that slips, which touches nothing


def slip_joint(foot: FootBush, spring: Spring) -> str:
    """Name of the joint that slips beside a bush's joint."""
    return f"{foot.joint(spring.axis)}_SLIP"


def set_slip(root: ET.Element, ankle: ET.Element, foot: FootBush, spring: Spring, step: float) -> None:
    """Give the bush's joint its slip; without one, a slip of an earlier export is left without force.

    Args:
        root: of the MJCF. ankle: its body. step: of the simulation [s].
    """
    name = slip_joint(foot, spring)
    joint = next((one for one in root.iter("joint") if one.get("name") == name), None)
    tendon = next((one for one in root.iter("fixed") if one.get("name") == name), None)
    if spring.slip is None and joint is None:
        return
    if joint is None:
        joint = _add_body(ankle, foot, spring)
    if tendon is None:
        tendon = _add_tendon(root, foot, spring)
    torque, stiffness = (spring.slip.torque, spring.slip.stiffness) if spring.slip is not None else (0.0, 0.0)
    joint.set("frictionloss", numbers([torque]))
    tendon.set("stiffness", numbers([stiffness]))
    if spring.slip is not None:
        joint.set("armature", numbers([stiffness * SLIPPING_TIME**2]))
        joint.set("solreffriction", numbers([2 * step, 1.0]))


def _add_body(ankle: ET.Element, foot: FootBush, spring: Spring) -> ET.Element:
    body = ET.SubElement(ankle, "body", name=f"{foot.name}_bush_{spring.axis}_slip")
    inertia = numbers([MASS * SIZE**2] * 3)
    ET.SubElement(body, "inertial", mass=numbers([MASS]), pos=numbers(foot.centre), diaginertia=inertia)
    # Every attribute that a default class of the model could set is written out.
    joint = ET.SubElement(
        body, "joint", name=slip_joint(foot, spring), type="hinge", pos=numbers(foot.centre),
        axis=numbers(foot.direction(spring.axis)), ref="0", limited="false", damping="0", stiffness="0",
        springdamper="0 0", solimpfriction=numbers([1 - IMPERFECT, 1 - IMPERFECT, 0.001, 0.5, 2.0]),
    )  # fmt: skip
    # MuJoCo weighs bodies by their shapes where the model says so.
    ET.SubElement(
        body, "geom", type="sphere", size=numbers([SIZE]), mass=numbers([MASS]), pos=numbers(foot.centre),
        contype="0", conaffinity="0", rgba="0 0 0 0",
    )  # fmt: skip
    return joint


def _add_tendon(root: ET.Element, foot: FootBush, spring: Spring) -> ET.Element:
    tendons = child_of(root, "tendon")
    still = {"springlength": "0", "damping": "0", "frictionloss": "0", "limited": "false"}
    tendon = ET.SubElement(tendons, "fixed", still, name=slip_joint(foot, spring))
    ET.SubElement(tendon, "joint", joint=foot.joint(spring.axis), coef="1")
    ET.SubElement(tendon, "joint", joint=slip_joint(foot, spring), coef="-1")
    return tendon
