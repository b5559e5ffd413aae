"""A log at other times: straight lines, short gaps bridged, long ones left and said."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.errors import DataError
from plantar.logs.motion_log import MotionLog
from plantar.twin.log_at import check_whole, log_at

TIME = 5.0 + np.arange(101) / 100


def with_gap(first: int, last: int) -> MotionLog:
    """A ramp of 1 per second without the samples from first to last."""
    values = np.arange(101) / 100
    values[first : last + 1] = np.nan
    return MotionLog(
        "ramp", TIME, {"joint.knee.position": values, "joint.hip.position": np.arange(101) / 100}
    )


def read(log: MotionLog) -> np.ndarray:
    return log_at(log, TIME[0] + np.arange(0, 201) / 200).columns["joint.knee.position"]


@pytest.mark.parametrize(("first", "last"), [(40, 57), (0, 18), (83, 100)])
def test_a_short_gap_is_a_straight_line(first: int, last: int) -> None:
    log = with_gap(first, last)
    found, inner = read(log), slice(2 * first, 2 * last + 1) if first > 0 and last < 100 else slice(60, 120)
    np.testing.assert_allclose(found[inner], np.arange(0, 201)[inner] / 200, atol=1e-12)
    check_whole(log, "the joints", np.arange(201) / 200, found)


@pytest.mark.parametrize(("first", "last", "when"), [(40, 60, 5.395), (0, 20, 5.0), (79, 100, 5.98)])
def test_a_long_gap_is_said_with_its_time(first: int, last: int, when: float) -> None:
    log = with_gap(first, last)
    found = read(log)
    whole = log_at(log, TIME)
    np.testing.assert_allclose(whole.time, np.arange(101) / 100, atol=1e-12, err_msg="from 0 on")
    beside = whole.columns["joint.hip.position"]
    np.testing.assert_allclose(beside, np.arange(101) / 100, atol=1e-12, err_msg="other columns stay")
    with pytest.raises(DataError, match=f"t = {when:g}.*the joints have a gap"):
        check_whole(log, "the joints", np.arange(201) / 200, found)
