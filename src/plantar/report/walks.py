"""The part of a report on feet that step: stances and walks, unseen walks, zeros of the sensors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from plantar.report.charts.chart import Chart
from plantar.report.charts.strips import STRIP_REMARK, strip_charts
from plantar.report.charts.unseen import unseen_charts
from plantar.report.charts.zeros import ZERO_REMARK, zero_charts
from plantar.results.feet import FeetResult
from plantar.results.residuals import Track


@dataclass(frozen=True)
class WalkSection:
    """Its charts; lists are empty where there is nothing to show."""

    strips: tuple[Chart, ...]
    unseen: tuple[Chart, ...]
    zeros: tuple[Chart, ...]
    strip_remark: str = STRIP_REMARK
    zero_remark: str = ZERO_REMARK


def walk_section(result: FeetResult, tracks: Sequence[Track]) -> WalkSection | None:
    """The section, None where no foot steps."""
    if not result.stances:
        return None
    feet = {row.foot for row in result.stances}
    read = [row for row in result.swing_zeros if row.foot in feet]
    return WalkSection(
        strips=tuple(strip_charts(result)),
        unseen=tuple(unseen_charts(result, tracks)),
        zeros=tuple(zero_charts(read)),
    )
