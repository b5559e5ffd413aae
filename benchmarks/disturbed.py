"""The composed motion disturbed: slippery seconds and shoves of an operator, and what the soles truly did.

Every seed has its own slippery seconds and shoves of the operator's hand, put into the paper's composed motion. The
truth is what the soles did in the exact simulation, not when the floor was slippery: a sole slides where its middle
moves on the floor by 1 mm or more at 2 mm/s or more (or twists alike at the lever of 0.1 m). A sole tips where it leans
by 2 mrad or more against the floor.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import count

import numpy as np
import pinocchio as pin

from plantar.contact.phases import joined
from plantar.conventions import rotation_from_quaternion
from plantar.errors import MotionError
from plantar.logs.motion_log import MotionLog
from plantar.motions.plan import Hand, Plan
from plantar.robot.model import Placement, RobotModel
from plantar.signals.segments import runs
from plantar.twin import PAPER
from plantar.twin.play import on_cores, planned, rolled
from plantar.twin.presets import preset_named
from plantar.twin.recording import record
from plantar.twin.robots.foot import CutFoot, cut_feet
from plantar.twin.robots.from_robot import describe
from plantar.twin.simulation.physics import Slip
from plantar.twin.simulation.rollout import Rollout

SLIDING_SPEED, SLIDING_PATH, LEVER = 0.002, 0.001, 0.1  # m/s, m, m
TIPPED = 0.002  # rad
PAUSE = 0.1  # s: two slides that are closer are one
LEAN = 1.2, 1.6  # of the sole's half length or width: how far the hand leads the chest
SOFT_HAND = 600.0, 60.0  # N/m, N·s/m: an operator beside a robot that moves by itself


@dataclass(frozen=True)
class Trial:
    """A recorded motion with what its soles truly did: by foot and kind, (N,) bool each."""

    log: MotionLog
    truth: dict[tuple[str, str], np.ndarray]


def disturbed(
    plan: Plan, robot: RobotModel, seed: Sequence[int], shoved: bool
) -> tuple[Plan, tuple[Slip, ...]]:
    """The plan with slippery seconds drawn from the seed and, where `shoved`, an operator who shoves in some.

    Half of the shoves happen on a slippery floor; the others lead the robot onto the edges of its soles.
    """
    random = np.random.default_rng([*seed, *plan.name.encode()])
    hand = plan.hand or _beside(plan, robot)
    halves = np.min([np.ptp(robot.feet[foot].sole.polygon, axis=0) / 2 for foot in plan.standing], axis=0)
    path, slips = hand.path.copy(), []
    time, end = plan.time, plan.time[-1]
    # One stretch a shove, in an order that changes: two on a slippery floor, two that lean on an edge.
    stretches = np.linspace(3.0, end - 3.0, 5)
    for place, kind in enumerate(random.permutation(["slip", "slip", "tip", "tip"])):
        length = random.uniform(0.3, 1.2)
        start = random.uniform(stretches[place] + 0.3, stretches[place + 1] - length - 0.8)
        bump = _bump(time, start, length)[:, None]
        angle = random.uniform(0, 2 * np.pi)
        if kind == "slip":
            slips.append(Slip(start, start + length, float(np.exp(random.uniform(*np.log([0.012, 0.04]))))))
            path += bump * 0.03 * np.array([np.cos(angle), np.sin(angle), 0.0])
        else:
            axis = random.integers(2)
            lean = np.zeros(3)
            lean[axis] = random.choice([-1.0, 1.0]) * random.uniform(*LEAN) * halves[axis]
            settled = np.median(hand.path, axis=0) if plan.hand else path
            path = (1 - bump) * path + bump * (settled + lean)
    return (replace(plan, hand=replace(hand, path=path)) if shoved else plan), tuple(slips)


def _bump(time: np.ndarray, start: float, length: float) -> np.ndarray:
    """0 to 1 and back, smooth, highest for `length` [s] from `start`."""
    up, down = (np.clip((time - at) / 0.5, 0, 1) for at in (start - 0.5, start + length))
    return up**2 * (3 - 2 * up) * (1 - down**2 * (3 - 2 * down))


def _beside(plan: Plan, robot: RobotModel) -> Hand:
    """A soft hand at the IMU's link that goes along with the plan."""
    assert robot.imu is not None
    held = Placement(robot.imu.placement.link, np.array([0.0, 0.0, 0.1]), np.zeros(3))
    model, data = robot.model, robot.model.createData()
    joint, pose = robot.frame(held)
    columns = [plan.joints.index(name) for name in robot.joint_names]
    path = np.empty((plan.time.size, 3))
    for row, (base, positions) in enumerate(zip(plan.base, plan.positions[:, columns], strict=True)):
        pin.forwardKinematics(model, data, positions)
        path[row] = (pin.SE3(base) * data.oMi[joint] * pose).translation
    return Hand(held, path, *SOFT_HAND)


def true_contact(
    rollout: Rollout, feet: dict[str, CutFoot], period: float
) -> dict[tuple[str, str], np.ndarray]:
    """Where each sole slides and where it tips, from its exact pose."""
    found = {}
    for name, foot in feet.items():
        from_bush = np.linalg.inv(foot.bush) @ foot.sole
        rotation = rotation_from_quaternion(rollout.sensors[f"{name}.sole"])
        middle = rollout.sensors[f"{name}.place"] + rotation @ from_bush[:3, 3]
        turned = rotation @ from_bush[:3, :3]
        yaw = np.unwrap(np.arctan2(turned[:, 1, 0], turned[:, 0, 0]))
        tilt = np.arccos(np.clip(turned[:, 2, 2], -1, 1))
        path = np.column_stack([middle[:, :2], LEVER * yaw])
        speed = np.linalg.norm(np.gradient(path, period, axis=0), axis=1)
        slides = np.zeros(len(speed), dtype=bool)
        for run in runs(joined(speed > SLIDING_SPEED, round(PAUSE / period))):
            slides[run] = speed[run].sum() * period >= SLIDING_PATH
        found[name, "slip"], found[name, "tipping"] = slides, tilt > TIPPED
    return found


def play_disturbed(
    motions: Sequence[str], others: Sequence[str], robot: RobotModel, preset_name: str, seed: int
) -> list[Trial]:
    """The motions of one seed, `others` without shoves; a draw that makes the robot fall is drawn again."""
    preset, feet = preset_named(preset_name), cut_feet(describe(robot), robot)

    def one(motion: str) -> Trial:
        plan = planned(motion, robot)
        for attempt in count():
            shoved, slips = disturbed(plan, robot, [seed, attempt], motion not in others)
            world = replace(preset.physics(PAPER), slips=slips)
            try:
                rollout = rolled(shoved, robot, world)
            except MotionError:
                continue
            log = record(rollout, robot, world, preset, seed).log
            return Trial(log, true_contact(rollout, feet, log.period))
        raise AssertionError("unreachable")

    return on_cores(one, [*motions, *others])
