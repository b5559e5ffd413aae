"""The table behind the plots: a row for each sample, foot and motion, NaN where nothing was predicted."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from made_recording import FOOT, made_recording, predicted_torque, swayed
from plantar.contact.reasons import Reason
from plantar.feet.assess.residual_table import residual_table
from plantar.feet.regression.prediction import Prediction


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


def test_every_column_is_its_own_quantity_of_its_own_axis() -> None:
    random, count = np.random.default_rng(0), 50
    recording = made_recording("sway", np.zeros(count), np.zeros(count))
    names = ("deflection", "rate", "torque", "cop")
    drawn = {name: random.normal(size=(count, 2)) for name in names}
    load = random.normal(size=count)
    state = replace(recording.bushes[FOOT], **drawn, force_z=load)
    parts = [random.normal(size=count) for _ in range(3)]
    prediction = Prediction(*parts, np.ones(count, dtype=bool))
    table = residual_table([replace(recording, bushes={FOOT: state})], {("sway", FOOT, "pitch"): prediction})
    for column, axis in enumerate(("pitch", "roll")):
        for name in names[:3]:
            np.testing.assert_array_equal(table[f"{axis}.{name}"].to_numpy(), drawn[name][:, column])
    for column, name in enumerate(("cop_x", "cop_y")):
        np.testing.assert_allclose(table[name].to_numpy(), drawn["cop"][:, column], rtol=1e-6)
    np.testing.assert_allclose(table["force_z"].to_numpy(), load, rtol=1e-6)
    np.testing.assert_array_equal(table["pitch.predicted"].to_numpy(), parts[0])
    np.testing.assert_array_equal(table["pitch.offset"].to_numpy(), parts[0] - parts[1])
    assert np.isnan(table["roll.offset"].to_numpy()).all()
