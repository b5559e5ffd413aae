"""Turns of vectors, two ways."""

from __future__ import annotations

import numpy as np

from plantar.conventions import rotated, rotation_from_quaternion


def test_quaternions_turn_vectors_as_their_rotations_do() -> None:
    random = np.random.default_rng(0)
    unit = random.normal(size=(50, 4))
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    vectors = random.normal(size=(50, 3))
    expected = np.einsum("nij,nj->ni", rotation_from_quaternion(unit), vectors)
    np.testing.assert_allclose(rotated(unit, vectors), expected, atol=1e-14)
