"""The campaign's own figures: postures (3 and 5), ways of the zero-moment point (4 and 6), the simulator's answer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from plantar.campaign.replay import IDENTIFIED, RIGID, best_guess
from plantar.campaign.run import Campaign
from plantar.contact.balance import measured_balance
from plantar.motions import Plan, planned_balance
from plantar.report.figures.paper import Plate
from plantar.report.figures.plots import zmp
from plantar.report.figures.robot_drawing import Box, stances
from plantar.report.figures.simulation import replays, zmp_planned
from plantar.robot.model import RobotModel
from plantar.twin.play import planned
from plantar.twin.replay import Replayed
from plantar.twin.robots import hrp2
from plantar.twin.robots.description import Description
from plantar.twin.robots.from_robot import describe

TILTS: Final = (("Tilt1", "A: regular"), ("Tilt2", "B: right leg aside"), ("Tilt3", "C: right leg forward"))
SWAYS: Final = (
    ("Manual_right_roll", "D and G"),
    ("Manual_right_pitch", "E and G"),
    ("Manual_left_roll", "D and F"),
    ("Manual_left_pitch", "E and F"),
    ("Manual_both_pitch", "E and A"),
)
LOCI: Final = (
    ("Tilt1", 4, "a"), ("Tilt3", 4, "b"), ("Manual_right_pitch", 6, "a"), ("Manual_left_roll", 6, "b"),
)  # fmt: skip
CORNERS: Final = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
MILLI: Final = 1e3


def plates(campaign: Campaign) -> list[Plate]:
    """Every figure of the campaign that needs more than a result: postures, balance, simulator."""
    names = set(campaign.logs)
    made = [
        _postures(campaign.robot, shown, number, title)
        for number, title, group in (
            (3, "Initial states of the tilting motions", TILTS),
            (5, "Initial states of the manual sways", SWAYS),
        )
        if (shown := [one for one in group if one[0] in names])
    ]
    made += [_locus(campaign, *locus) for locus in LOCI if locus[0] in names]
    if campaign.replays:
        made.append(_simulated(campaign.replays, best_guess(campaign.replayed)))
    return made


def boxes(look: Description, plan: Plan) -> list[Box]:
    """The robot's boxes in the world where a plan begins."""
    order = [plan.joints.index(name) for name in look.joint_names]
    base = plan.base[0]
    found = []
    for body, (rotation, origin) in zip(look.bodies, look.placements(plan.positions[0, order]), strict=True):
        for shape in body.shapes:
            corners = (shape.xyz + CORNERS * shape.size) @ rotation.T + origin
            found.append(Box(corners @ base[:3, :3].T + base[:3, 3], side_of(body.name)))
    return found


def look_of(robot: RobotModel) -> Description:
    """Boxes of the HRP-2-like robot, rods of any other."""
    return hrp2.look(robot) or describe(robot)


def side_of(body: str) -> str:
    """The side of an HRP-2-like robot's body by its name."""
    return {"R": "right", "L": "left"}.get(body[0], "") if body[1:4] in ("LEG", "ARM") else ""


def _postures(robot: RobotModel, named: Sequence[tuple[str, str]], number: int, title: str) -> Plate:
    look = look_of(robot)
    drawn = [(f"{motion}\n{state}", boxes(look, planned(motion, robot))) for motion, state in named]
    caption = "As planned, on rigid feet; right limbs red, left limbs blue."
    name = f"figure{number:02d}_postures"
    return Plate(name, number, f"Figure {number}. {title}.", caption, stances(drawn))


def _locus(campaign: Campaign, motion: str, number: int, letter: str) -> Plate:
    plan = planned(motion, campaign.robot)
    measured = measured_balance(campaign.robot, campaign.logs[motion], plan.stance)
    least = measured.worst()[1]
    caption = f"At least {MILLI * least:.0f} mm inside the support polygon. "
    feet = dict(measured.outlines)
    if plan.hand is None:
        wanted = planned_balance(campaign.robot, plan).zmp
        drawing = zmp_planned(measured.zmp, wanted, feet, measured.polygon)
        caption += "Measured by the feet's force sensors; planned by inverse dynamics on rigid feet."
    else:
        drawing = zmp(measured.zmp, feet, measured.polygon)
        caption += "Measured by the foot's force sensor; the robot keeps still, the operator's hand moves it."
    title = f"Figure {number}{letter}. Zero-moment point of {motion}."
    return Plate(f"figure{number:02d}{letter}_zmp_{motion}", number, title, caption, drawing)


def _simulated(found: Sequence[Replayed], guess: str | None) -> Plate:
    shown = [name for name in (IDENTIFIED, RIGID, guess) if name]
    caption = (
        "Recorded, and the same joint motion in the simulator on identified feet, rigid feet and "
        f"the best of the guesses{f' ({guess})' if guess else ''}. A recorded attitude's bias and slow drift, a "
        "straight line in time, are taken out of each; zeros of the torques from the first second."
    )
    drawing = replays([one for one in found if one.feet in shown], IDENTIFIED)
    return Plate("simulator", None, "The campaign in a simulator.", caption, drawing)
