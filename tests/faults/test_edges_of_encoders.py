"""Each limit of the checks of encoders and of channels that stand, tried on both sides on small logs made by hand."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pytest

from biped import WEIGHT
from loaded_log import PARTS, PERIOD, made
from plantar.conventions import Array
from plantar.faults.channels import check_channels, loaded_path
from plantar.faults.gaps import check_gaps
from plantar.faults.joints.stepping_joints import check_stepping_joints
from plantar.faults.joints.still_joints import check_still_joints
from plantar.notes import Finding
from plantar.robot.model import RobotModel

JOINT = "left_ankle_pitch"
OTHER = "right_ankle_pitch"


def encoder(position: Array, velocity: Array, joint: str = JOINT) -> dict[str, Array]:
    return {f"joint.{joint}.position": position, f"joint.{joint}.velocity": velocity}


def path(velocity: Array, period: float = PERIOD) -> Array:
    """The position that a velocity leads to, by trapezoids."""
    return np.concatenate([[0.0], np.cumsum((velocity[1:] + velocity[:-1]) / 2 * period)])


def held(position: Array, start: int, stop: int) -> Array:
    """The position, repeated from `start` to `stop`; what it then goes on with is what was missed later."""
    steps = np.diff(position)
    steps[start:stop] = 0.0
    return np.concatenate([position[:1], position[0] + np.cumsum(steps)])


def told(found: Iterable[Finding]) -> list[tuple[str, bool]]:
    return [(one.code, one.fatal) for one in found]


@pytest.mark.parametrize(("turn", "found"), [(0.0195, []), (0.0206, [("dead_channel", True)])])
def test_an_encoder_is_dead_from_a_fiftieth_of_a_radian_on(
    robot: RobotModel, turn: float, found: list[object]
) -> None:
    """It stands for a second of a sway of 1 Hz, over which the velocity turns to and fro by `turn`."""
    time = PERIOD * np.arange(1500)
    velocity = np.pi * turn * np.sin(2 * np.pi * time)
    log = made(15.0, encoder(held(path(velocity), 500, 600), velocity))
    findings = list(check_channels(robot, log))
    assert told(findings) == found
    if findings:
        where = f"column 'joint.{JOINT}.position', t = 5 to 6 s, value "
        assert findings[0].text.startswith(where)
        assert "stands still while its velocity turns 0.021 rad; the encoder is dead" in findings[0].text


@pytest.mark.parametrize(("ratio", "found"), [(4.6, ("stuck_channel", False)), (5.4, ("dead_channel", True))])
def test_a_velocity_that_parts_elsewhere_is_believed_from_five_times_on(
    robot: RobotModel, ratio: float, found: tuple[str, bool]
) -> None:
    """Elsewhere it leads to and fro by 0.01 rad in a second, as long as the encoder stands."""
    time = PERIOD * np.arange(4100)
    usual = 0.3 * np.sin(2 * np.pi * 0.1 * time)
    stands = (time >= 20.0) & (time <= 21.0)
    parts = np.pi * 0.01 * np.sin(2 * np.pi * time)
    position = held(path(np.where(stands, 0.0, usual)), 2000, 2100)
    velocity = np.where(stands, ratio * parts, usual + parts)
    findings = list(check_channels(robot, made(41.0, encoder(position, velocity))))
    assert told(findings) == [found]
    if not found[1]:
        assert f"turns {0.01 * ratio:.2g} rad; the velocity alone is off by 0.01 rad" in findings[0].text


@pytest.mark.parametrize(("elsewhere", "count"), [(1.8, 0), (2.4, 1)])
def test_a_bias_shows_where_a_fifth_of_the_time_is_elsewhere(
    robot: RobotModel, elsewhere: float, count: int
) -> None:
    """A constant velocity beside an encoder that stands for 10 s: bias or motion, the rest of the log tells."""
    time = PERIOD * np.arange(round((10.0 + elsewhere) / PERIOD))
    velocity = np.where(time < 10.0, 0.05, 0.3 * np.sin(2 * np.pi * 2 * (time - 10.0)))
    position = held(path(velocity), 0, 1000)
    assert len(list(check_channels(robot, made(10.0 + elsewhere, encoder(position, velocity))))) == count


@pytest.mark.parametrize(
    ("period", "samples", "count"), [(0.01, 18, 0), (0.01, 22, 1), (0.05, 9, 0), (0.05, 11, 1)]
)
def test_an_encoder_stands_for_a_fifth_of_a_second_and_ten_samples(
    robot: RobotModel, period: float, samples: int, count: int
) -> None:
    time = period * np.arange(400)
    velocity = 0.5 * np.sign(np.sin(2 * np.pi * time / (400 * period) * 2 + 0.1))
    log = made(400 * period, encoder(held(path(velocity, period), 50, 50 + samples), velocity), period=period)
    assert len(list(check_channels(robot, log))) == count


@pytest.mark.parametrize(("turn", "count"), [(0.047, 0), (0.053, 1)])
def test_a_coarse_encoder_stands_between_five_of_its_steps(
    robot: RobotModel, turn: float, count: int
) -> None:
    """Steps of 0.01 rad, two up and two down."""
    time = PERIOD * np.arange(2000)
    velocity = np.tile([0.0, 2.0, 0.0, -2.0], 500)
    stands = (time >= 10.0) & (time <= 11.0)
    velocity = np.where(stands, np.pi * turn * np.sin(2 * np.pi * time), velocity)
    log = made(20.0, encoder(held(path(velocity), 1000, 1100), velocity))
    assert len(list(check_channels(robot, log))) == count


@pytest.mark.parametrize(
    ("share", "of_the_time", "loaded"),
    [(0.09, 1.0, False), (0.11, 1.0, True), (0.5, 0.45, False), (0.5, 0.55, True)],
)
def test_a_foot_is_loaded_by_a_tenth_of_the_weight_for_half_of_the_time(
    robot: RobotModel, share: float, of_the_time: float, loaded: bool
) -> None:
    load = np.where(np.arange(1000) < 1000 * of_the_time, share * WEIGHT, 0.0)
    assert bool(loaded_path(robot, made(10.0, {}, load))) == loaded


def test_channels_that_stand_are_told_with_their_time_value_and_share(robot: RobotModel) -> None:
    random = np.random.default_rng(0)
    names = [f"wrench.left.force.{axis}" for axis in "xy"]
    signals = {name: random.normal(0.0, 1.0, 1000) for name in names}
    for signal in signals.values():
        signal[200:301] = 1.23456789
    one = {names[0]: signals[names[0]]}
    (finding,) = check_channels(robot, made(10.0, one))
    assert finding.text == (
        f"column '{names[0]}', t = 2 to 3 s, value 1.23457: stands still while it changes elsewhere, 10 % of the log, "
        "left out; is the channel dead or at its full scale? (valid: leave such cells empty)"
    )
    (finding,) = check_channels(robot, made(10.0, signals))
    assert finding.text.startswith(
        f"columns '{names[0]}', '{names[1]}', t = 2 to 3 s: stand still while they change"
    )


@pytest.mark.parametrize(
    ("turn", "share", "code"),
    [(0.019, 0.5, "still_joint"), (0.021, 0.5, "stuck_channel"), (0.1, 0.008, "still_joint"),
     (0.1, 0.012, "stuck_channel"), (-0.1, 0.008, "still_joint"), (-0.1, 0.012, "stuck_channel")],
)  # fmt: skip
def test_a_joint_that_never_moves_is_doubted_where_its_twin_turns(
    robot: RobotModel, turn: float, share: float, code: str
) -> None:
    """By 0.02 rad, in more than a hundredth of the samples."""
    rows = np.arange(2000)
    moving = {f"joint.left_leg_{axis}.position": 1e-3 * np.sin(rows) for axis in "xyz"}
    positions = {
        f"joint.{JOINT}.position": np.zeros(2000),
        f"joint.{OTHER}.position": np.where(rows < 2000 * share, turn, 0.0),
    }
    (finding,) = check_still_joints(robot, made(20.0, moving | positions))
    assert finding.code == code
    assert f"column 'joint.{JOINT}.position': never changes" in finding.text
    assert list(check_still_joints(robot, made(20.0, positions))) == [], (
        "one of two: most of them have to move"
    )


@pytest.mark.parametrize(("turn", "landings", "count"), [(0.019, 2, 0), (0.021, 2, 1), (0.1, 1, 0)])
def test_a_joint_that_stands_through_a_step_is_told(
    robot: RobotModel, turn: float, landings: int, count: int
) -> None:
    rows = np.arange(1000)
    air = (rows >= 300) & (rows < (400 if landings == 2 else 1000))
    log = made(
        10.0,
        {
            f"joint.{JOINT}.position": np.where(rows < 950, 0.25, 0.3),
            f"joint.{OTHER}.position": turn * rows / 949.0,
        },
    )
    log = log.with_columns({"wrench.left.force.z": np.where(air, 0.0, WEIGHT / 2)})
    found = [one for one in check_stepping_joints(robot, log) if JOINT in one.text]
    assert len(found) == count
    if found:
        assert (
            f"t = 0 to 9.49 s, value 0.25: stands still while its leg steps and '{OTHER}' turns 0.021 rad"
            in found[0].text
        )


def test_gaps_are_told_with_the_longest_and_their_share(robot: RobotModel) -> None:
    rows, columns = np.arange(2000), [f"wrench.left.{part}" for part in PARTS]
    empty = ((rows >= 400) & (rows <= 500)) | ((rows >= 1000) & (rows <= 1200))
    log = made(20.0, {name: np.where(empty, np.nan, 1.0) for name in columns})
    (finding,) = check_gaps(robot, log)
    assert finding.text.startswith(
        "columns 'wrench.left.*': 2 gaps, the longest from t = 10 to 12 s, 15 % of the log: left out"
    )
