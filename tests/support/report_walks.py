"""A made-up feet result of two fitted walks and an unseen one, with residuals: numbers that a chart can be read by."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from plantar.contact.phases import Phase
from plantar.notes import Note
from plantar.results.feet import FeetResult, Input, Offset, Parameter, ValidationRow
from plantar.results.residuals import Track
from plantar.results.walk_rows import StanceStiffness, SwingZero, WalkStiffness

STIFFNESS = 500.0  # N·m/rad
WALKS = {"walk_1": "fit", "walk_2": "fit", "walk_3": "validate"}
STANCES, PERIOD, RATE = 5, 1.0, 100.0  # of each walk, s, Hz
OFFSETS = (3.0, -4.0, 1.0, 0.0, 6.0)  # N·m, of the stances


def walk_tracks(foot: str = "left", motions: Sequence[str] = tuple(WALKS)) -> list[Track]:
    """Half of each period in the air; pitch torque is the spring's, a stance's offset, and 0.5 N·m that is missed."""
    time = np.arange(0.0, STANCES * PERIOD, 1 / RATE)
    number, stands = (time // PERIOD).astype(int), np.mod(time, PERIOD) < PERIOD / 2
    offset = np.where(stands, np.array(OFFSETS)[number], np.nan)
    angle = np.where(stands, 0.02 * np.sin(4 * np.pi * time / PERIOD), 0.3)
    predicted = STIFFNESS * angle + offset
    values = {"force_z": 400.0 * stands}
    for axis in ("pitch", "roll"):
        values |= {f"{axis}.deflection": angle, f"{axis}.torque": np.where(stands, predicted + 0.5, 90.0),
                   f"{axis}.predicted": predicted, f"{axis}.offset": offset}  # fmt: skip
    support = np.where(stands, "single", "air")
    return [Track(motion, WALKS[motion], foot, time, stands, support, values) for motion in motions]


def walk_result() -> FeetResult:
    """The left foot steps."""
    stances = [
        StanceStiffness(motion, role, "left", axis, k * PERIOD, k * PERIOD + 0.49, STIFFNESS + 10 * k, 0.1 + 0.01 * k)
        for axis in ("pitch", "roll")
        for motion, role in WALKS.items()
        for k in range(STANCES)
    ]  # fmt: skip
    walks = [
        WalkStiffness(motion, role, "left", axis, STANCES, STIFFNESS + 5, (STIFFNESS - 15, STIFFNESS + 25))
        for axis in ("pitch", "roll")
        for motion, role in WALKS.items()
    ]
    zeros = [
        SwingZero(
            motion, "left", 0.75 + k,
            (1.0, -2.0, -40.0 + k), (0.1, 0.2, 0.3), (1.0, -2.0, -38.0), (0.1, 0.2, 0.3),
        )
        for motion in WALKS
        for k in range(STANCES)
    ]  # fmt: skip
    half = (STIFFNESS - 8.0, STIFFNESS + 8.0)
    parameters = [
        Parameter("left", axis, "stiffness", "N.m/rad", STIFFNESS, 4.0, half, 0.1, "usable", "narrow")
        for axis in ("pitch", "roll")
    ]
    scores = [
        ValidationRow("cross", "walk_3", "left", axis, 0.5, 0.6, 12.0, 4.0, 5.0, 250) for axis in ("pitch", "roll")
    ]  # fmt: skip
    return FeetResult(
        robot="walker",
        inputs=tuple(Input(f"{motion}.csv", None, role) for motion, role in WALKS.items()),
        settings={"offset": "per-motion"},
        model="kelvin_voigt",
        parameters=tuple(parameters),
        offsets=tuple(Offset("left", "pitch", motion, "N.m", 1.0, 0.1) for motion in ("walk_1", "walk_2")),
        phases=(Phase("walk_1", "left", 0.0, 0.5, "single", True, None),),
        validation=tuple(scores),
        notes=(
            Note("spikes", "warning", "walk_1: one sample bridged"),
            Note("spikes", "warning", "walk_2: two samples bridged"),
            Note("delay_unknown", "warning", "delay of the wrenches unknown"),
            Note("air_zero", "info", "walk_1: zero taken off"),
        ),
        stances=tuple(stances),
        walks=tuple(walks),
        swing_zeros=tuple(zeros),
    )


def standing_result() -> FeetResult:
    """The same without steps."""
    return replace(walk_result(), stances=(), walks=(), swing_zeros=())
