"""The feet to compare as MuJoCo scenes of one motion: the model as it was, and what the exporters make of it."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType
from typing import Any, Final

from plantar.exporters.bush import FootBush, check_swing, feet_of_result
from plantar.exporters.contact import target as contact
from plantar.exporters.contact.hysteresis import FootHysteresis
from plantar.exporters.job import USUAL, Job, Stance, asked
from plantar.exporters.mjcf import target as joints
from plantar.exporters.source import open_result
from plantar.motions.plan import Plan
from plantar.notes import Notes
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.twin.robots.foot import cut_feet
from plantar.twin.robots.from_robot import describe
from plantar.twin.simulation.physics import Physics
from plantar.twin.simulation.rollout import scene_xml
from plantar.twin.simulation.stepping import Force

AS_IT_WAS: Final = "rigid, as the model was"
JOINTS: Final = "exported joints"
CONTACT: Final = "exported contact"
WITH_LOOP: Final = "contact, loop"
RIGID: Final = Physics(bushes=None)


@dataclass(frozen=True)
class Played:
    """One kind of feet: its scene as `xml`, how much `lower` the robot stands on it [m], and the `force` that the loop
    applies, as of `roll_out`."""

    xml: str
    lower: float = 0.0
    force: Callable[[Any], Force] | None = None


def scenes(
    result: FeetResult,
    robot: RobotModel,
    plan: Plan,
    swing: float | None,
    stance: Stance,
    tips: bool,
) -> Mapping[str, Played]:
    """By kind of feet, the scene that `plan` is played on; `WITH_LOOP` only of rubber that slips or a sole that tips.

    The exporters extend the rigid scene as they extend a user's model: what is compared is what they write.

    Args:
        result: of `identify_feet`. robot, plan: that are played.
        swing, stance: as of `plantar.export`, for the contact. tips: whether a sole stands on its edge.
    """
    check_swing(swing)
    data, base = open_result(result)
    rigid = scene_xml(robot, plan, RIGID)
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / "rigid.xml"
        model.write_text(rigid)

        def job(target: ModuleType, hysteresis: bool, swing: float | None, stance: Stance) -> Job:
            kept = asked(target, CONTACT, hysteresis, swing, stance)
            feet, remarks = feet_of_result(data, base, with_offset=False, hysteresis=kept, swing=swing)
            moved = tuple(_on_twin(foot, robot) for foot in feet)
            return Job(data, moved, model, model.with_name("out.xml"), False, remarks, stance, kept)

        points, slipping = job(contact, False, swing, stance), job(contact, True, None, stance)
        lower = min(foot.sole_depth for foot in points.feet) if stance.pivot == "bush" else 0.0
        made = {
            AS_IT_WAS: Played(rigid),
            JOINTS: Played(joints.write(job(joints, False, None, USUAL), Notes())),
            CONTACT: Played(contact.write(points, Notes()), lower),
        }
        if tips or any(spring.slip for foot in slipping.feet for spring in foot.springs):
            made[WITH_LOOP] = Played(contact.write(slipping, Notes()), lower, FootHysteresis)
        return made


def _on_twin(foot: FootBush, robot: RobotModel) -> FootBush:
    """The same bush on the scene's body of that foot, whose frame and name are the twin's."""
    description = describe(robot)
    cut = cut_feet(description, robot)[foot.name]
    rotation, centre = cut.bush[:3, :3], cut.bush[:3, 3]
    sole = cut.corners @ rotation.T + centre
    ankle = description.bodies[cut.place].name
    return replace(foot, ankle=ankle, centre=centre, rotation=rotation, sole=sole)
