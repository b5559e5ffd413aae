"""Slip and tipping in known seconds: how well they are found, and what K and C are worth in spite of them.

    python benchmarks/contact.py --presets sensors realistic --seeds 4

Every seed has its own slippery seconds and shoves of the operator's hand, put into the paper's composed motion. The
truth is what the soles did in the exact simulation, not when the floor was slippery: a sole slides where its middle
moves on the floor by 1 mm or more at 2 mm/s or more (or twists alike at the lever of 0.1 m); where both feet stand,
both are said to slide when either does. A sole tips where it leans by 2 mrad or more against the floor. Samples left
out for another reason (air, landing, lifting, impact, a filter's edge) are not scored; "kept out for any reason" is the
share of all samples truly sliding or tipping that do not serve.
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import count

import numpy as np
import pinocchio as pin

from plantar.contact import AIR, DOUBLE, joined, widened
from plantar.conventions import ROTATIONAL_AXES, rotation_from_quaternion
from plantar.errors import MotionError
from plantar.identify.axis_fit import fit_axis
from plantar.identify.feet import identify_feet
from plantar.identify.preparation import prepare_all
from plantar.identify.settings import FeetSettings
from plantar.log import MotionLog
from plantar.motions.campaign import FIT
from plantar.motions.plan import Hand, Plan
from plantar.result import FeetResult
from plantar.robot import Placement, RobotModel
from plantar.signals import runs
from plantar.twin import PAPER, hrp2
from plantar.twin.foot import CutFoot, cut_feet
from plantar.twin.from_robot import describe
from plantar.twin.physics import Slip
from plantar.twin.play import on_cores, planned, play_all, rolled
from plantar.twin.presets import preset_named
from plantar.twin.recording import record
from plantar.twin.rollout import Rollout

SLIDING_SPEED, SLIDING_PATH, LEVER = 0.002, 0.001, 0.1  # m/s, m, m
TIPPED = 0.002  # rad
PAUSE = 0.1  # s: two slides that are closer are one
TOLERANCE = 0.1  # s by which an event may be missed at its ends, and a flag may reach beyond one
KINDS = ("slip", "tipping")
PUT_BACK = ("slip", "tipping", "impact", "filter's edge: beside")
LEAN = 1.2, 1.6  # of the sole's half length or width: how far the hand leads the chest
Errors = dict[str, list[tuple[float, float]]]
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


@dataclass
class Count:
    """Samples and events of one kind: found rightly, found wrongly, missed."""

    hits: int = 0
    false: int = 0
    missed: int = 0
    events_hit: int = 0
    events_false: int = 0
    events_missed: int = 0
    true: int = 0
    true_out: int = 0

    @property
    def kept_out(self) -> float:
        return self.true_out / max(self.true, 1)

    def add(self, truth: np.ndarray, flagged: np.ndarray, scored: np.ndarray, reach: int) -> None:
        """Samples as they are; an event counts as found where a flag touches it, widened by `reach` samples."""
        self.hits += int((truth & flagged & scored).sum())
        self.false += int((~truth & flagged & scored).sum())
        self.missed += int((truth & ~flagged & scored).sum())
        near = widened(truth, reach)
        for run in runs(joined(truth & scored, reach)):
            found = flagged[max(0, run.start - reach) : run.stop + reach].any()
            self.events_hit, self.events_missed = (
                self.events_hit + int(found),
                self.events_missed + int(not found),
            )
        for run in runs(joined(flagged & scored, reach)):
            self.events_false += not near[run].any()

    def text(self) -> str:
        shares = (
            self.hits / max(self.hits + self.false, 1),
            self.hits / max(self.hits + self.missed, 1),
            self.events_hit / max(self.events_hit + self.events_false, 1),
            self.events_hit / max(self.events_hit + self.events_missed, 1),
        )
        return "".join(f"{share:10.3f}" for share in shares) + f"{self.events_hit + self.events_missed:8d}"


def score(result: FeetResult, robot: RobotModel, trials: Sequence[Trial], counts: dict[str, Count]) -> None:
    """Compare the reasons of a result's phases with what the soles did."""
    for trial in trials:
        time, period = trial.log.time, trial.log.period
        reach = round(TOLERANCE / period)
        for foot in robot.feet:
            truth = {kind: trial.truth[foot, kind].copy() for kind in KINDS}
            any_slips = np.any([trial.truth[other, "slip"] for other in robot.feet], axis=0)
            flagged = {kind: np.zeros(time.size, dtype=bool) for kind in KINDS}
            scored, served, standing = (np.ones(time.size, dtype=bool) for _ in range(3))
            for phase in result.phases:
                if (phase.motion, phase.foot) != (trial.log.name, foot):
                    continue
                rows = (time >= phase.start - period / 2) & (time < phase.end - period / 2)
                kind = (phase.reason or "").split(":")[0]
                if kind in flagged:
                    flagged[kind] |= rows
                elif phase.reason is not None:
                    scored &= ~rows
                served[rows] = phase.used
                standing[rows] = phase.support != AIR
                if phase.support == DOUBLE:
                    truth["slip"][rows] = any_slips[rows]
            # A sole that slides and tips at once is left out once: either reason is right.
            both = truth["slip"] & truth["tipping"]
            either = both & (flagged["slip"] | flagged["tipping"])
            for kind in KINDS:
                counts[kind].add(truth[kind], flagged[kind] | either, scored, reach)
                counts[kind].true += int((truth[kind] & standing).sum())
                counts[kind].true_out += int((truth[kind] & standing & ~served).sum())


def with_everything(robot: RobotModel, logs: Sequence[MotionLog], others: Sequence[MotionLog]) -> Errors:
    """Errors of K and C where slip, tipping and impacts are put back into the fit."""
    settings = FeetSettings()
    ready = prepare_all(robot, logs, others, settings, lambda _: None)
    for recording in ready.fitted:
        for contact in recording.contacts.values():
            back = [k for k, reason in enumerate(contact.reasons) if (reason or "").startswith(PUT_BACK)]
            contact.code[np.isin(contact.code, back)] = 0
    found: Errors = {"K": [], "C": []}
    for foot in robot.feet:
        for axis in ROTATIONAL_AXES:
            fit = fit_axis(ready.fitted, foot, axis, settings)
            assert fit is not None
            for place, (name, term) in enumerate((("K", "stiffness"), ("C", "damping"))):
                truth = getattr(PAPER[foot], f"{axis}_{term}")
                found[name].append((fit.values[place] / truth - 1, float("nan")))
    return found


def parameter_errors(result: FeetResult) -> Errors:
    """Error of each K and C relative to the truth, and whether its interval covers it."""
    found: Errors = {"K": [], "C": []}
    for row in result.parameters:
        name = {"stiffness": "K", "damping": "C"}.get(row.name)
        if name is None or row.axis == "z" or row.value is None or row.interval95 is None:
            continue
        truth = getattr(PAPER[row.foot], f"{row.axis}_{row.name}")
        found[name].append((row.value / truth - 1, row.interval95[0] <= truth <= row.interval95[1]))
    return found


def print_table(preset: str, counts: dict[str, Count], errors: Errors, left_out: dict[str, float]) -> None:
    heads = "".join(f"{head:>10}" for head in 2 * ("precision", "recall"))
    print(f"\n{preset}\n{'':10}{'by sample':>20}{f'by event, {TOLERANCE:g} s':>20}\n{'':10}{heads}  events")
    for kind in KINDS:
        print(f"{kind:10}{counts[kind].text()}  kept out for any reason {counts[kind].kept_out:.3f}")
    for label, rows in errors.items():
        relative, covered = np.array(rows, dtype=float).T
        sizes = f"median |error| {100 * np.median(abs(relative)):5.2f} %, largest {100 * abs(relative).max():6.2f} %"
        share = "" if np.isnan(covered).all() else f", {100 * covered.mean():.0f} % of {len(rows)} covered"
        print(f"{label:22} {sizes}{share}")
    print("seconds of standing feet: " + ", ".join(f"{why} {spent:.0f}" for why, spent in left_out.items()))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--presets", nargs="+", default=["sensors", "realistic", "harsh"])
    parser.add_argument("--seeds", type=int, nargs="+", default=[0, 1, 2])
    parser.add_argument("--motions", nargs="+", default=list(FIT))
    parser.add_argument("--others", nargs="*", default=["Myrand5"], help="to validate, with slippery seconds")
    parser.add_argument("--calm", nargs="*", default=["Myrand4"], help="to validate, undisturbed: the delay")
    chosen = parser.parse_args()
    robot = hrp2.robot()
    for preset in chosen.presets:
        counts: dict[str, Count] = defaultdict(Count)
        errors: Errors = defaultdict(list)
        seconds: dict[str, float] = defaultdict(float)
        for seed in chosen.seeds:
            trials = play_disturbed(chosen.motions, chosen.others, robot, preset, seed)
            calm = play_all(chosen.calm, robot, PAPER, preset, [seed])[0]
            logs = [trial.log for trial in trials]
            split = len(chosen.motions)
            fitted, unseen = logs[:split], [*logs[split:], *(recording.log for recording in calm)]
            result = identify_feet(robot, fitted, unseen)
            score(result, robot, trials, counts)
            for phase in result.phases:
                if phase.support != AIR:
                    seconds[(phase.reason or "served").split(":")[0]] += phase.end - phase.start
            for label, rows in (
                ("", parameter_errors(result)),
                (" with everything", with_everything(robot, fitted, unseen)),
            ):
                for name in ("K", "C"):
                    errors[name + label] += rows[name]
        print_table(preset, counts, errors, seconds)


if __name__ == "__main__":
    main()
