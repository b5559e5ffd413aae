"""Imperfect sensors: each does what its preset says, and the seed decides."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from plantar.conventions import rotation_from_quaternion
from plantar.errors import PlantarError
from plantar.robot.model import RobotModel
from plantar.twin import PAPER
from plantar.twin.presets import PRESETS, SENSORS, preset_named
from plantar.twin.recording import record
from plantar.twin.robots import hrp2
from plantar.twin.robots.foot import cut_feet
from plantar.twin.robots.from_robot import describe
from plantar.twin.sensing.attitude_filter import filtered_attitude
from plantar.twin.sensing.exact import exact_columns
from plantar.twin.sensing.sensors import DEGREE, Sensors, _attitude, delayed, sense
from plantar.twin.simulation.physics import Physics
from twin_samples import tilted

TIME = np.arange(4000) / 200.0


@pytest.fixture(scope="module")
def robot() -> RobotModel:
    return hrp2.robot()


@pytest.fixture(scope="module")
def exact(robot: RobotModel) -> dict[str, np.ndarray]:
    """Smooth columns of every kind: no physics needed to test a sensor."""
    names = exact_columns(tilted(), robot, cut_feet(describe(robot), robot))
    columns = {name: np.sin(0.5 * TIME + place) for place, name in enumerate(names)}
    turn = Rotation.from_euler(
        "xyz", np.column_stack([0.05 * np.sin(TIME), 0.1 * np.cos(TIME), 0.3 + 0 * TIME])
    )
    columns |= dict(
        zip([f"imu.chest.orientation.{a}" for a in "wxyz"], turn.as_quat(scalar_first=True).T, strict=True)
    )
    return columns


def heard(exact, robot, sensors, seed=0, name="Tilt1"):
    return sense(exact, TIME, robot, sensors, seed, name)[0]


def test_ideal_sensors_change_nothing(exact, robot) -> None:
    columns = heard(exact, robot, Sensors())
    assert columns.keys() == exact.keys()
    for name, values in columns.items():
        np.testing.assert_allclose(values, exact[name], rtol=1e-6, atol=1e-15)


def test_encoders_are_quantised(exact, robot) -> None:
    columns = heard(exact, robot, Sensors(encoder=2e-5, encoder_rate=1e-3))
    for quantity, quantum in (("position", 2e-5), ("velocity", 1e-3)):
        steps = columns[f"joint.RLEG_JOINT3.{quantity}"] / quantum
        assert steps == pytest.approx(np.round(steps), abs=1e-6)
        error = columns[f"joint.RLEG_JOINT3.{quantity}"] - exact[f"joint.RLEG_JOINT3.{quantity}"]
        assert np.abs(error).max() <= quantum / 2 + 1e-12


def test_noise_has_the_sizes_of_the_preset(exact, robot) -> None:
    columns = heard(exact, robot, SENSORS)
    for name, size in (
        ("imu.chest.angular_velocity.z", 0.0022),
        ("imu.chest.linear_acceleration.x", 0.003),
        ("wrench.left_foot.force.y", 1.0),
        ("wrench.left_foot.torque.y", 0.1),
    ):
        assert (columns[name] - exact[name]).std() == pytest.approx(size, rel=0.08)


def test_zeros_differ_from_recording_to_recording(exact, robot) -> None:
    sensors = Sensors(torque_zero=0.5, force_zero=2.0)
    name = "wrench.right_foot.torque.x"
    zeros = []
    for seed in range(200):
        error = heard(exact, robot, sensors, seed)[name] - exact[name]
        assert np.ptp(error) < 1e-12
        zeros.append(error[0])
    assert np.std(zeros) == pytest.approx(0.5, rel=0.15)
    assert (
        heard(exact, robot, sensors, 3, "Tilt2")[name][0] != heard(exact, robot, sensors, 3, "Tilt1")[name][0]
    )


def test_the_seed_decides_everything(exact, robot) -> None:
    first, again, other = (heard(exact, robot, SENSORS, seed) for seed in (7, 7, 8))
    assert all(np.array_equal(first[name], again[name]) for name in first)
    noisy = [name for name in first if not name.startswith("joint.") or name.endswith("effort")]
    assert all(not np.array_equal(first[name], other[name]) for name in noisy)


def test_attitude_is_biased_by_what_was_drawn(exact, robot) -> None:
    sensors = Sensors(attitude_bias=0.15 * DEGREE, attitude_drift=0.03 * DEGREE)
    columns, drawn = sense(exact, TIME, robot, sensors, 1, "Tilt1")
    names = [f"imu.chest.orientation.{axis}" for axis in "wxyz"]
    believed, true = (
        rotation_from_quaternion(np.column_stack([c[n] for n in names])) for c in (columns, exact)
    )
    error = Rotation.from_matrix(believed @ np.swapaxes(true, 1, 2)).as_rotvec()
    for place, axis in enumerate("xy"):
        bias, drift = (drawn[f"imu.chest.orientation.{kind}.{axis}"] for kind in ("bias", "drift"))
        assert error[0, place] == pytest.approx(bias, rel=1e-3, abs=1e-9)
        assert error[-1, place] == pytest.approx(bias + drift, rel=1e-3, abs=1e-9)


@pytest.mark.parametrize("count", [100, 400])
def test_roll_and_pitch_wander_as_a_random_walk(count: int) -> None:
    """However many samples it takes: by `attitude_walk` at the end, by half of it after a quarter; yaw does not."""
    level = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
    time, random = np.linspace(0.0, 20.0, count), np.random.default_rng(3)
    walks = [_attitude(level, time, Sensors(attitude_walk=0.01), random)[0] for _ in range(400)]
    angles = 2 * np.array(walks)[:, :, 1:]
    assert angles[:, -1, :2].std(axis=0) == pytest.approx([0.01, 0.01], rel=0.1)
    assert angles[:, count // 4, :2].std(axis=0) == pytest.approx([0.005, 0.005], rel=0.15)
    assert not angles[:, :, 2].any()


def test_a_late_sensor_reads_the_past() -> None:
    values = np.sin(3 * TIME)
    assert delayed(values, TIME, 0.005)[10:] == pytest.approx(values[9:-1], abs=1e-12)  # one sample
    assert delayed(values, TIME, 0.0123)[10:] == pytest.approx(np.sin(3 * (TIME - 0.0123))[10:], abs=1e-7)


@pytest.mark.parametrize("sensor", ["joint", "imu", "wrench"])
def test_each_sensor_has_its_own_delay(exact, robot, sensor) -> None:
    late = heard(exact, robot, replace(Sensors(), **{f"{sensor}_delay": 0.01}))
    moved = {name.split(".")[0] for name in late if not np.allclose(late[name], exact[name], atol=1e-9)}
    assert moved == {sensor}


def test_the_filter_follows_the_attitude_and_not_the_bias() -> None:
    time = np.arange(20000) / 200.0
    angles = np.column_stack([0.05 * np.sin(0.6 * time), 0.1 * np.sin(1.1 * time), 0 * time])
    turn = Rotation.from_euler("xyz", angles)
    rates = (turn[:-1].inv() * turn[1:]).as_rotvec() * 200.0
    rates = np.vstack([rates, rates[-1]])
    up = turn.inv().apply([0.0, 0.0, 9.80665])
    start = turn[0].as_quat(scalar_first=True)
    believed = rotation_from_quaternion(filtered_attitude(start, rates + [0.002, -0.001, 0.0], up, 0.005))
    tilt = np.arccos(np.clip(np.einsum("ni,ni->n", believed[:, 2], turn.as_matrix()[:, 2]), -1, 1))
    assert tilt[:10].max() < 1e-3
    assert tilt[-4000:].max() < 0.2 * DEGREE  # the bias is learnt; without the filter 0.2 rad by now
    assert tilt.max() < 1.5 * DEGREE


def test_presets_grow_from_ideal_to_harsh() -> None:
    ideal, sensors, realistic, harsh = (PRESETS[name] for name in ("ideal", "sensors", "realistic", "harsh"))
    assert ideal.sensors == Sensors()
    assert sensors.physics(PAPER) == ideal.physics(PAPER) == Physics()
    assert realistic.sensors.wrench_delay == 0.005
    assert realistic.physics(PAPER).bushes["left"].pitch_slip_torque == pytest.approx(5.0)
    assert harsh.sensors.torque == 2 * sensors.sensors.torque
    assert harsh.physics(PAPER).bushes["left"].roll_slip_torque == 2 * realistic.slip_torque[1]
    assert harsh.slips
    assert harsh.floor[0] < sensors.floor[0]
    assert harsh.physics(None).bushes is None


def test_rubber_grows_with_the_robot_that_stands_on_it() -> None:
    """Twice the mass at the same height: twice the torque of the same angle, and twice the hardening."""
    built_in, harsh = hrp2.robot(), PRESETS["harsh"]
    assert harsh.physics(PAPER, built_in) == harsh.physics(PAPER)
    heavier = re.sub(r'<mass value="([^"]+)"', lambda m: f'<mass value="{2 * float(m[1])}"', built_in.urdf)
    own, other = (harsh.physics(PAPER, robot).bushes for robot in (built_in, replace(built_in, urdf=heavier)))
    for foot in PAPER:
        for axis in ("pitch", "roll"):
            for name in ("slip_torque", "hardening"):
                size = getattr(other[foot], f"{axis}_{name}") / getattr(own[foot], f"{axis}_{name}")
                assert size == pytest.approx(2.0, abs=2e-3)
            assert getattr(other[foot], f"{axis}_slip_angle") == getattr(own[foot], f"{axis}_slip_angle")


def test_an_unknown_preset_lists_the_known() -> None:
    with pytest.raises(
        PlantarError,
        match=r"^unknown preset 'odd' \(valid: ideal, sensors, realistic, harsh, plain_log, imperfect\)$",
    ):
        preset_named("odd")


def test_a_recording_says_what_was_put_in(robot) -> None:
    preset = PRESETS["sensors"]
    recording = record(tilted(), robot, preset.physics(PAPER), preset, 5)
    facts = recording.truth.facts
    assert facts["bushes"]["left"]["pitch_stiffness"] == 480.0
    assert (facts["preset"], facts["seed"], facts["motion"]) == ("sensors", 5, "Tilt3")
    zero = facts["drawn"]["wrench.right_foot.torque.x.zero"]
    exact = exact_columns(tilted(), robot, cut_feet(describe(robot), robot))["wrench.right_foot.torque.x"]
    assert (recording.log.column("wrench.right_foot.torque.x") - exact).mean() == pytest.approx(
        zero, abs=0.02
    )
    assert not any(name.startswith("joint.") for name in recording.truth.columns)


def test_logs_and_truth_are_written_apart(robot, tmp_path) -> None:
    from plantar.logs.readers import open_log

    preset = PRESETS["sensors"]
    recording = record(replace(tilted(), name="Tilt.3"), robot, preset.physics(PAPER), preset, 5)
    log = open_log(recording.write(tmp_path))
    assert np.array_equal(log.time, recording.log.time)
    assert all(np.array_equal(log.column(name), values) for name, values in recording.log.columns.items())
    assert (tmp_path / "Tilt.3.truth.parquet").exists()
    assert not any("deflection" in name for name in log.columns)
