"""A replayed log as a picture: each line in its own panel, and bands only where something is known."""

from __future__ import annotations

import numpy as np

from plantar.online.estimates import FIELDS, Contact
from plantar.online.replay import Replay
from plantar.report.figures.replay import replay_picture


def replayed() -> Replay:
    time = np.linspace(0.0, 10.0, 101)
    rows = np.zeros((101, 2, len(FIELDS)))
    rows[:, 1, FIELDS.index("contact")] = np.where((time > 4.0) & (time < 6.0), Contact.AIR, Contact.STANCE)
    for name, value in {
        "roll.deflection": 0.01 * np.sin(time),
        "roll.stiffness": np.full(101, 400.0),
        "roll.stiffness.half_width": np.where(time < 3.0, 300.0, 20.0),
        "roll.damping": np.full(101, 15.0),
        "roll.damping.half_width": np.full(101, 2.0),
        "pitch.stiffness": np.full(101, -400.0),
    }.items():
        rows[:, 1, FIELDS.index(name)] = value
    return Replay(time, ("left", "right"), rows, np.ones(101))


def test_each_number_stands_in_its_own_panel() -> None:
    figure = replay_picture(replayed())
    titles = [panel.get_title() for panel in figure.axes[:4]]
    assert titles == ["left pitch", "left roll", "right pitch", "right roll"]
    deflection, stiffness, damping = (figure.axes[row * 4 + 3] for row in range(3))
    time, line = deflection.lines[0].get_data()
    stands = np.isfinite(line)
    np.testing.assert_allclose(line[stands], 10.0 * np.sin(time[stands]))
    assert not stands[(time > 4.0) & (time < 6.0)].any()
    assert len(deflection.patches) == 1, "the air is grey"
    for panel, value, half in ((stiffness, 400.0, 20.0), (damping, 15.0, 2.0)):
        time, line = panel.lines[0].get_data()
        assert np.isnan(line[time < 3.0]).all()
        assert (line[time > 3.0] == value).all()
        band = panel.collections[0].get_paths()[0].vertices[:, 1]
        assert (band.min(), band.max()) == (value - half, value + half)


def test_a_stiffness_below_zero_is_not_drawn() -> None:
    panel = replay_picture(replayed()).axes[4 + 2]
    assert np.isnan(panel.lines[0].get_ydata()).all()
