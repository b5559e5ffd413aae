"""The feet to compare as MuJoCo scenes of one motion: the model as it was, and what the exporters make of it."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Final

from plantar.exporters.bush import FootBush, check_swing, feet_of_result
from plantar.exporters.contact import target as contact
from plantar.exporters.job import Job
from plantar.exporters.mjcf import target as joints
from plantar.exporters.source import open_result
from plantar.motions.plan import Plan
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.twin.robots.foot import cut_feet
from plantar.twin.robots.from_robot import describe
from plantar.twin.simulation.physics import Physics
from plantar.twin.simulation.rollout import scene_xml

AS_IT_WAS: Final = "rigid, as the model was"
JOINTS: Final = "exported joints"
CONTACT: Final = "exported contact"
KINDS: Final = (AS_IT_WAS, JOINTS, CONTACT)
RIGID: Final = Physics(bushes=None)


def scenes(
    result: FeetResult, robot: RobotModel, plan: Plan, swing: float | None = None
) -> Mapping[str, str]:
    """MJCF by kind of feet, each of the scene that `plan` is played on.

    The exporters extend the rigid scene as they extend a user's model: what is compared is what they write.
    """
    check_swing(swing)
    data, base = open_result(result)
    rigid = scene_xml(robot, plan, RIGID)
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / "rigid.xml"
        model.write_text(rigid)

        def job(hysteresis: bool) -> Job:
            feet, remarks = feet_of_result(data, base, with_offset=False, hysteresis=hysteresis, swing=swing)
            moved = tuple(_on_twin(foot, robot) for foot in feet)
            return Job(data, moved, model, model.with_name("out.xml"), False, remarks)

        return {
            AS_IT_WAS: rigid,
            JOINTS: joints.write(job(joints.HYSTERESIS))[0],
            CONTACT: contact.write(job(False))[0],
        }


def _on_twin(foot: FootBush, robot: RobotModel) -> FootBush:
    """The same bush on the scene's body of that foot, whose frame and name are the twin's."""
    description = describe(robot)
    cut = cut_feet(description, robot)[foot.name]
    rotation, centre = cut.bush[:3, :3], cut.bush[:3, 3]
    sole = cut.corners @ rotation.T + centre
    ankle = description.bodies[cut.place].name
    return replace(foot, ankle=ankle, centre=centre, rotation=rotation, sole=sole)
