"""The family of motions: at rest at both ends, a half and its mirror image."""

from __future__ import annotations

import numpy as np
import pytest

from plantar.design.family import (
    CHANNELS,
    MIRRORED,
    Lines,
)

LINES = 2
RAMP = 4.0
REST = 2.0

LINES_OF = Lines.drawn(40.0, np.random.default_rng(3))


def test_every_motion_begins_and_ends_at_rest() -> None:
    time = LINES_OF.time(200.0)
    moved = LINES_OF.displacements(np.random.default_rng(0).standard_normal(LINES_OF.size), time)
    still = (time <= REST) | (time >= 40.0 - REST)
    assert np.abs(moved[:, still]).max() == 0.0
    assert np.abs(np.gradient(moved, time, axis=1)[:, still]).max() < 1e-3
    assert (np.abs(moved).max(axis=1) > 0.1).all()


def test_the_second_half_is_the_mirror_image_of_the_first() -> None:
    time = LINES_OF.time(50.0)
    moved = LINES_OF.displacements(np.random.default_rng(0).standard_normal(LINES_OF.size), time)
    early = (time > 8.0) & (time < 12.0)  # away from where the halves overlap
    later = np.flatnonzero(early) + round((20.0 - RAMP / 2 - REST) * 50)
    for row, channel in enumerate(CHANNELS):
        image, sign = MIRRORED[channel]
        assert moved[CHANNELS.index(image), later] == pytest.approx(sign * moved[row, early], abs=1e-9)
        assert MIRRORED[image] == (channel, sign)


def test_one_channel_can_be_kept_at_rest() -> None:
    time, drawn = LINES_OF.time(50.0), np.random.default_rng(0).standard_normal(LINES_OF.size)
    whole, still = (LINES_OF.displacements(each, time) for each in (drawn, LINES_OF.without(drawn, "arms")))
    arms = CHANNELS.index("arms")
    assert np.abs(whole[arms]).max() > 0.1
    assert not still[arms].any()
    np.testing.assert_allclose(
        np.delete(still, arms, axis=0), np.delete(whole, arms, axis=0), rtol=1e-6, atol=1e-12
    )


def test_no_two_lines_share_a_frequency() -> None:
    assert len(np.unique(LINES_OF.frequencies)) == len(CHANNELS) * LINES


def test_the_same_draw_gives_the_same_lines() -> None:
    again = Lines.drawn(40.0, np.random.default_rng(3))
    assert np.array_equal(again.frequencies, LINES_OF.frequencies)
