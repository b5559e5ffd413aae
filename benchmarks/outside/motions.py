"""Motions over standing soles: sways, turns of the ankles, squats, arms; drawn by seed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from scipy.interpolate import CubicSpline

from outside.stance import Stance
from plantar.conventions import Array

KNOTS = 25.0  # Hz, at which the legs are solved
RATE = 1000.0  # Hz
REST, EASE = 1.5, 3.0  # s still at both ends, and from still to full
MOTIONS = ("forward", "sideways", "ankles", "squat", "arms", "mixed")  # the last one validates
PACES = (0.35, 0.8)  # Hz, of the quickest wave of a motion
REACH = 0.42  # of the half of a sole that the centre of mass goes forward before the feet give way
SHIFT = 0.5  # of the half of the stance's width
DIP = 0.03  # of the leg's length
BEND = 0.08  # rad, of the trunk
ROLL, PITCH = 0.4, 0.25  # of half a sole over the height: turns of the ankles that soft feet take up
SWING = 0.35  # rad, of arms, head and waist
WAVES = 4


@dataclass(frozen=True)
class Plan:
    """`start` (7,) x y z w x y z of the root; `targets` (n, joints) at 1000 Hz."""

    name: str
    start: Array
    targets: Array


def plan(stance: Stance, name: str, duration: float, seed: int, size: float = 1.0) -> Plan:
    """A motion of one kind, `size` times as large as usual; raises ValueError where the legs do not reach."""
    random = np.random.default_rng([seed, MOTIONS.index(name)])
    model, time = stance.model, np.arange(0, duration, 1 / KNOTS)
    legs = sorted(column for columns in stance.legs.values() for column in columns)
    upper = [column for column in range(6, model.nv) if column not in legs]
    window = _window(time, duration)
    outlines = [np.array(foot.sole.polygon) for foot in stance.robot.feet.values()]
    half = [min(float(np.ptp(outline[:, axis])) / 2 for outline in outlines) for axis in (0, 1)]
    large = {
        "forward": {"x": REACH * half[0], "upper": 0.1 * SWING},
        "sideways": {"y": SHIFT * stance.width / 2, "upper": 0.1 * SWING},
        "ankles": {"ankles": 1.0},
        "squat": {"z": DIP * stance.length, "x": 0.3 * REACH * half[0], "turn": BEND},
        "arms": {"upper": SWING, "turn": 0.0 if len(upper) > 6 else BEND},
        "mixed": {
            "x": 0.6 * REACH * half[0], "y": 0.7 * SHIFT * stance.width / 2, "z": 0.5 * DIP * stance.length,
            "turn": 0.4 * BEND, "upper": 0.4 * SWING, "ankles": 0.4,
        },
    }[name]  # fmt: skip
    large = {axis: size * large.get(axis, 0.0) for axis in ("x", "y", "z", "turn", "upper", "ankles")}
    quick = 1.0 if name == "arms" else random.uniform(*PACES)
    root = {axis: large[axis] * window * _waves(time, quick, random) for axis in "xyz"}
    trunk = large["turn"] * window[:, None] * np.column_stack([_waves(time, quick, random) for _ in range(3)])
    swings = (
        np.column_stack([_waves(time, quick, random) for _ in upper]) if upper else np.zeros((len(time), 0))
    )
    most = large["ankles"] / stance.length * np.array([ROLL * half[1], PITCH * half[0]])
    ankles = {
        foot: most * window[:, None] * np.column_stack([_waves(time, quick, random) for _ in most])
        for foot in stance.legs
    }
    light = np.array([stance.share(column) for column in upper])
    path, q = [], stance.q
    for row in range(len(time)):
        q = q.copy()
        q[:3] = stance.q[:3] + [root[axis][row] for axis in "xyz"]
        q[2] -= abs(large["z"])
        moved = np.zeros(model.nv)
        moved[3:6] = trunk[row]
        moved[upper] = large["upper"] * window[row] * swings[row] * light
        posed = pin.integrate(model, stance.q, moved)
        q[3:7] = posed[3:7]
        for column in upper:
            q[column + 1] = posed[column + 1]
        q[7:] = np.clip(q[7:], model.lowerPositionLimit[7:], model.upperPositionLimit[7:])
        q, left = stance.solve(
            q, {foot: pin.rpy.rpyToMatrix(*turns[row], 0) for foot, turns in ankles.items()}
        )
        if left > 1e-3:
            raise ValueError(
                f"{stance.robot.name}: '{name}' is out of the legs' reach by {left:.4f} at {time[row]:.1f} s"
            )
        path.append(q)
    table = np.array(path)
    fine = np.arange(0, time[-1], 1 / RATE)
    return Plan(name, table[0, :7][[0, 1, 2, 6, 3, 4, 5]], CubicSpline(time, table[:, 7:])(fine))


def _window(time: Array, duration: float) -> Array:
    edge = np.minimum(time, duration - 1 / KNOTS - time)
    return 0.5 - 0.5 * np.cos(np.pi * np.clip((edge - REST) / EASE, 0, 1))


def _waves(time: Array, quick: float, random: np.random.Generator) -> Array:
    """A sum of sines between a quarter of the quickest [Hz] and the quickest, at most 1."""
    found = np.zeros(len(time))
    for pace in quick * random.uniform(0.25, 1.0, WAVES):
        found += np.sin(2 * np.pi * pace * time + random.uniform(0, 2 * np.pi))
    return np.array(found / np.abs(found).max())
