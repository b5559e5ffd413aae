"""Which foot stands, when, and which samples are used: every one left out carries its reason."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from plantar.contact.reasons import LeftOut, Reason
from plantar.conventions import Array, Mask
from plantar.errors import clock
from plantar.notes import Note
from plantar.signals.filters import low_pass
from plantar.signals.segments import runs

LANDING_SHARE = 0.10  # of the weight: a foot that carries more stands
# Of the weight: a foot that carries less is in the air; between the two it keeps its state.
LIFTING_SHARE = 0.05
SETTLING_TIME = 0.25  # s around landing and lifting, left out: the sole is not flat yet
SETTLING_SHARE = 0.1  # of a stance, at most: a foot that steps lands and lifts faster
SHORTEST_STANCE = 0.5  # s: shorter contacts are scuffs or impacts, not stances

SHAKING_BAND = 20.0  # Hz: no robot that stands is loaded or moved on purpose so fast
SHAKING_TIME = 0.1  # s over which shaking is judged
SHAKING_SHARE = 0.02  # of the weight, rms: a sole that is shaken by more slaps or chatters
SHAKING_NOISE = 7.0  # times the log's calmest shaking, which is the sensor's noise

HOISTING = 2.5  # s over which loads are averaged twice: no squat and no walk changes them for so long
# Of the weight: what feet carry together changes by less where one sensor's gain is off by a tenth
HOISTED_SHARE = 0.1
HOISTED_AROUND = 1.0  # s before and behind, in which the load is given over

DOUBLE, SINGLE, AIR, TRANSITION = "double", "single", "air", "transition"
SUPPORTS = (DOUBLE, SINGLE, AIR, TRANSITION)


@dataclass(frozen=True)
class Phase:
    """A segment of one foot's log in one state: `used` says whether it was used, `reason` why not."""

    motion: str
    foot: str
    start: float
    end: float
    support: str
    used: bool
    reason: str | None

    def to_dict(self) -> dict[str, object]:
        return {**vars(self), "start": round(self.start, 6), "end": round(self.end, 6)}


@dataclass(frozen=True)
class FootContact:
    """One foot through one log: its `support` at each sample (index into SUPPORTS) and why a sample is left out.

    Sample i is used where `code[i]` is 0, else left out for `reasons[code[i] - 1]`.
    """

    support: NDArray[np.int8]
    code: NDArray[np.int8]
    reasons: tuple[LeftOut, ...] = ()

    @cached_property
    def used(self) -> Mask:
        return np.asarray(self.code == 0)

    @property
    def loaded(self) -> Mask:
        """Samples in which the foot is not in the air, landing and lifting among them."""
        return np.asarray(self.support != SUPPORTS.index(AIR))

    @property
    def standing(self) -> Mask:
        """Samples in double or single support."""
        return np.asarray(self.support < SUPPORTS.index(AIR))

    def without(self, samples: Mask, reason: Reason, detail: str = "") -> FootContact:
        """The same contact with `samples` (N,) left out; those that have a reason already keep it."""
        why = LeftOut(reason, detail)
        reasons = self.reasons if why in self.reasons else (*self.reasons, why)
        code = np.where(samples & (self.code == 0), np.int8(reasons.index(why) + 1), self.code)
        return replace(self, code=code, reasons=reasons)

    def decimated(self, rows: slice) -> FootContact:
        """Every nth sample."""
        return replace(self, support=self.support[rows], code=self.code[rows])

    def left_out_for(self, reasons: Collection[Reason]) -> Mask:
        """Samples that are left out for one of these reasons."""
        given = [place + 1 for place, why in enumerate(self.reasons) if why.reason in reasons]
        return np.isin(self.code, given)

    def phases(self, motion: str, foot: str, time: Array) -> list[Phase]:
        """The log as segments of one support and one reason."""
        change = (np.diff(self.support) != 0) | (np.diff(self.code) != 0)
        starts = np.concatenate([[0], np.flatnonzero(change) + 1])
        ends = np.concatenate([starts[1:], [len(time) - 1]])
        found = []
        for start, end in zip(starts, ends, strict=True):
            code, support = int(self.code[start]), SUPPORTS[self.support[start]]
            reason = self.reasons[code - 1].text if code else None
            found.append(
                Phase(motion, foot, float(time[start]), float(time[end]), support, reason is None, reason)
            )
        return found


def detect_contact(
    force: Mapping[str, Array], always: Mapping[str, bool], weight: float, period: float
) -> dict[str, FootContact]:
    """Contact of each foot from its vertical force [N], (N,) each, evenly sampled every `period` [s].

    `always` names feet that stand throughout whatever their force says; `weight` [N] is the robot's.
    """
    stands = {
        foot: np.ones(len(values), dtype=bool) if always[foot] else _standing(values, weight, period)
        for foot, values in force.items()
    }
    count = np.sum(list(stands.values()), axis=0)
    contacts = {}
    for foot, standing in stands.items():
        support = np.full(len(standing), SUPPORTS.index(AIR), dtype=np.int8)
        support[standing & (count > 1)] = SUPPORTS.index(DOUBLE)
        support[standing & (count == 1)] = SUPPORTS.index(SINGLE)
        settling = _settling(standing, period)
        support[settling] = SUPPORTS.index(TRANSITION)
        contacts[foot] = (
            FootContact(support, np.zeros(len(standing), dtype=np.int8))
            .without(~standing, Reason.IN_THE_AIR)
            .without(np.isnan(force[foot]), Reason.NOT_RECORDED)
            .without(settling, Reason.SETTLING)
        )
    return contacts


def shaken(force: Array, weight: float, period: float) -> Mask:
    """Samples in which a foot's force (N, 3) [N] is shaken by impacts; `weight` [N] is the robot's.

    There the recorded values are aliases: of force and torque, of the accelerometer, of rates. SETTLING_TIME after an
    impact counts to it, as after a landing.
    """
    quick = quick_part(force, period)
    reach = max(1, round(SHAKING_TIME / 2 / period))
    size = np.sqrt(_means_around(np.sum(quick**2, axis=1), reach))
    struck = np.asarray(size > max(SHAKING_SHARE * weight, SHAKING_NOISE * float(np.percentile(size, 10))))
    return widened(struck, reach, round(SETTLING_TIME / period))


def quick_part(values: Array, period: float) -> Array:
    """What of a force's or an acceleration's components (N, k) is quicker than SHAKING_BAND; 0 where unknown."""
    return np.nan_to_num(values - low_pass(values, period, min(SHAKING_BAND, 0.2 / period)))


def hoisted(load: Array, weight: float, period: float) -> Mask:
    """Samples in which a rope or a hand carries a part of the robot for seconds, or lets go of it: its feet carry
    together another `load` (N,) [N] than as a rule, by a share of its `weight` [N]."""
    reach = max(1, round(HOISTING / 2 / period))
    slow = _means_around(_means_around(load, reach), reach)
    known = slow[np.isfinite(slow)]
    apart = np.abs(slow - (np.median(known) if known.size else 0.0)) > HOISTED_SHARE * weight
    held = widened(np.asarray(apart), round(HOISTED_AROUND / period))
    # At a log's ends a mean is one of few samples: a single step.
    for run in runs(held):
        held[run] = (run.stop - run.start) * period >= HOISTING + 2 * HOISTED_AROUND
    return held


def hoisted_note(log: str, time: Array, held: Mask, then: str) -> Note:
    """What is said of `hoisted` samples at `time` (N,) [s], and what is done `then`."""
    lasts = (time[-1] - time[0]) * held.mean()
    text = (
        f"{log}: for {lasts:.3g} s, first at t = {clock(time[int(held.argmax())])} s, the feet carry over "
        f"{100 * HOISTED_SHARE:.0f} % of the weight less or more than as a rule, as where a rope or a hand holds the "
        f"robot for a while or force sensors have unlike gains: {then}"
    )
    return Note("held_for_a_while", "info", text)


def _means_around(values: Array, reach: int) -> Array:
    """Mean (N,) of the values (N,) that are known up to `reach` samples before and behind each; NaN where none is."""
    known, place = np.isfinite(values), np.arange(len(values))
    last, first = np.minimum(place + reach + 1, len(values)), np.maximum(place - reach, 0)
    total, count = (
        np.concatenate([[0.0], np.cumsum(each)]) for each in (np.where(known, values, 0.0), known)
    )
    number = count[last] - count[first]
    return np.asarray(np.where(number > 0, total[last] - total[first], np.nan) / np.maximum(number, 1))


def widened(samples: Mask, before: int, behind: int | None = None) -> Mask:
    """Each true segment made longer by `before` samples in front and `behind` (as many where None) at its end."""
    wide, behind = samples.copy(), before if behind is None else behind
    for run in runs(samples):
        wide[max(0, run.start - before) : run.stop + behind] = True
    return wide


def joined(samples: Mask, reach: int) -> Mask:
    """True segments that are `reach` samples apart or less made one."""
    whole = samples.copy()
    for gap in runs(~samples):
        if gap.start and gap.stop < len(samples) and gap.stop - gap.start <= reach:
            whole[gap] = True
    return whole


def carried_weight(force: Mapping[str, Array]) -> float:
    """What the feet carry together, as a rule [N]: the median of the sum of the vertical forces."""
    total = np.sum(list(force.values()), axis=0)
    finite = total[np.isfinite(total)]
    return float(np.median(finite)) if finite.size else 0.0


def _standing(force: Array, weight: float, period: float) -> Mask:
    """Hysteresis on the vertical force, through which NaN keeps the state, and before the first value has that one's;
    contacts shorter than a stance are air."""
    loaded, lifted = force > LANDING_SHARE * weight, force <= LIFTING_SHARE * weight
    decided = loaded | lifted
    last = np.maximum.accumulate(np.where(decided, np.arange(len(force)), -1))
    begun = np.isnan(force) & loaded[np.argmax(decided)]
    standing = np.where(last >= 0, loaded[np.maximum(last, 0)], begun)
    for run in runs(standing):
        if (run.stop - run.start) * period < SHORTEST_STANCE:
            standing[run] = False
    return np.asarray(standing)


def _settling(standing: Mask, period: float) -> Mask:
    """The first and last samples of every stance that lands or lifts within the log."""
    near = np.zeros(len(standing), dtype=bool)
    for run in runs(standing):
        reach = round(min(SETTLING_TIME / period, SETTLING_SHARE * (run.stop - run.start)))
        if run.start > 0:
            near[run.start : run.start + reach] = True
        if run.stop < len(standing):
            near[run.stop - reach : run.stop] = True
    return near
