"""Replays as they are kept: what every field is on average and now and then, each flag's ticks, and the parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import SLIPPING, TRUTH, record, sway, times
from biped_robot import make_robot
from feet_trials import noisy, stepping, without
from kept_texts import assert_as_kept, lines_of
from plantar.logs.motion_log import MotionLog
from plantar.online.estimates import FIELDS, Contact, Flag
from plantar.online.estimator import FootEstimator
from plantar.online.replay import Replay
from plantar.results.feet import FeetResult
from plantar.results.feet_rows import AxisModel, LinearEquivalent, Parameter
from plantar.robot.uncertainty import Uncertainty

KEPT = Path(__file__).parent / "kept"
SOFTER = {key: replace(law, stiffness=0.6 * law.stiffness) for key, law in TRUTH.items()}
LIFTS = tuple(("left" if step % 2 else "right", 2.0 * step, 2.0 * step + 0.9) for step in range(1, 19))


def swayed(seconds: float = 40.0, rate: float = 100.0, **changes: object) -> MotionLog:
    motion = sway("sway", 5, seconds, **changes)
    return noisy(record(motion, at=times(motion, rate)), 5)


def joined(*logs: MotionLog) -> MotionLog:
    """One log behind the other."""
    starts = np.cumsum([0.0, *(log.duration + log.period for log in logs)])
    time = np.concatenate([log.time + start for log, start in zip(logs, starts, strict=False)])
    return MotionLog(
        "joined", time, {n: np.concatenate([one.column(n) for one in logs]) for n in logs[0].columns}
    )


def faulty(log: MotionLog) -> MotionLog:
    """What cannot be read for a while, stands still, leaps or slides; and a clock that jumps."""
    columns, time = {name: values.copy() for name, values in log.columns.items()}, log.time.copy()

    def between(start: float, end: float) -> np.ndarray:
        return (log.time >= start) & (log.time < end)

    columns["wrench.left.force.z"][between(6, 6.1)] = np.nan
    columns["joint.right_ankle_roll.position"][between(9, 9.2)] = np.nan
    for axis in "xyz":
        for kind in ("force", "torque"):
            columns[f"wrench.right.{kind}.{axis}"][between(12, 13)] = columns[f"wrench.right.{kind}.{axis}"][
                1200
            ]
    columns["joint.left_ankle_pitch.position"][between(15, 15.5)] += 0.04
    columns["joint.left_ankle_roll.position"][between(16, 16.01)] += 0.2
    columns["joint.left_leg_x.position"] += 0.02 * np.clip(log.time - 18.0, 0.0, 0.5)
    columns["wrench.left.torque.y"][between(21, 22)] -= 0.13 * columns["wrench.left.force.z"][between(21, 22)]
    columns["wrench.right.force.z"][between(24, 24.02)] += 400.0
    columns["wrench.left.force.z"][between(26, 28)] += 150.0
    time[between(30, 99)] += 0.5
    time[between(33, 33.3)] += 0.004 * (np.arange(np.count_nonzero(between(33, 33.3))) % 2)
    columns["joint.right_ankle_pitch.position"][between(35, 37)] = columns[
        "joint.right_ankle_pitch.position"
    ][3500]
    return MotionLog("faulty", time, columns)


def coarse(log: MotionLog) -> MotionLog:
    """Encoders that count, one of which stands still for a moment, so that nobody sees it before it leaps."""
    names = [name for name in log.columns if name.startswith("joint.") and name.endswith("position")]
    read = {name: 5e-4 * np.round(log.column(name) / 5e-4) for name in names}
    for start in (12.0, 17.0, 23.0):
        stands = (log.time >= start) & (log.time < start + 0.16)
        ankle = read["joint.left_ankle_pitch.position"]
        ankle[stands] = ankle[stands][0]
    return log.with_columns(read)


def late(log: MotionLog, part: str, seconds: float) -> MotionLog:
    names = [name for name in log.columns if part in name]
    return log.with_columns(
        {name: np.interp(log.time - seconds, log.time, log.column(name)) for name in names}
    )


def told_of(foot: str, axis: str) -> tuple[tuple[str, float], tuple[str, float]]:
    """Of each foot and axis another slip torque and angle."""
    place = [*TRUTH].index((foot, axis))
    return ("slip_torque", 4.0 + 0.3 * place), ("slip_angle", 0.006 + 0.0005 * place)


def result(**model: object) -> FeetResult:
    """A batch result in which all four axes have one model."""
    models = tuple(
        replace(AxisModel(foot, axis, "kelvin_voigt", "", LinearEquivalent(400.0, 20.0)), **model)
        for foot, axis in TRUTH
    )
    rows = tuple(
        Parameter(foot, axis, name, "", value, 0.05 * value, (0.9 * value, 1.1 * value), 0.1, "usable", "")
        for foot, axis in TRUTH for name, value in told_of(foot, axis)
    )  # fmt: skip
    told = rows if model.get("model") == "elastoplastic" else ()
    return FeetResult(
        "biped", (), {}, "kelvin_voigt", told, (), (), (), (), models=models, compliance={"left": 2e-5}
    )


LOGS: dict[str, Callable[[], tuple[MotionLog, FeetResult | None]]] = {
    "swaying": lambda: (swayed(), None),
    "fast": lambda: (swayed(12.0, 1000.0), None),
    "walking": lambda: (noisy(stepping(record(sway("walk", 5, 40.0))), 5), None),
    "stepping": lambda: (swayed(lifts=LIFTS), None),
    "slipping": lambda: (swayed(truth=SLIPPING), None),
    "slipping as told": lambda: (swayed(truth=SLIPPING, lifts=LIFTS), result(model="elastoplastic")),
    "misplaced as told": lambda: (swayed(), result(moment_arms=(0.01, 0.03), turned=0.1, leans=-0.05)),
    "softer": lambda: (joined(swayed(lifts=LIFTS), swayed(truth=SOFTER, lifts=LIFTS)), None),
    "faulty": lambda: (faulty(swayed()), None),
    "faulty as told": lambda: (faulty(swayed(truth=SLIPPING)), result(model="elastoplastic")),
    "coarse as told": lambda: (coarse(swayed(truth=SLIPPING)), result(model="elastoplastic")),
    "coarse steps as told": lambda: (
        coarse(swayed(truth=SLIPPING, lifts=LIFTS)),
        result(model="elastoplastic"),
    ),
    "late forces": lambda: (late(swayed(), "wrench", 0.03), None),
    "late imu": lambda: (late(swayed(), "imu", 0.03), None),
    "without attitude": lambda: (without(swayed(), "orientation"), None),
    "without gyroscope": lambda: (without(swayed(), "angular_velocity"), None),
}


def said(replay: Replay) -> str:
    lines = []
    for foot in replay.feet:
        flags, contact = (replay.column(foot, name).astype(int) for name in ("flags", "contact"))
        counted = {flag.name: np.count_nonzero(flags & flag) for flag in Flag}
        counted |= {one.name: np.count_nonzero(contact == one) for one in Contact}
        lines.append(f"{foot}: {', '.join(f'{name} {count}' for name, count in counted.items() if count)}")
        for name in FIELDS[1:]:
            values = replay.column(foot, name)
            some = ", ".join(f"{value:.8g}" for value in values[len(values) // 4 :: len(values) // 4])
            lines.append(f"{foot} {name}: {some}; {np.nanmean(values):.8g}, {np.nanstd(values):.8g}")
    rows = [{key: value for key, value in vars(row).items() if value != ""} for row in replay.parameters]
    return "\n".join(lines) + "\n" + lines_of({"parameter": rows})


@pytest.mark.parametrize("name", LOGS)
def test_a_replay_is_as_it_is_kept(name: str, tmp_path: Path) -> None:
    robot = replace(make_robot(tmp_path), uncertainty=Uncertainty())
    log, told = LOGS[name]()
    found = FootEstimator(robot, told, wrench_delay=None if name == "swaying" else 0.0).replay(log)
    assert_as_kept(said(found), KEPT / f"{name.replace(' ', '_')}.txt", share=1e-5, least=1e-7)
