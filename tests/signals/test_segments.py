"""Segments: runs of true samples."""

from __future__ import annotations

import numpy as np

from plantar.signals.segments import runs


def test_runs_are_the_stretches_of_true() -> None:
    assert runs(np.array([1, 1, 0, 1, 0, 0, 1], dtype=bool)) == [slice(0, 2), slice(3, 4), slice(6, 7)]
    assert runs(np.zeros(4, dtype=bool)) == []
    assert runs(np.ones(4, dtype=bool)) == [slice(0, 4)]
