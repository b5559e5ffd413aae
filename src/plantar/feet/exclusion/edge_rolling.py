"""A sole on its edge: the centre of pressure stops there while the foot goes on turning, and the bush does not.

A sole tips only while the centre of pressure is at its edge. There the angle is the bush's and the sole's lean
together: what it exceeds torque over stiffness by is the lean. Hysteresis and hardening make that excess wander as
well, so it is counted from where it was just before the edge and just behind it; and the zeros of force and torque move
the edge, so it is looked for where the centre of pressure stopped while the lean was beyond doubt, and further inside
where the centre of pressure reads outside of the edge on the other side.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.contact.phases import joined, widened
from plantar.contact.polygon import edge_distances
from plantar.contact.reasons import Reason
from plantar.conventions import GRAVITY, ROTATIONAL_AXES, Array, Mask
from plantar.estimation import fit_blocks
from plantar.estimation.errors_in_variables import NORMAL
from plantar.faults.air_readings import TORQUE_OFF
from plantar.feet.exclusion.moved_edges import FEWEST, moved_inwards
from plantar.feet.recording import Recording, filtered
from plantar.feet.regression.regression_data import blocks_of
from plantar.feet.settings import FeetSettings
from plantar.robot.model import RobotModel
from plantar.signals.filters import low_pass
from plantar.signals.segments import runs, steps_in

LEAST_LEAN = 0.003  # rad: less hardly disturbs a deflection
SURE = 6.0  # times the usual change of the excess over NEAR: a lean beyond doubt
QUICK_CUTOFF = 20.0  # Hz: the common filter of the fit would blur when a lean begins
BESIDE = 0.3  # of the fit's filter's period, left out beside a lean
PRESSURE_NOISE = 4.0  # usual deviations of the centre of pressure where it stops
LEAST_BAND = 0.0007  # m inside of where it stops: still there
NEAR = 0.1  # s before and behind the edge, in which the excess is that of a flat sole
SMEAR = 0.02  # s that this filter spreads a lean
FLAT_SEARCH = 0.5  # s: how far a flat sole is looked for
VISIT_PAUSE = 0.05  # s: visits to the edge that are closer are one
# m, times the weight: the torque's zero; a sensor that is farther off is told to be zeroed. A small foot's is made for
# smaller torques: a share of half the sole's width, or the middle of the sole would count as its edge.
LARGEST_ZERO, ZERO_SHARE = TORQUE_OFF, 0.125
# By how much an outline that is a guess may be too large [m, and of half the sole's width]: a sole tips before it seems
# to be at its edge.
GUESSED, GUESSED_SHARE = 0.015, 0.15


def without_edge_rolling(
    robot: RobotModel, recordings: Sequence[Recording], settings: FeetSettings
) -> list[Recording]:
    """The recordings without samples in which a sole leans on its edge; what is near the edge and flat is used.

    Feet with `contact: always` are left as they are: their centre of pressure means nothing. Of feet that step all that
    is near the edge is left out: they reach it while they land and tip, too little each time to be told from flat.
    """
    rest = list(recordings)
    for name, foot in robot.feet.items():
        if foot.contact != "always":
            guessed = any(guess.key.startswith(f"feet.{name}.sole") for guess in robot.guesses)
            half = float(np.ptp(foot.sole.polygon, axis=0).min()) / 2
            inner, zero = min(GUESSED, GUESSED_SHARE * half), min(LARGEST_ZERO, ZERO_SHARE * half)
            margin = settings.edge_margin + (inner if guessed else 0.0)
            largest = zero * robot.mass * GRAVITY
            rest = _flat(rest, name, foot.sole.polygon, settings.edge_margin, margin, largest)
    return rest


def _flat(
    recordings: Sequence[Recording], name: str, polygon: Array, beyond: float, margin: float, largest: float
) -> list[Recording]:
    """The recordings without leans of one foot: it may tip within `margin` [m] of its border, and cannot be loaded
    `beyond` it; no zero of the torque is taken to be larger than `largest` [N·m]."""
    edges = [_edges(recording, name, polygon, margin) for recording in recordings]
    if not any(near.any() for _, _, near in edges):
        return list(recordings)
    stand, rest = any(one.stances[name] is None for one in recordings), []
    model = _bush_model(recordings, name, [near for _, _, near in edges]) if stand else None
    if stand and model is None and margin > beyond:  # nothing is clear of so wide a border
        return _flat(recordings, name, polygon, beyond, beyond, largest)
    for recording, (depth, inwards, edge) in zip(recordings, edges, strict=True):
        contact = recording.contacts[name]
        if not edge.any():
            rest.append(recording)
            continue
        reach = round(BESIDE / recording.cutoff / recording.period)
        if model is None or recording.stances[name] is not None:
            beside = widened(edge, reach) & contact.standing
            rest.append(
                recording.without(name, edge, Reason.NEAR_THE_EDGE).without(
                    name, beside, Reason.BESIDE_TIPPING
                )
            )
            continue
        stiffness, damping, usual = model
        # Of a stiff bush most of a torque's offset is the angle's zero, which moves no edge.
        zero = 0.0 if name in {swing.foot for swing in recording.zeros} else min(usual, largest)
        bush = filtered(recording.raw[name], recording.period, QUICK_CUTOFF)
        load = np.maximum(bush.force_z, 1.0)
        excess = bush.deflection - (bush.torque - damping * bush.rate) / stiffness
        outside = (depth < -beyond - (zero / load)[:, None]).any(axis=1)
        recording = recording.without(name, contact.standing & outside, Reason.OUTSIDE_THE_SOLE)
        used, leans = recording.used(name), np.zeros(len(load), dtype=bool)
        for border, inward in zip(depth.T, inwards.T, strict=True):
            visits = contact.standing & (border < margin + np.maximum(zero / load, inward))
            leans |= leaning(excess, border, load, visits, used, recording.period)
        beside = widened(leans | (contact.standing & outside), reach)
        rest.append(
            recording.without(name, leans & contact.standing, Reason.ON_THE_EDGE).without(
                name, beside & contact.standing, Reason.BESIDE_TIPPING
            )
        )
    return rest


def _edges(recording: Recording, foot: str, polygon: Array, margin: float) -> tuple[Array, Array, Mask]:
    """How far inside of each edge the centre of pressure is, and by how much the edge has moved, (N, n) [m]; where the
    foot stands within `margin` of one, (N,)."""
    cop = low_pass(recording.bushes[foot].cop, recording.period, QUICK_CUTOFF)
    depth = edge_distances(cop, polygon)
    inwards = moved_inwards(recording, foot, depth, polygon)
    near = (depth - inwards).min(axis=1) < margin
    return depth, inwards, np.asarray(recording.contacts[foot].standing & near)


def leaning(excess: Array, depth: Array, load: Array, visits: Mask, flat: Mask, period: float) -> Mask:
    """Samples in which a sole leans on one edge.

    excess: (N, 2), the deflection beyond what torque and damping explain [rad]; depth: of the centre of pressure inside
    the edge, (N,) [m]; load: (N,) [N]; visits: where the edge may be reached; flat: where the sole may be taken as flat
    when it is not there.
    """
    rest = flat & np.isfinite(excess).all(axis=1) & ~widened(visits, round(SMEAR / period))
    least = max(LEAST_LEAN, SURE * _usual_change(excess, rest, steps_in(NEAR, period)))
    sure = _lean(excess, visits, rest, period) > least
    if sure.sum() * period < FEWEST:
        return sure
    # A zero of the torque moves the edge by zero / load.
    moment = depth * load
    stop = float(np.median(moment[sure]))
    spread = PRESSURE_NOISE * NORMAL * float(np.median(np.abs(moment[sure] - stop)))
    pinned = visits & (moment < stop + np.maximum(spread, LEAST_BAND * load))
    rest = flat & np.isfinite(excess).all(axis=1) & ~pinned & ~widened(sure, round(SMEAR / period))
    return sure | (_lean(excess, pinned, rest, period) > LEAST_LEAN)


def _lean(excess: Array, visits: Mask, flat: Mask, period: float) -> Array:
    """Lean of the sole during visits to an edge, (N,) [rad], 0 elsewhere; infinite where no flat sole is near."""
    lean = np.zeros(len(visits))
    near, far = steps_in(NEAR, period), steps_in(FLAT_SEARCH, period)
    for visit in runs(joined(visits, round(VISIT_PAUSE / period))):
        first = max(0, visit.start - far)
        before = first + np.flatnonzero(flat[first : visit.start])[-near:]
        behind = visit.stop + np.flatnonzero(flat[visit.stop : visit.stop + far])[:near]
        if not before.size and not behind.size:
            lean[visit] = np.inf
            continue
        ends = [np.median(excess[side], axis=0) for side in (before, behind) if side.size]
        share = np.linspace(0.0, 1.0, visit.stop - visit.start)[:, None]
        resting = (1 - share) * ends[0] + share * ends[-1]
        lean[visit] = np.linalg.norm(excess[visit] - resting, axis=1)
    return lean


def _bush_model(
    recordings: Sequence[Recording], foot: str, edges: Sequence[Mask]
) -> tuple[Array, Array, float] | None:
    """Stiffness and damping of pitch and roll, (2,) each, from samples clear of the edge, and the usual torque zero.

    None where no recording to fit has enough.
    """
    clear = [
        recording.without(foot, widened(edge, round(NEAR / recording.period)), Reason.SET_ASIDE)
        for recording, edge in zip(recordings, edges, strict=True)
    ]
    values, zeros = [], []
    for axis in ROTATIONAL_AXES:
        blocks = blocks_of(clear, foot, axis)
        if not blocks:
            return None
        fit = fit_blocks(blocks)
        if fit.values[0] <= 0:
            return None
        values.append(fit.values[:2])
        zeros += list(fit.offsets.values())
    stiffness, damping = np.array(values).T
    return stiffness, damping, float(np.sqrt(np.mean(np.square(zeros))))


def _usual_change(excess: Array, flat: Mask, lag: int) -> float:
    """Median size of the change of the excess over `lag` samples of a flat sole [rad]."""
    both = flat[lag:] & flat[:-lag]
    if not both.any():
        return 0.0
    change = excess[lag:][both] - excess[:-lag][both]
    return float(np.median(np.linalg.norm(change, axis=1)))
