"""Zeros of an encoder that drops out, and zeros that are its angle."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.logs.motion_log import MotionLog
from plantar.signals.dropouts import dropped_samples, without_dropouts

TIME = np.arange(0.0, 40.0, 0.005)
ANGLE = 0.1 + 0.05 * np.sin(0.8 * TIME)
COUNT = 2 * np.pi / 20000  # rad, of an encoder


def dropping(values: np.ndarray, length: int = 40, every: int = 1000) -> tuple[np.ndarray, np.ndarray]:
    gone = np.arange(len(values)) % every >= every - length
    return np.where(gone, 0.0, values), gone


@pytest.mark.parametrize("values", [ANGLE, np.round(ANGLE / COUNT) * COUNT, np.full_like(ANGLE, -0.3)])
@pytest.mark.parametrize("length", [1, 40])
def test_zeros_between_jumps_are_dropped(values: np.ndarray, length: int) -> None:
    read, gone = dropping(values, length)
    found = dropped_samples(read)
    inner = gone & (TIME < 39.5)  # the last stretch ends with the log
    assert found[inner].all()
    assert found.sum() <= inner.sum() + 2 * (len(TIME) // 1000)


@pytest.mark.parametrize(
    "values",
    [
        np.round((ANGLE - 0.1) / COUNT) * COUNT,  # passes zero in counts
        np.where(np.sin(0.8 * TIME) > 0, ANGLE - 0.1, 0.0),  # rests at zero, and leaves it smoothly
        np.where(TIME < 5, 0.0, ANGLE),  # switched on
        np.where((TIME > 5) & (TIME < 6), 0.0, ANGLE),  # once: too little to tell
        np.zeros_like(TIME),
        np.where(np.sin(3 * TIME) > 0.9, 0.0017, 0.0),  # nearly always within half a step
        np.round((ANGLE - 0.1) / 0.0017)
        * 0.0017
        * (1 + 1e-15 * np.arange(TIME.size) % 3e-15),  # coarse, with rounding
    ],
)
def test_zeros_that_are_the_angle_stay(values: np.ndarray) -> None:
    assert not dropped_samples(values).any()


def test_a_stretch_at_an_end_has_nothing_beside_it_to_jump_from() -> None:
    """The last reading is none that came before the first ones, nor the other way round."""
    values = np.full(400, -0.3)
    for start in (1, 100, 200, 395):
        values[start : start + 4] = 0.0
    found = np.flatnonzero(dropped_samples(values))
    assert found.tolist() == [*range(99, 105), *range(199, 205)]


def device(kind: str, sizes: np.ndarray) -> dict[str, np.ndarray]:
    """Columns of an IMU or a force sensor: its gyroscope or torque may rest at zero, gravity or load may not."""
    if kind == "imu":
        return {
            "imu.chest.linear_acceleration.z": sizes,
            "imu.chest.angular_velocity.z": np.sin(TIME) * (sizes != 0),
        }
    return {"wrench.left.force.z": sizes, "wrench.left.torque.x": np.zeros_like(sizes)}


LOAD = 250 + 5 * np.sin(TIME)
OTHER = {"wrench.right.force.z": 500 - LOAD}


@pytest.mark.parametrize("kind", ["imu", "wrench"])
def test_a_device_drops_out_as_a_whole(kind: str) -> None:
    read, gone = dropping(LOAD)
    log = MotionLog("silent", TIME, device(kind, read) | OTHER | {"joint.knee.position": ANGLE})
    mended = without_dropouts(log)
    inner = gone & (TIME < 39.5)
    for name in device(kind, read):
        assert np.isnan(mended.column(name)[inner]).all()
        assert np.isnan(mended.column(name)).sum() <= inner.sum() + 2 * (len(TIME) // 1000)
    for name in (*OTHER, "joint.knee.position"):
        assert np.isfinite(mended.column(name)).all()


@pytest.mark.parametrize("kind", ["imu", "wrench"])
def test_one_channel_at_zero_is_no_device_that_dropped_out(kind: str) -> None:
    read, _ = dropping(LOAD)
    columns = device(kind, read)
    columns[[*columns][1]] = np.full_like(TIME, 0.1)
    log = MotionLog("one channel", TIME, columns | OTHER)
    assert without_dropouts(log) is log


def test_sensors_whose_names_hold_dots_drop_out_each_by_itself() -> None:
    read, gone = dropping(LOAD)
    columns = {"wrench.foot.left.force.z": read, "wrench.foot.left.torque.x": np.zeros_like(read)}
    log = MotionLog("dots", TIME, columns | {"wrench.foot.right.force.z": 500 - LOAD})
    mended = without_dropouts(log)
    inner = gone & (TIME < 39.5)
    assert all(np.isnan(mended.column(name)[inner]).all() for name in columns)
    assert np.isfinite(mended.column("wrench.foot.right.force.z")).all()


def test_a_foot_in_the_air_does_not_drop_out() -> None:
    """Its driver cuts what is small: it leaves zero and comes back to it at once, while the other foot carries all."""
    load, _ = dropping(LOAD, length=400)
    columns = device("wrench", load) | {"wrench.right.force.z": 500 - load}
    log = MotionLog("stepping", TIME, columns)
    assert without_dropouts(log) is log
    alone = MotionLog("one sensor", TIME, device("wrench", load))
    assert without_dropouts(alone) is alone


def test_of_joints_only_positions_are_looked_at() -> None:
    read, _ = dropping(ANGLE)
    names = ["joint.knee.position", "joint.knee.velocity", "joint.knee.effort"]
    log = without_dropouts(MotionLog("dropping", TIME, dict.fromkeys(names, read)))
    assert [name for name in names if np.isnan(log.column(name)).any()] == names[:1]
    whole = MotionLog("whole", TIME, dict.fromkeys(names, ANGLE))
    assert without_dropouts(whole) is whole


def test_a_load_of_either_sign_has_a_size() -> None:
    """What pulls along one channel as much as it pushes along another is no zero."""
    read, gone = dropping(LOAD)
    log = MotionLog("signs", TIME, {"wrench.left.force.x": -read, "wrench.left.force.z": read} | OTHER)
    assert np.isnan(without_dropouts(log).column("wrench.left.force.z")[gone & (TIME < 39.5)]).all()
