"""A force sensor that stays behind at each turn, and what must not be taken for it: rubber with friction, noise."""

from __future__ import annotations

import numpy as np
import pytest

from bush_data_sets import Rubber
from made_recording import FOOT, PERIOD, made_recording, swayed
from plantar.conventions import Array
from plantar.feet.assess.sensor_hysteresis import HYSTERESIS, hysteresis_notes
from plantar.feet.fit.axis_fit import fit_axis
from plantar.feet.interval_width.cause import Cause, inflated
from plantar.feet.recording import Recording
from plantar.feet.regression.tangent import Tangent
from plantar.feet.settings import FeetSettings
from plantar.notes import Note

COUNT = 6000
PLAIN = Rubber(stiffness=420.0, damping=18.0)


def behind(torque: Array, width: float) -> Array:
    """What a sensor reads that follows the torque only when it has moved by `width` [N.m]."""
    read, state = np.empty_like(torque), torque[0]
    for place, value in enumerate(torque):
        state = min(max(state, value - width), value + width)
        read[place] = state
    return read


def said(rubber: Rubber, width: float, unsure: float = 0.0) -> list[Note]:
    """`unsure` [N.m.s/rad]: what other causes add to the deviation of the damping."""
    made: list[Recording] = []
    for seed in (0, 1):
        angle, random = swayed(COUNT, seed=seed), np.random.default_rng(seed)
        rate = np.gradient(angle, PERIOD)
        read = behind(rubber.torque(angle, rate), width) + 0.05 * random.standard_normal(COUNT)
        made.append(made_recording(f"sway_{seed}", angle, read, rate=rate))
    fit = fit_axis(made, FOOT, "pitch", FeetSettings())
    assert fit is not None
    wide = inflated(fit, [Cause("delay", np.array([0.0, unsure]), 1.0)])
    return hysteresis_notes(Tangent.of(fit, made, False), wide)


@pytest.mark.parametrize("width", [0.1, 0.3])
def test_hysteresis_of_the_sensor_is_told_with_its_size(width: float) -> None:
    (note,) = said(PLAIN, width)
    assert (note.code, note.severity) == (HYSTERESIS, "warning")
    assert float(note.text.split("stays ")[1].split()[0]) == pytest.approx(width, rel=0.4)


def test_hysteresis_whose_damping_the_interval_holds_is_not_told() -> None:
    """As where sensors may be late by any time: 0.1 N.m takes some 1 N.m.s/rad off the damping. The sign gives back a
    part of that: it is told, too, where that part alone would be inside."""
    assert [len(said(PLAIN, 0.1, unsure)) for unsure in (0.05, 1.1, 5.0)] == [1, 1, 0]


@pytest.mark.parametrize(
    "rubber",
    [
        PLAIN,
        Rubber(stiffness=420.0, damping=18.0, slip_torque=4.0, slip_angle=0.006),
        Rubber(stiffness=420.0, damping=18.0, hardening=3e5),
        Rubber(stiffness=420.0, damping=18.0, coulomb=1.5),
    ],
)
def test_no_sound_sensor_is_told_of_it(rubber: Rubber) -> None:
    assert said(rubber, 0.0) == []
