"""A robot moving on its bushes, a page to turn and zoom: the campaign's as measured, a designed motion as rehearsed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from plantar.campaign.pictures import look_of, side_of
from plantar.campaign.run import Campaign
from plantar.conventions import ROTATIONAL_AXES, Array
from plantar.motions.plan import Plan
from plantar.report.scene import SceneBody, SceneFoot, SceneMotion, write_scene
from plantar.results.residuals import Track, read_residuals, residuals_path
from plantar.robot.model import RobotModel
from plantar.twin.play import planned
from plantar.twin.robots.description import Description
from plantar.twin.robots.foot import CutFoot, cut_feet

# What stands for the ankle's plate: share of the sole, thickness and height above the bush [m].
PLATE = (0.8, 0.014, 0.012)


def write_campaign_scene(campaign: Campaign, path: Path) -> Path:
    """Write the page of every motion; needs the residuals that the campaign saved."""
    look = look_of(campaign.robot)
    source = residuals_path(campaign.directory)
    tracks = read_residuals(source) if source is not None else ()
    motions = [
        _motion(campaign, look, name, [t for t in tracks if t.motion == name]) for name in campaign.logs
    ]
    return _write(path, campaign.robot, look, motions)


def write_plan_scene(robot: RobotModel, plan: Plan, bushes: Mapping[str, Array], path: Path) -> Path:
    """Write the page of one plan; `bushes`: by foot, pitch and roll (N, 2) [rad] at the plan's times."""
    look = look_of(robot)
    positions = plan.positions[:, [plan.joints.index(joint) for joint in look.joint_names]]
    motion = SceneMotion(plan.name, plan.time, positions, dict(bushes), dict(plan.stance))
    return _write(path, robot, look, [motion])


def _write(path: Path, robot: RobotModel, look: Description, motions: Sequence[SceneMotion]) -> Path:
    feet = cut_feet(look, robot)
    shown = [_foot(robot, foot) for foot in feet.values()]
    return write_scene(path, f"{robot.name} on its bushes", _bodies(look, feet, robot), shown, motions)


def _bodies(look: Description, feet: dict[str, CutFoot], robot: RobotModel) -> list[SceneBody]:
    plates = {foot.place: _plate(robot, foot) for foot in feet.values()}
    made = []
    for place, body in enumerate(look.bodies):
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = body.rotation, body.xyz
        shapes = [plates[place]] if place in plates else [(shape.xyz, shape.size) for shape in body.shapes]
        slides, side = body.kind == "prismatic", side_of(body.name)
        made.append(SceneBody(body.parent, pose, body.axis, slides, tuple(shapes), side))
    return made


def _plate(robot: RobotModel, foot: CutFoot) -> tuple[Array, Array]:
    """A plate above the bush in place of the whole foot link, so that the sole is seen to move."""
    share, thickness, above = PLATE
    size = share * np.ptp(robot.feet[foot.name].sole.polygon, axis=0)
    return foot.bush[:3, 3] + [0.0, 0.0, above], np.array([*size, thickness])


def _foot(robot: RobotModel, foot: CutFoot) -> SceneFoot:
    polygon = robot.feet[foot.name].sole.polygon
    corners = np.column_stack([polygon, np.zeros(len(polygon))])
    return SceneFoot(foot.name, foot.place, foot.bush, np.linalg.inv(foot.bush) @ foot.sole, corners)


def _motion(campaign: Campaign, look: Description, name: str, tracks: Sequence[Track]) -> SceneMotion:
    log, robot = campaign.logs[name], campaign.robot
    order = [list(robot.joint_names).index(joint) for joint in look.joint_names]
    bushes = {track.foot: _bush(track, log.time) for track in tracks}
    stance = planned(name, robot).stance
    return SceneMotion(name, log.time, log.positions(robot)[:, order], bushes, stance)


def _bush(track: Track, time: Array) -> Array:
    """Pitch and roll (N, 2) at `time`; zero where the foot is in the air."""
    air = track.support == "air"
    angles = [
        np.where(air, 0.0, np.nan_to_num(track.values[f"{axis}.deflection"])) for axis in ROTATIONAL_AXES
    ]
    return np.column_stack([np.interp(time, track.time, angle) for angle in angles])
