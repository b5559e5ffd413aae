"""Bad samples: lone spikes bridged, short bursts left out, both told; clean data stay as they are."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from biped import TRUTH, record, sway
from biped_robot import make_robot
from feet_trials import LINEAR
from made_recording import FOOT, made_recording, swayed
from plantar.feet.exclusion.outliers import outlier_masks, outliers
from plantar.feet.identify import identify_feet
from plantar.feet.regression.axis import FittedModel
from plantar.logs.motion_log import MotionLog
from plantar.models import KelvinVoigt
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.signals.spikes import lone_spikes, without_spikes

PERIOD = 0.005
TIME = PERIOD * np.arange(6000)


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    return make_robot(Path(tmp_path_factory.mktemp("robot")))


def noisy(seed: int) -> MotionLog:
    """A sway with white noise on wrenches (1 N, 0.1 N·m) and gyroscope."""
    random = np.random.default_rng(seed)
    log = record(sway(f"sway_{seed}", seed=seed, duration=30.0))
    sizes = {"force": 1.0, "torque": 0.1, "angular_velocity": 0.0013}
    noise = {
        name: column + sizes[kind] * random.standard_normal(len(log))
        for name, column in log.columns.items()
        if (kind := name.split(".")[2]) in sizes
    }
    return log.with_columns(noise)


@pytest.fixture(scope="module")
def clean() -> list[MotionLog]:
    return [noisy(1), noisy(2)]


def spoilt(log: MotionLog, where: np.ndarray, shape: str) -> MotionLog:
    """Wrench columns with 50 times their noise at the samples `where`; `held`: all by the same amount."""
    random = np.random.default_rng(7)
    bad = {}
    for name, column in log.columns.items():
        if name.startswith("wrench."):
            size = 50.0 if ".force." in name else 5.0
            extra = size * (np.ones(len(log)) if shape == "held" else random.standard_normal(len(log)))
            bad[name] = np.where(where, column + extra, column)
    return log.with_columns(bad)


def stretches(starts: tuple[float, ...]) -> np.ndarray:
    return np.asarray(np.any([np.abs(TIME - start - 0.1) < 0.1 for start in starts], axis=0))


def assert_stiffness_covered(result: FeetResult) -> None:
    for (foot, axis), truth in TRUTH.items():
        row = result.parameter(foot, axis, "stiffness")
        assert row.interval95 is not None
        low, high = row.interval95
        slack = 1e-3 * truth.stiffness  # of the white noise's own draw
        assert low - slack <= truth.stiffness <= high + slack, f"{foot} {axis}: {low:.2f} to {high:.2f}"
        assert high - low < 0.02 * truth.stiffness


def left_out(result: FeetResult) -> float:
    """Seconds that a foot was not used because of outliers."""
    return sum(
        p.end - p.start for p in result.phases if p.reason is not None and p.reason.startswith("outlier")
    )


@pytest.mark.parametrize(
    "clean",
    [
        np.random.default_rng(0).standard_normal(6000),
        np.sin(2 * np.pi * 0.7 * TIME),
        np.where(TIME > 12.0, 1.0, 0.0),
        np.round(np.sin(2 * np.pi * 0.2 * TIME) / 0.01) * 0.01,
        np.zeros(6000),
    ],
    ids=["noise", "sine", "step", "coarse steps", "constant"],
)
def test_nothing_clean_is_a_spike(clean: np.ndarray) -> None:
    assert not lone_spikes(clean, PERIOD, landings=None).size


def test_lone_samples_are_found_and_an_impact_is_not() -> None:
    random = np.random.default_rng(1)
    signal = np.sin(2 * np.pi * TIME) + 0.01 * random.standard_normal(6000)
    truth = np.zeros(6000, dtype=bool)
    truth[np.arange(50, 5900, 200)] = True
    spiked = np.where(truth, signal + 0.5, signal)
    impact = (TIME > 20) & (TIME < 21)
    ringing = np.where(impact, random.standard_normal(6000), 0.0)
    found = np.zeros(6000, dtype=bool)
    found[lone_spikes(spiked + ringing, PERIOD, landings=None)] = True
    beside = (TIME > 18.5) & (TIME < 22.5)
    assert found[truth & ~beside].all(), "every spike"
    assert not found[~truth & ~impact].any(), "nothing else"
    assert found[impact].sum() < 5, "what rings is no lone sample"


def test_a_short_burst_is_an_outlier_and_another_motion_is_not() -> None:
    random = np.random.default_rng(2)
    missed = 0.02 * random.standard_normal(6000)
    burst = stretches((8.0, 17.0))
    found = outliers(np.where(burst, missed + 1.0, missed), 5.0, PERIOD, 0.2)
    assert found[burst].all()
    assert found.sum() <= 4 * burst.sum()
    assert not outliers(missed, 5.0, PERIOD, 0.2).any()
    motion = (TIME > 10) & (TIME < 14)
    assert not outliers(np.where(motion, 20 * missed, missed), 5.0, PERIOD, 0.2).any(), (
        "4 s are no bad sample"
    )
    longer = (TIME > 10) & (TIME < 12)  # less than a tenth of the recording, but more than a second
    assert not outliers(np.where(longer, missed + 1.0, missed), 5.0, PERIOD, 0.2).any()
    small = np.where(burst, missed + 0.12, missed)
    assert not outliers(small, 5.0, PERIOD, 0.2).any(), "too small to matter"


def test_what_the_filter_spreads_of_a_burst_goes_along() -> None:
    missed = 0.02 * np.random.default_rng(4).standard_normal(6000)
    found = outliers(np.where(stretches((8.0,)), missed + 1.0, missed), 5.0, PERIOD, 0.4)
    assert found[(TIME > 7.65) & (TIME < 8.55)].all()
    assert not found[(TIME < 7.4) | (TIME > 8.8)].any()


def test_where_a_tenth_of_a_recording_is_off_it_is_no_lone_fault() -> None:
    missed = 0.02 * np.random.default_rng(5).standard_normal(6000)
    few, many = (stretches(tuple(np.arange(1.0, 29.0, apart))) for apart in (7.0, 2.0))
    assert outliers(np.where(few, missed + 1.0, missed), 5.0, PERIOD, 0.05)[few].all()
    assert not outliers(np.where(many, missed + 1.0, missed), 5.0, PERIOD, 0.05).any()


def test_a_stretch_that_one_axis_consists_of_is_no_outlier_of_the_other() -> None:
    """Roll leaves its model for half a second; pitch moves then and nowhere else, or throughout."""
    roll, burst = swayed(3000), (np.arange(3000) > 1500) & (np.arange(3000) < 1550)
    noise = 0.02 * np.random.default_rng(8).standard_normal(3000)
    known = FittedModel(
        foot=FOOT, axis="roll", model=KelvinVoigt(), values=np.array([400.0, 20.0]), shape=np.zeros(0),
        offsets={"sway": 0.0},
    )  # fmt: skip
    plain = made_recording("sway", roll, 400.0 * roll)
    bush = plain.bushes[FOOT]
    law = 400.0 * roll + 20.0 * bush.rate[:, 1]
    torque = law + noise + np.where(burst, 3.0, 0.0)
    for pitch, found in ((np.where(burst, 0.03, 0.0), False), (swayed(3000, seed=1), True)):
        moved = replace(
            bush,
            deflection=np.column_stack([pitch, roll]),
            torque=np.column_stack([400.0 * pitch, torque]),
        )
        masks = outlier_masks([replace(plain, bushes={FOOT: moved})], known)
        assert bool(masks) == found
        assert not found or masks["sway"][burst].all()


def test_clean_logs_are_fitted_once_and_untouched(robot: RobotModel, clean: list[MotionLog]) -> None:
    assert without_spikes(clean[0]) is clean[0]
    result = identify_feet(robot, clean, settings=LINEAR)
    assert left_out(result) == 0.0
    assert "spikes" not in {note.code for note in result.notes}


def test_spikes_are_bridged_and_told(robot: RobotModel, clean: list[MotionLog]) -> None:
    where = np.random.default_rng(3).random(len(TIME)) < 0.005
    logs = [spoilt(log, where[: len(log)], "noise") for log in clean]
    result = identify_feet(robot, logs, settings=LINEAR)
    assert_stiffness_covered(result)
    told = [note for note in result.notes if note.code == "spikes"]
    assert len(told) == 2
    assert told[0].severity == "warning"
    assert "wrench.left.force.x" in told[0].text


@pytest.mark.parametrize("shape", ["noise", "held"])
def test_bad_stretches_are_left_out_with_their_reason(
    robot: RobotModel, clean: list[MotionLog], shape: str
) -> None:
    where = stretches((6.0, 13.0, 21.0))
    logs = [clean[0], spoilt(clean[1], where[: len(clean[1])], shape)]
    result = identify_feet(robot, logs, settings=LINEAR)
    assert_stiffness_covered(result)
    if shape == "held":  # shaken ones may count as impacts
        assert 2 * 3 * 0.2 < left_out(result) < 2 * 3 * 1.2
        assert {p.motion for p in result.phases if p.reason and p.reason.startswith("outlier")} == {"sway_2"}


@pytest.mark.parametrize(
    ("size", "spread", "found"),
    [(7.0, 1.0, True), (5.0, 1.0, False), (7.0, 200.0, True), (7.0, 280.0, False)],
)
def test_a_stretch_is_bad_at_six_usual_misfits_and_three_percent_of_the_torque(
    size: float, spread: float, found: bool
) -> None:
    """`size` in usual misfits; of a torque that spreads by `spread` of them."""
    missed = np.tile([1.0, -1.0], 3000)
    stretch = slice(3000, 3060)
    missed[stretch] *= size
    off = outliers(missed, spread, PERIOD, 0.1)
    assert off.any() == found
    if found:
        assert off[stretch].all()
        assert np.flatnonzero(off)[[0, -1]] == pytest.approx([2980, 3079], abs=1), (
            "widened by the filter's reach"
        )


@pytest.mark.parametrize(("seconds", "found"), [(0.9, True), (1.2, False)])
def test_what_lasts_longer_than_a_second_is_no_bad_sample(seconds: float, found: bool) -> None:
    missed = np.tile([1.0, -1.0], 3000)
    missed[3000 : 3000 + round(seconds / PERIOD)] *= 20.0
    assert outliers(missed, 1.0, PERIOD, 0.0).any() == found
