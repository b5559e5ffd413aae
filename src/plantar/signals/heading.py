"""An IMU's heading that is set anew, as by a compass: nothing turned, and no number of a foot depends on it."""

from __future__ import annotations

import numpy as np

from plantar.conventions import Array
from plantar.logs.motion_log import MotionLog, imu_columns
from plantar.notes import Note, listing

SET_ANEW = 0.05  # rad within one sample that the gyroscope does not turn: a heading that was set anew
TURNED = 0.5  # share of such a turn that the gyroscope shows at most
LEANING = 0.2  # of such a turn, about other axes than the vertical: more is an attitude that was set anew


def with_one_heading(log: MotionLog) -> MotionLog:
    """The log without jumps of its IMUs' headings, each with a note; the same object where there are none."""
    columns, notes = dict[str, Array](), list[Note]()
    for name in (
        one[4:-14] for one in log.columns if one.startswith("imu.") and one.endswith(".orientation.w")
    ):
        parts = imu_columns(name, "orientation")
        if not {*parts, *imu_columns(name, "angular_velocity")} <= set(log.columns):
            continue
        orientation, rates = log.stack(parts), log.angular_velocity(name)
        turned = np.linalg.norm(rates[1:] + rates[:-1], axis=1) / 2 * np.diff(log.time)
        jumps = heading_jumps(orientation, turned)
        at = np.flatnonzero(jumps)
        if at.size:
            seen = without_jumps(orientation, jumps)
            columns |= dict(zip(parts, seen.T, strict=True))
            times = listing([f"{log.time[row + 1]:.4g} s" for row in at])
            text = f"{log.name}: the heading of imu '{name}' jumps, and nothing turned, at t = {times}: taken out"
            notes.append(Note("heading_jumps", "info", text))
    return log.with_columns(columns, *notes) if notes else log


def heading_jumps(orientation: Array, turned: Array) -> Array:
    """By how much the heading of an orientation (n, 4) jumps between samples, (n - 1,) [rad]: 0 where it does not.

    `turned` (n - 1,) [rad]: by how much the gyroscope turns meanwhile.
    """
    before, after = orientation[:-1], orientation[1:]
    cosine = np.einsum("ni,ni->n", before, after)
    start, stop = before[:, 1:], after[:, 1:]
    axis = before[:, :1] * stop - after[:, :1] * start + np.cross(start, stop)  # in the world
    aside = np.hypot(axis[:, 0], axis[:, 1])
    angle = 2 * np.arctan2(np.linalg.norm(axis, axis=1), np.abs(cosine))  # q and -q are one orientation
    jumps = (angle > SET_ANEW) & (turned < TURNED * angle) & (aside < LEANING * np.abs(axis[:, 2]))
    return np.where(jumps, 2 * np.arctan2(np.where(cosine < 0, -1, 1) * axis[:, 2], np.abs(cosine)), 0.0)


def without_jumps(orientation: Array, jumps: Array) -> Array:
    """The orientation (n, 4) w x y z with its `heading_jumps` turned back."""
    half = -np.concatenate([[0.0], np.cumsum(jumps)]) / 2
    (w, x, y, z), cosine, sine = orientation.T, np.cos(half), np.sin(half)
    return np.column_stack(
        [cosine * w - sine * z, cosine * x - sine * y, cosine * y + sine * x, cosine * z + sine * w]
    )
