"""Why a sample of a foot is left out of a fit."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Reason(Enum):
    """One reason; its value is what a user reads, with `{}` where a detail belongs."""

    IN_THE_AIR = "in the air: no load on this foot"
    NOT_RECORDED = "not recorded: NaN, a gap or a channel that stands still, in a column that this foot needs"
    SETTLING = "landing or lifting: just after or before a change of contact"
    IMPACT = (
        "impact: the force changes faster than the sampling rate can resolve, as when the sole hits the floor"
    )
    FILTER_EDGE = "filter's edge"
    WINDOW = "beyond the window of {}"
    TORQUE_SATURATION = "tipping: the torque stops growing, {}"
    ON_THE_EDGE = (
        "tipping: the centre of pressure is at the sole's edge and the foot turns further than its bush"
    )
    OUTSIDE_THE_SOLE = "tipping: the centre of pressure is outside the sole"
    NEAR_THE_EDGE = (
        "tipping: the centre of pressure is near the sole's edge, where leaning cannot be told from flat"
    )
    BESIDE_TIPPING = "filter's edge: beside a sole that tips"
    SOLES_APART = "slip: the soles move against each other"
    SOLE_TURNS = "slip: the sole turns on the floor"
    SOLE_SLIDES = "slip: the sole moves over the floor"
    OUTLIER = "outlier: the {} torque is far from its model for a short time"
    SET_ASIDE = "set aside for a first fit"


EDGES = frozenset({Reason.ON_THE_EDGE, Reason.OUTSIDE_THE_SOLE, Reason.NEAR_THE_EDGE})
TIPPING = EDGES | {Reason.TORQUE_SATURATION}


@dataclass(frozen=True)
class LeftOut:
    """A reason with its detail: an angle, an axis."""

    reason: Reason
    detail: str

    @property
    def text(self) -> str:
        """The sentence that a user reads."""
        return self.reason.value.format(self.detail)
