"""A known load on an exported foot, and what its settled angle and the decay after release must give back."""

from __future__ import annotations

import os
import subprocess

import numpy as np
import pytest
from scipy.integrate import simpson
from scipy.spatial.transform import Rotation

from export_robots import TRUTH

LOAD = {"pitch": 5.0, "roll": 4.0, "z": 300.0}  # N·m, N
SIDE = {"left": "LLEG", "right": "RLEG"}
DIRECTION = {"roll": 0, "pitch": 1, "z": 2}
TOLERANCE = 0.005


def joint_name(foot: str, axis: str) -> str:
    return f"{SIDE[foot]}_BUSH_{axis.upper()}"


def check(
    foot: str, axis: str, load: float, settled: float, times: np.ndarray, decay: np.ndarray, rest: float = 0.0
) -> None:
    """K from the settled deflection, C from the decay after release, against the truth."""
    k, c, _ = TRUTH[foot][axis]
    assert load / (settled - rest) == pytest.approx(k, rel=TOLERANCE)
    area = simpson(decay - rest, x=times)
    assert k * area / (decay[0] - decay[-1]) == pytest.approx(c, rel=TOLERANCE)


def measured(load: float, decay: np.ndarray, step: float) -> tuple[float, float]:
    """K and C from a decay (n,) that starts where the load had settled.

    Integrated over the decay, m q̈ + C q̇ + K q = 0 leaves C·q(0) = K·∫q dt, whatever the sole's mass m: both ends are at
    rest.
    """
    k = load / decay[0]
    return float(k), float(k * simpson(decay, dx=step) / (decay[0] - decay[-1]))


def deflection(axis: str, bush: np.ndarray, ankle: np.ndarray, sole: np.ndarray) -> float:
    """Of an axis, from poses x y z, quaternion x y z w, (7,) of ankle and sole in the world [rad, or m for z]."""
    frame = Rotation.from_quat(ankle[3:]).as_matrix() @ bush
    own = frame.T @ Rotation.from_quat(sole[3:]).as_matrix()
    if axis == "z":
        return float((frame.T @ (sole[:3] - ankle[:3]))[2])
    return float(np.arctan2(own[0, 2], own[2, 2]) if axis == "pitch" else -np.arcsin(own[1, 2]))


def other_python(variable: str, package: str) -> str:
    """The Python that an environment variable names, for an engine that does not live in this one; else a skip."""
    python = os.environ.get(variable)
    if not python or subprocess.run([python, "-c", f"import {package}"], capture_output=True).returncode:
        pytest.skip(f"no {package}: name a Python that has it in {variable}")
    return python
