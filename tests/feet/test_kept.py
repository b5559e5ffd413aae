"""Whole results as they are kept: every number, verdict, note and advice, of campaigns with all kinds of errors."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest

from biped import SLIPPING, TRUTH, record, sway
from biped_robot import Frame, Mounting, make_robot
from feet_trials import noisy, shifted, stepping, without
from kept_texts import assert_as_kept, lines_of
from plantar.conventions import Array
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.results.feet import FeetResult
from plantar.robot.uncertainty import Uncertainty
from plantar.signals.filters import low_pass

KEPT = Path(__file__).parent / "kept"
ASIDE = np.array([0.002, -0.003, 0.004])  # m, of the force sensors
STIFFER = {key: replace(law, hardening=9e4) for key, law in TRUTH.items()}
TURNED = Mounting(imu=Frame((-0.05, 0.02, 0.3), (0.012, -0.008, 0.02)))


def late(log: MotionLog, part: str, seconds: float) -> MotionLog:
    """The columns whose names hold `part`, read so much later."""
    names = [name for name in log.columns if part in name]
    moved = {name: np.interp(log.time - seconds, log.time, log.column(name)) for name in names}
    return log.with_columns(moved)


def scaled(log: MotionLog, part: str, factor: float) -> MotionLog:
    return log.with_columns({name: factor * values for name, values in log.columns.items() if part in name})


def swayed(*seeds: int, seconds: float = 20.0, **changes: object) -> list[MotionLog]:
    return [noisy(record(sway(f"sway_{seed}", seed, seconds, **changes)), seed) for seed in seeds]


@dataclass(frozen=True)
class Campaign:
    """Logs to fit, then one to validate; what the robot file says of errors."""

    logs: Callable[[], Sequence[MotionLog]]
    settings: FeetSettings = field(default_factory=FeetSettings)
    uncertainty: Uncertainty = field(default_factory=Uncertainty)


def walking() -> list[MotionLog]:
    return [stepping(noisy(record(sway(f"walk_{seed}", seed, 15.0)), seed)) for seed in (1, 2, 3)]


def turned() -> list[MotionLog]:
    """Walks, which show how the IMU is turned."""
    mounting = Mounting(imu=Frame((-0.05, 0.02, 0.3), (0.02, -0.015, 0.03)))
    return [stepping(noisy(record(sway(f"walk_{seed}", seed), mounting), seed)) for seed in (1, 2, 3)]


def slipping() -> list[MotionLog]:
    return swayed(3, 4, 5, truth=SLIPPING)


def misplaced() -> list[MotionLog]:
    return [shifted(noisy(record(sway(f"sway_{seed}", seed), TURNED), seed), ASIDE) for seed in (3, 4, 5)]


def misread() -> list[MotionLog]:
    """Late forces, a gyroscope that reads too much, one torque channel that reads too little; a slow drift."""
    logs = [scaled(late(log, "wrench", 0.004), "angular_velocity", 1.02) for log in swayed(6, 7, 8)]
    logs = [scaled(log, "wrench.left.torque.y", 0.96) for log in logs]
    name = "wrench.right.torque.x"
    return [log.with_columns({name: log.column(name) + 0.01 * log.time}) for log in logs]


def poor() -> list[MotionLog]:
    """No orientation, no velocities, a gap, a stretch that stands still, a spike, a filtered force."""
    logs = [without(log, "orientation", ".velocity") for log in swayed(1, 2, 9, seconds=30.0)]
    first, second, third = logs
    held = second.column("wrench.left.torque.x").copy()
    held[700:900] = held[700]
    spike = third.column("wrench.right.torque.y").copy()
    spike[400] += 50.0
    smooth: Callable[[str], Array] = lambda name: low_pass(first.column(name), 0.01, 8.0)  # noqa: E731
    names = [name for name in first.columns if name.startswith("wrench.left")]
    first = first.with_columns({name: smooth(name) for name in names})
    here = np.append(np.arange(1200), np.arange(1300, len(first)))
    first = MotionLog(
        first.name, first.time[here], {name: values[here] for name, values in first.columns.items()}
    )
    return [
        first,
        second.with_columns({"wrench.left.torque.x": held}),
        third.with_columns({"wrench.right.torque.y": spike}),
    ]


def lifting() -> list[MotionLog]:
    lifts = (("left", 4.0, 7.0), ("right", 11.0, 13.0))
    return swayed(10, 11, 12, lifts=lifts, truth=STIFFER)


CAMPAIGNS = {
    "usual": Campaign(lambda: swayed(0, 1, 2)),
    "one_offset": Campaign(lambda: swayed(0, 1, 2), FeetSettings(offset="shared", wrench_delay=0.0)),
    "walking": Campaign(walking),
    "turned": Campaign(turned),
    "slipping": Campaign(slipping, FeetSettings(wrench_delay=0.0)),
    "misplaced": Campaign(misplaced),
    "misread": Campaign(misread, uncertainty=Uncertainty(between_recordings=0.02)),
    "poor": Campaign(poor, uncertainty=Uncertainty(joint_compliance=2e-5)),
    "lifting": Campaign(lifting),
}


@pytest.mark.parametrize("name", CAMPAIGNS)
def test_a_result_is_as_it_is_kept(name: str, tmp_path: Path) -> None:
    campaign = CAMPAIGNS[name]
    robot = replace(make_robot(tmp_path), uncertainty=campaign.uncertainty)
    *fitted, unseen = campaign.logs()
    result = identify_feet(robot, fitted, [unseen], campaign.settings)
    content = result.to_dict()
    content |= {
        name: content[name][::4]
        for name in ("phases", "stances", "swing_zeros")
        if len(content.get(name, ())) > 40
    }
    text = lines_of(content, "created", "plantar", "robot_model", "settings", "inputs")
    assert_as_kept(text + residuals(result) + str(result), KEPT / f"{name}.txt", share=1e-5)


def residuals(result: FeetResult) -> str:
    """Root mean square of each column of numbers, by motion and foot."""
    assert result.residuals is not None
    table = {name: np.array(values) for name, values in result.residuals.to_pydict().items()}
    lines = []
    for motion, foot in sorted({*zip(table["motion"], table["foot"], strict=True)}):
        mine = (table["motion"] == motion) & (table["foot"] == foot)
        for name, values in table.items():
            if values.dtype.kind in "fb" and np.isfinite(own := values[mine].astype(float)).any():
                lines.append(
                    f"{motion} {foot} {name}: {np.sqrt(np.nanmean(own**2)):.8g}, {np.isfinite(own).sum()}"
                )
    return "\n".join(lines) + "\n"
