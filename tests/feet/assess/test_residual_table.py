"""The table behind the plots: a row for each sample, foot and motion, NaN where nothing was predicted."""

from __future__ import annotations

import numpy as np

from made_recording import FOOT, made_recording, predicted_torque, swayed
from plantar.contact.reasons import Reason
from plantar.feet.assess.residual_table import residual_table


def test_every_sample_has_a_row_with_its_prediction() -> None:
    angle = swayed(100)
    seen = made_recording("seen", angle, 400 * angle).without(FOOT, np.arange(100) < 7, Reason.IMPACT)
    unseen = made_recording("unseen", -angle, -300 * angle, role="validate")
    table = residual_table(
        [seen, unseen], {("seen", FOOT, "roll"): predicted_torque(390 * angle)}
    ).to_pydict()
    assert table["motion"] == ["seen"] * 100 + ["unseen"] * 100
    assert table["role"] == ["fit"] * 100 + ["validate"] * 100
    assert set(table["foot"]) == {FOOT}
    assert table["used"] == [False] * 7 + [True] * 193
    assert set(table["support"]) == {"double"}
    np.testing.assert_array_equal(table["time"], [*seen.time, *unseen.time])
    np.testing.assert_array_equal(table["pitch.deflection"], [*angle, *-angle])
    np.testing.assert_array_equal(table["roll.torque"], [*400 * angle, *-300 * angle])
    predicted = np.array(table["roll.predicted"])
    np.testing.assert_array_equal(predicted[:100], 390 * angle)
    assert np.isnan(predicted[100:]).all()
    assert np.isnan(table["pitch.predicted"]).all()
