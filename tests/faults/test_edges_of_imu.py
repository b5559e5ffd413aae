"""Each limit of the checks of an IMU, tried just inside and just outside on small logs made by hand."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.conventions import Array
from plantar.faults.imu import check_imu
from plantar.logs.motion_log import MotionLog
from plantar.notes import Finding

PERIOD = 0.01


def told(found: list[Finding]) -> list[tuple[str, bool]]:
    return [(one.code, one.fatal) for one in found]


def imu(
    orientation: Array | None = None, acceleration: Array | None = None, rates: Array | None = None
) -> list[Finding]:
    """What is said of an IMU at rest that reads the same 100 rows or a given (n, k)."""
    columns = {}
    for kind, axes, values in (("orientation", "wxyz", orientation), ("linear_acceleration", "xyz", acceleration),
                               ("angular_velocity", "xyz", rates)):  # fmt: skip
        if values is not None:
            rows = np.broadcast_to(values, (100, len(axes))) if values.ndim == 1 else values
            columns |= {f"imu.chest.{kind}.{axis}": rows[:, place].copy() for place, axis in enumerate(axes)}
    count = len(next(iter(columns.values())))
    return list(check_imu("chest", MotionLog("log", PERIOD * np.arange(count), columns)))


LEVEL = np.array([1.0, 0.0, 0.0, 0.0])
G = 9.80665
UNIT = "accelerometer_unit"


@pytest.mark.parametrize(("norm", "said"), [(0.89, True), (0.91, False), (1.09, False), (1.11, True)])
def test_a_quaternion_s_norm_is_one_within_a_tenth(norm: float, said: bool) -> None:
    found = imu(orientation=norm * LEVEL)
    assert told(found) == [("quaternion_norm", True)] * said
    assert not said or f"norm is {norm:.3g} (valid: 1)" in found[0].text


@pytest.mark.parametrize(
    ("norm", "found"),
    [(0.79, [(UNIT, False)]), (0.81, [(UNIT, True)]), (1.19, [(UNIT, True)]), (1.21, [(UNIT, False)]),
     (0.59 * G, [(UNIT, False)]), (0.61 * G, []), (1.59 * G, []), (1.61 * G, [(UNIT, False)]),
     (1.99, [(UNIT, False)]), (2.01, [(UNIT, False)]),
     (0.0, [("dead_channel", False)]), (np.nan, [("dead_channel", False)])],
)  # fmt: skip
def test_an_accelerometer_s_norm_is_gravity_s(norm: float, found: list[tuple[str, bool]]) -> None:
    """Beside an orientation it is not needed. Without one a dead sensor leaves nothing that shows which way is up; of
    another unit it is for feet to say that they need to know."""
    acceleration = np.array([0.0, 0.0, norm])
    findings = imu(orientation=LEVEL, acceleration=acceleration)
    assert told(findings) == found
    alone = [(code, fatal or code == "dead_channel") for code, fatal in found]
    assert told(imu(acceleration=acceleration)) == alone
    valid = "(valid: m/s², about 9.81 at rest)"
    dead = f"columns 'imu.chest.linear_acceleration.*': hold no value; not used {valid}"
    assert all(one.text == dead for one in findings if one.code == "dead_channel")
    assert not norm > 0 or all(f"{norm:.3g}" in one.text for one in findings)
    assert all(("without gravity" in one.text) == (norm < 2.0) for one in findings if one.code == UNIT)


@pytest.mark.parametrize(
    ("degrees", "code"),
    [
        (24, None),
        (26, "attitude_mismatch"),
        (90, "attitude_mismatch"),
        (171, "attitude_mismatch"),
        (173, "sign"),
    ],
)
def test_an_attitude_and_its_accelerometer_have_one_up(degrees: float, code: str | None) -> None:
    """About z a turn is the same in each reading of the quaternion: none but a lean about x agrees here."""
    up = np.array([0.0, 0.0, G])
    lean = np.array([np.cos(np.radians(degrees) / 2), 0.0, np.sin(np.radians(degrees) / 2), 0.0])
    found = imu(orientation=lean, acceleration=up)
    assert [one.code for one in found] == [code] * (code is not None)
    said = {
        "attitude_mismatch": f"columns 'imu.chest.orientation.*': up differs from the accelerometer's by {degrees} deg "
        "(valid: w x y z, body to world, z up)",
        "sign": "columns 'imu.chest.linear_acceleration.*': points down at rest, reversed, or the orientation's world "
        "has z down; or its quaternion is no w x y z: read as x y z w it agrees (valid: proper acceleration, +9.81 "
        "m/s² upwards at rest; orientation body to world, z up)",
    }
    assert not code or found[0].text == said[code]
    nine = np.tile(lean, (9, 1))
    assert imu(orientation=nine, acceleration=np.tile(up, (9, 1))) == [], (
        "of fewer than ten samples nothing is said"
    )


@pytest.mark.parametrize(("size", "dead"), [(0.9e-3, False), (1.1e-3, True)])
def test_a_rate_that_never_changes_is_dead_where_the_orientation_does(size: float, dead: bool) -> None:
    """`size`: the deviation of the quaternion's x."""
    x = size * np.tile([1.0, -1.0], 50)
    orientation = np.column_stack([np.sqrt(1 - x**2), x, np.zeros((100, 2))])
    found = imu(orientation=orientation, rates=np.zeros(3))
    assert told(found) == [("dead_channel", True)] * (3 * dead)
    empty = imu(orientation=np.full(4, np.nan), rates=np.full(3, np.nan))
    assert told(empty) == [("dead_channel", True)] * 4
    assert empty[3].text == "columns 'imu.chest.orientation.*': hold no value (valid: leave the columns out)"
