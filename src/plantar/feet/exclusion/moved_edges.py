"""Edges of a sole that seem to lie inside of its outline.

A zero of the torque moves the centre of pressure, and a force sensor or an outline may be beside its place.
"""

from __future__ import annotations

import numpy as np

from plantar.contact.polygon import edge_normals
from plantar.conventions import ROTATIONAL_AXES, Array, Mask
from plantar.feet.recording import Recording
from plantar.signals.medians import median
from plantar.signals.segments import steps_in

FEWEST = 0.04  # s beyond an edge, in all: less may be a shock, and the edge is not known
SHELLS = 40  # of equal width, into which the angles are sorted
FILLED = 5  # samples, for a shell's median to be one
STOPPED = 0.25  # of the usual change of the torque with the angle: over an edge there is next to none
LEAST_PLATEAU = 0.01  # rad: a shorter one may be the end of a hysteresis's loop
# m, and of half the sole's width, by which a force sensor or an outline may be beside its place: three deviations of a
# careful lab's 3 mm; of a small foot less, or the middle of the sole would count as its edge.
MISPLACED, MISPLACED_SHARE = 0.01, 0.3


def moved_inwards(recording: Recording, foot: str, depth: Array, polygon: Array) -> Array:
    """By how much each edge of the convex `polygon` (n, 2) [m] seems to have come inwards, (N, n) [m], at least.

    depth: of the centre of pressure inside each edge, (N, n) [m].
    """
    load = np.maximum(recording.bushes[foot].force_z, 1.0)
    moments = np.nan_to_num(depth * load[:, None])
    standing, fewest = recording.contacts[foot].standing, steps_in(FEWEST, recording.period)
    if standing.sum() < fewest:
        return np.zeros_like(depth)
    inwards = np.maximum(
        _passed_opposite(moments[standing], polygon, fewest), _stopped_inside(recording, foot, moments)
    )
    moved = inwards / load[:, None]
    if recording.stances[foot] is None:
        return moved
    return np.maximum(moved, _stopped_near(depth[standing], polygon, fewest))


def _stopped_near(depth: Array, polygon: Array, fewest: int) -> Array:
    """How far inside of each edge the centre of pressure stops, (n,) [m], where a place that is wrong would explain it;
    below zero where it passes the edge.

    A sole that steps tips about all edges that it rolls over, a little in each step, and there the centre of pressure
    stops: that is the edge, wherever its outline is said to be. Where it only turns back near it, a few samples are
    left out without need.
    """
    known = depth[np.isfinite(depth).all(axis=1)]
    if len(known) < fewest:
        return np.zeros(depth.shape[1])
    stop = np.partition(known, fewest - 1, axis=0)[fewest - 1]
    most = min(MISPLACED, MISPLACED_SHARE * float(np.ptp(polygon, axis=0).min()) / 2)
    return np.where(stop < most, stop, 0.0)


def _passed_opposite(moments: Array, polygon: Array, fewest: int) -> Array:
    """By how much the edges are moved [N·m], (n,), where the centre of pressure reads outside of another.

    It cannot leave the sole: the torque is wrong by that distance times the load at least, and an edge on the other
    side, if it was not passed itself, is reached that much earlier.
    """
    last = fewest - 1
    beyond = -np.partition(moments, last, axis=0)[last].clip(max=0.0)
    normals = edge_normals(polygon)
    inwards = ((-normals @ normals.T).clip(min=0.0) * beyond).max(axis=1)
    return np.where(beyond > 0, 0.0, inwards)


def _stopped_inside(recording: Recording, foot: str, moments: Array) -> Array:
    """By how much the edges are moved [N·m], (n,), at which the torque stopped growing while the foot turned on.

    Out and back again: the torque of a bush with friction may stop on the way out, but falls at once on the way back.
    """
    inwards, used, bush = np.zeros(moments.shape[1]), recording.used(foot), recording.bushes[foot]
    for column in range(len(ROTATIONAL_AXES)):
        angle, torque = bush.deflection[used, column], bush.torque[used, column]
        for side in (1.0, -1.0):
            stopped = _plateau(side * angle, side * torque)
            if not stopped.any():
                continue
            held = moments[used][stopped]
            edge = int(np.argmin(np.median(held, axis=0)))
            usual = _spread(torque) / _spread(angle)
            if _spread(held[:, edge]) < STOPPED * usual * _spread(angle[stopped]):
                inwards[edge] = max(inwards[edge], float(np.median(held[:, edge])))
    return inwards


def _plateau(angle: Array, torque: Array) -> Mask:
    """Samples (n,) at the upper end of the angles over which the torque grows no more."""
    none = np.zeros(len(angle), dtype=bool)
    if len(angle) < SHELLS * FILLED or np.ptp(angle) < 2 * LEAST_PLATEAU:
        return none
    width = float(np.ptp(angle)) / SHELLS
    shell = ((angle - angle.min()) / width).astype(np.int16)
    counts = np.bincount(shell)
    filled = np.flatnonzero(counts >= FILLED)
    if len(filled) < SHELLS // 2:
        return none
    ends = np.cumsum(counts)
    by_shell = torque[np.argsort(shell, kind="stable")]
    middles = np.array([median(by_shell[ends[one] - counts[one] : ends[one]]) for one in filled])
    slopes = np.gradient(middles, filled * width)
    growing = np.flatnonzero(slopes > STOPPED * _spread(torque) / _spread(angle))
    if not growing.size:
        return none
    first = float(angle.min()) + (filled[growing[-1]] + 1) * width
    return angle > first if angle.max() - first > LEAST_PLATEAU else none


def _spread(values: Array) -> float:
    """From the 5th to the 95th percentile."""
    return float(np.ptp(np.percentile(values, [5.0, 95.0])))
