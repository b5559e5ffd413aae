"""Whole results as they are kept: every number, verdict, note and advice, of campaigns with all kinds of errors."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from biped import SLIPPING, TRUTH, BushModel, record, sines, sway
from biped_robot import FEET, Frame, Mounting, make_robot, robot_entry
from feet_trials import noisy, shifted, stepping, without
from kept_texts import assert_as_kept, lines_of
from plantar.conventions import Array
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
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
    """Logs to fit, then one to validate; what the robot file says of errors, of half of a sole's length [m], and how
    feet stand."""

    logs: Callable[[], Sequence[MotionLog]]
    settings: FeetSettings = field(default_factory=FeetSettings)
    uncertainty: Uncertainty = field(default_factory=Uncertainty)
    half: float = 0.13
    contact: str = "auto"

    def robot(self, folder: Path) -> RobotModel:
        entry: Any = robot_entry()
        for foot in entry["feet"].values():
            foot["sole"]["polygon"] = [
                [x * self.half, y] for x, y in ((1, 0.08), (-1, 0.08), (-1, -0.08), (1, -0.08))
            ]
            foot["contact"] = self.contact
        return replace(make_robot(folder, feet=entry["feet"]), uncertainty=self.uncertainty)


@dataclass(frozen=True)
class Tipping(BushModel):
    """A bush under a sole that tips at 8.5 N·m: the foot turns on."""

    def torque(self, deflection: Array, rate: Array) -> Array:
        return np.clip(super().torque(deflection, rate), -8.5, 8.5)


def tipping() -> list[MotionLog]:
    """Both feet pitch far, over edges 29 mm from the middle, and roll a little."""
    pitching = {
        key: Tipping(law.stiffness, law.damping, 0.0) for key, law in TRUTH.items() if key[1] == "pitch"
    }
    truth = {key: replace(law, offset=0.0) for key, law in TRUTH.items()} | pitching
    logs = []
    for seed, (degrees, rate) in enumerate(((2.5, 0.25), (2.0, 0.31), (1.8, 0.28))):
        ankles = {
            foot: (sines((np.radians(degrees), rate, 0.3)), sines((np.radians(0.8), 0.31, 0.0)))
            for foot in FEET
        }
        still = (sines((0.0, 0.0, 0.0)),) * 3
        motion = sway(f"tip_{seed}", seed, torso=still, ankles=ankles, shift=0.0, truth=truth)
        logs.append(noisy(record(motion), seed))
    return logs


def unlike() -> list[MotionLog]:
    """Of four logs one is of other rubber, one late, and the last, unseen one of a foot that is half as stiff."""
    truth, half = (
        {key: replace(law, stiffness=share * law.stiffness) for key, law in TRUTH.items()}
        for share in (1.1, 0.5)
    )
    usual, (stiff,), (soft,) = swayed(0, 1), swayed(2, truth=truth), swayed(5, truth=half)
    return [usual[0], late(usual[1], "wrench", 0.01), stiff, *swayed(4), soft]


def faint() -> list[MotionLog]:
    """Feet that hardly turn beside noise, one of them once quickly and one only slowly."""
    ankles = {
        "left": (sines((2e-4, 0.3, 0.1)), sines((8e-4, 0.4, 1.0))),
        "right": (sines((6e-4, 0.04, 0.5)), sines((1e-3, 0.3, 2.0), (1e-3, 0.9, 0.0))),
    }
    still, logs = (sines((0.0, 0.0, 0.0)),) * 3, []
    for seed in (1, 2, 3):
        log = record(sway(f"faint_{seed}", seed, 16.0, ankles=ankles, torso=still))
        loud = noisy(log, seed)
        logs.append(
            log.with_columns({name: 3 * loud.column(name) - 2 * log.column(name) for name in log.columns})
        )
    return logs


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
    "tipping": Campaign(tipping, FeetSettings(wrench_delay=0.0), half=0.03),
    "tipping_zeroed": Campaign(tipping, FeetSettings(wrench_delay=0.0), contact="always"),
    "unlike": Campaign(unlike),
    "faint": Campaign(faint, FeetSettings(wrench_delay=0.0)),
}


@pytest.mark.parametrize("name", CAMPAIGNS)
def test_a_result_is_as_it_is_kept(name: str, tmp_path: Path) -> None:
    campaign = CAMPAIGNS[name]
    robot = campaign.robot(tmp_path)
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
