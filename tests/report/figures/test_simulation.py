"""The picture of what was simulated over what was recorded."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.comparison.scenes import CONTACT
from plantar.report.figures.simulation import replays
from plantar.twin.replay import Replayed

FEET = ("rigid, as the model was", "exported joints", CONTACT, "contact, loop")


@pytest.mark.parametrize("motions", [("Squat",), ("Squat", "Tilt5", "Tilt6", "Myrand5")])
def test_the_legend_stays_inside_the_picture(motions: tuple[str, ...]) -> None:
    time = np.linspace(0.0, 1.0, 50)
    chest, torque = 0.01 * np.column_stack([time, time]), {("left", "pitch"): time}
    found = [
        Replayed(motion, feet, time, torque, torque, chest, chest) for motion in motions for feet in FEET
    ]
    figure = replays(found, CONTACT)
    figure.draw_without_rendering()
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["recorded", CONTACT, *FEET[:2], FEET[3]]
    inside, whole = legend.get_window_extent(), figure.bbox
    assert whole.x0 <= inside.x0
    assert inside.x1 <= whole.x1
