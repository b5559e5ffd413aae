"""The comment at an export's head: each number with its own unit, and what was done to the model."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.conventions import Axis
from plantar.exporters.bush import FootBush
from plantar.exporters.comment import head, joints_note, moved_note, plate_note
from plantar.exporters.spring import Slip, Spring
from plantar.notes import Note

SOLE = np.array([[0.13, 0.06, -0.1], [-0.09, 0.06, -0.1], [-0.09, -0.04, -0.1], [0.13, -0.04, -0.1]])
SPRINGS = (
    Spring("z", 2.5e5, 120.0, 3.0, assumed=True),
    Spring("pitch", 434.0, 15.5, 8.68, slip=Slip(5.25, 0.0125)),
    Spring("roll", 323.0, 17.5, -6.46),
)
FOOT = FootBush("left", "ankle", SPRINGS, np.zeros(3), np.eye(3), SOLE)
RESULT = {"robot": "biped", "plantar": "0.1.0"}


def test_every_spring_is_told_with_its_units() -> None:
    notes = [Note("a", "warning", "beware"), Note("b", "info", "by the way")]
    lines = head(RESULT, [FOOT], "MuJoCo", notes, with_offset=True)
    assert lines == [
        "Feet of 'biped', identified by plantar 0.1.0,",
        "for MuJoCo.",
        "LLEG_BUSH_Z (left foot, slide along z, compressed > 0): K = 250000 N/m, C = 120 N.s/m (assumed), offset = 3 N",
        "LLEG_BUSH_PITCH (left foot, pitch about y, toes down > 0): K = 434 N.m/rad, C = 15.5 N.m.s/rad, "
        "slips at 5.25 N.m after 0.0125 rad, offset = 8.68 N.m",
        "LLEG_BUSH_ROLL (left foot, roll about x, left edge up > 0): K = 323 N.m/rad, C = 17.5 N.m.s/rad, "
        "offset = -6.46 N.m",
        "Each spring rests at -offset/K.",
        "warning: beware",
        "info: by the way",
    ]
    without = head(RESULT, [FOOT], "MuJoCo", (), with_offset=False)
    assert not any("offset =" in line for line in without)
    assert without[-1].startswith("Each spring rests at 0:")
    jointless = head(RESULT, [FOOT], "Drake's contact", (), with_offset=False, joints=False)
    assert jointless[3].startswith("left foot, pitch about y, toes down > 0: K = 434 N.m/rad")
    assert not any("BUSH" in line for line in jointless)


@pytest.mark.parametrize(("axis", "rest"), [("z", -3.0 / 2.5e5), ("pitch", -0.02), ("roll", 0.02)])
def test_a_spring_rests_where_its_offset_is_undone(axis: Axis, rest: float) -> None:
    spring = FOOT.spring(axis)
    assert spring is not None
    assert spring.rest == pytest.approx(rest)
    assert spring.stiffness * spring.rest + spring.offset == pytest.approx(0.0)


def test_what_was_done_to_the_model_is_said_in_millimetres_and_by_name() -> None:
    assert "220 x 100 mm" in plate_note(FOOT).text
    assert "left foot LLEG_BUSH_Z, LLEG_BUSH_PITCH, LLEG_BUSH_ROLL" in joints_note([FOOT]).text
    assert moved_note(FOOT, ["a", "b"]).text == "left: moved from 'ankle' to the sole: a, b"


def test_the_loss_and_stiffness_of_a_slip_are_those_of_its_loop() -> None:
    """A Jenkins element through a cycle of some swing: first harmonic in phase, area of the loop."""
    slip, swing = Slip(5.0, 0.01), 0.03
    angle = swing * np.cos(np.linspace(0.0, 4 * np.pi, 80001))
    held, torque = 0.0, np.zeros(len(angle))
    for place, now in enumerate(angle):
        held = min(max(held, now - slip.angle), now + slip.angle)
        torque[place] = slip.torque / slip.angle * (now - held)
    last = slice(40000, 80001)
    phase = np.linspace(0.0, 2 * np.pi, 40001)
    in_phase = np.trapezoid(torque[last] * np.cos(phase), phase) / np.pi / swing
    assert slip.stiffness_at(swing) == pytest.approx(in_phase, rel=1e-3)
    assert slip.stiffness_at(0.009) == slip.stiffness_at(0.01) == pytest.approx(500.0)
    area = np.trapezoid(torque[last], angle[last])
    damper = np.pi * slip.damping_at(swing) * 3.0 * swing**2  # what a damper loses a cycle at 3 rad/s
    assert damper == pytest.approx(abs(area), rel=1e-3)
