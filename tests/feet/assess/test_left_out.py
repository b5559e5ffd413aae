"""Nothing is left out in silence: a foot, or a log, of which nothing can be used says why."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from made_recording import FOOT, made_recording, swayed
from plantar.contact.reasons import Reason
from plantar.feet.assess.left_out import UNUSED, mostly_on_an_edge, unused_logs, why_unseen
from plantar.feet.recording import Recording
from plantar.robot.model import Foot, Placement, Sole, WrenchSensor


def left_out(share: float, reason: Reason) -> Recording:
    """A log of 3000 samples, `share` of them left out for `reason`, the rest for being landings."""
    angle = swayed(3000)
    one = made_recording("sway", angle, 400.0 * angle)
    first = np.arange(len(angle)) < share * len(angle)
    contact = one.contacts[FOOT].without(first, reason).without(~first, Reason.SETTLING)
    return replace(one, contacts={FOOT: contact})


@pytest.mark.parametrize("share", [0.9, 0.2])
def test_the_reason_that_takes_most_is_named_with_its_seconds(share: float) -> None:
    one = left_out(share, Reason.ON_THE_EDGE)
    reason, advice = why_unseen([one, one], FOOT)
    most = Reason.ON_THE_EDGE if share > 0.5 else Reason.SETTLING
    seconds = max(share, 1 - share) * 3000 * one.period
    text = one.contacts[FOOT].reasons[0 if share > 0.5 else 1].text
    assert text.startswith(most.value)
    assert reason == (
        f"the {FOOT} foot has no samples in these logs that can be used: {text} ({2 * seconds:.1f} s)"
    )
    assert advice == "see that reason in “Why did my fit fail?” of the documentation"
    note = unused_logs([one, one])[0]
    assert (note.code, note.severity) == (UNUSED, "warning")
    assert note.text == (f"sway: nothing of this log can be used. {FOOT} foot: {text} ({seconds:.1f} s)")


def test_a_foot_in_the_air_has_to_stand() -> None:
    reason, advice = why_unseen([left_out(0.9, Reason.IN_THE_AIR)], FOOT)
    assert reason == f"the {FOOT} foot has no samples in these logs that can be used"
    assert advice == f"record motions in which the {FOOT} foot stands"
    assert why_unseen([], FOOT) == (reason, advice)


def test_nothing_is_said_of_a_log_with_one_used_sample_or_that_is_alone() -> None:
    one = left_out(0.9, Reason.ON_THE_EDGE)
    code = one.contacts[FOOT].code.copy()
    code[7] = 0
    used = replace(one, contacts={FOOT: replace(one.contacts[FOOT], code=code)})
    assert unused_logs([used, used]) == []
    assert unused_logs([one]) == []


@pytest.mark.parametrize(("share", "told"), [(0.4, False), (0.6, True)])
def test_a_foot_that_mostly_stands_on_an_edge_is_told_which(share: float, told: bool) -> None:
    """Its centre of pressure is 8 mm outside of the left edge; the rest of the time it is in the middle."""
    angle = swayed(3000)
    one = made_recording("sway", angle, 400.0 * angle)
    tips = np.arange(len(angle)) < share * len(angle)
    cop = np.column_stack([np.zeros(len(angle)), np.where(tips, 0.058, 0.0)])
    one = replace(
        one,
        bushes={FOOT: replace(one.bushes[FOOT], cop=cop)},
        contacts={FOOT: one.contacts[FOOT].without(tips, Reason.OUTSIDE_THE_SOLE)},
    )
    corners = np.array([[0.1, 0.05], [-0.1, 0.05], [-0.1, -0.05], [0.1, -0.05]])
    placed = Placement("ankle", np.zeros(3), np.zeros(3))
    foot = Foot(FOOT, "ankle", placed, WrenchSensor(FOOT, placed, 1), Sole(placed, corners), "auto")
    found = mostly_on_an_edge(FOOT, foot, [one])
    assert bool(found) == told
    if told:
        assert found[0].severity == "warning"
        assert found[0].text == (
            "left foot: 18 of the 30 s in which it stands are left out, since a sole that tips turns further than its "
            "bush: its centre of pressure is usually 8 mm outside of the left edge of feet.left.sole.polygon. Measure "
            "the sole; if the outline is right, the foot stands on that edge, and its weight belongs further inwards"
        )
