"""Two soles that slide against each other are found in their seconds."""

from __future__ import annotations

import numpy as np

from plantar.contact.slip import sliding

PERIOD = 0.005

SAMPLES = 8000


def test_sliding_soles_are_found_in_their_seconds() -> None:
    random = np.random.default_rng(0)
    time = PERIOD * np.arange(SAMPLES)
    slides = (time > 10) & (time < 12)
    path = np.cumsum(np.where(slides, 0.02, 0.0)) * PERIOD
    position = np.column_stack([path, np.zeros(SAMPLES)]) + 2e-5 * random.standard_normal((SAMPLES, 2))
    found = sliding(position, np.zeros(SAMPLES), np.ones(SAMPLES, dtype=bool), PERIOD)
    assert np.mean(slides[found]) > 0.9, "precision"
    assert np.mean(found[slides]) > 0.9, "recall"
    still = sliding(position[:1900], np.zeros(1900), np.ones(1900, dtype=bool), PERIOD)
    assert not still.any(), "no false alarm on noise"
