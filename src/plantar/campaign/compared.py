"""Tables 1 to 3 beside the paper's numbers, the paper's own way on the same logs, and the twin's truth."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from plantar.campaign.paper import TABLE_1, TABLE_2, TABLE_3
from plantar.conventions import ROTATIONAL_AXES
from plantar.results.feet import FeetResult, ValidationRow
from plantar.results.feet_text import over_all_motions
from plantar.twin.bush import Bush, Feet


@dataclass(frozen=True)
class ParameterBeside:
    """A number of table 1: as identified, as the paper's way finds it on the same logs, as it truly is, and as
    the paper published it for its robot. Errors are in percent of the truth."""

    foot: str
    axis: str
    name: str
    unit: str
    value: float | None
    interval95: tuple[float, float] | None
    truth: float
    error_percent: float | None
    covered: bool | None
    paper_way: float | None
    paper_way_error_percent: float | None
    paper_way_relative_std_percent: float | None
    published: float | None
    published_relative_std_percent: float | None


@dataclass(frozen=True)
class DirectBeside:
    """A row of table 2, over the whole composed motion [N·m]; errors in percent of the largest torque."""

    foot: str
    axis: str
    mean_abs_error: float
    max_abs: float
    percent_of_max: float
    paper_way: float | None
    paper_way_percent_of_max: float | None
    published: float | None
    published_percent_of_max: float | None


@dataclass(frozen=True)
class CrossBeside:
    """A cell of table 3 [N·m]; `published` is None where the paper has no such motion."""

    motion: str
    foot: str
    axis: str
    mean_abs_error: float
    zero_mean_abs: float
    paper_way: float | None
    published: float | None


def parameters_beside(result: FeetResult, paper_way: FeetResult, truth: Feet) -> tuple[ParameterBeside, ...]:
    """Table 1: pitch and roll of every foot, all terms of the model that the twin has too."""
    theirs = {(row.foot, row.axis, row.name): row for row in paper_way.parameters}
    rows = []
    for row in result.parameters:
        key = (row.foot, row.axis, row.name)
        true = _true(truth[row.foot], row.axis, row.name)
        if row.axis not in ROTATIONAL_AXES or true is None:
            continue
        other, published, interval = theirs.get(key), TABLE_1.get(key), row.interval95
        their_value = other.value if other else None
        rows.append(
            ParameterBeside(
                *key,
                unit=row.unit,
                value=row.value,
                interval95=interval,
                truth=true,
                error_percent=_percent(row.value, true),
                covered=None if interval is None else interval[0] <= true <= interval[1],
                paper_way=their_value,
                paper_way_error_percent=_percent(their_value, true),
                paper_way_relative_std_percent=other.relative_std_percent if other else None,
                published=published.value if published else None,
                published_relative_std_percent=published.relative_std_percent if published else None,
            )
        )
    return tuple(rows)


def direct_beside(result: FeetResult, paper_way: FeetResult) -> tuple[DirectBeside, ...]:
    """Table 2: the fitted motions, one after the other."""
    theirs = _composed(paper_way.validation)
    rows = []
    for place, row in _composed(result.validation).items():
        other, published = theirs.get(place), TABLE_2.get(place)
        rows.append(
            DirectBeside(
                *place, row.mean_abs_error, row.max_abs, 100 * row.mean_abs_error / row.max_abs,
                other.mean_abs_error if other else None, other.percent_of_max if other else None,
                published.mean_abs_error if published else None, published.percent_of_max if published else None,
            )
        )  # fmt: skip
    return tuple(rows)


def cross_beside(result: FeetResult, paper_way: FeetResult) -> tuple[CrossBeside, ...]:
    """Table 3: every motion that the fit has not seen, those of the paper first."""
    unseen = [row for row in paper_way.validation if row.kind == "cross"]
    theirs = {(row.motion, row.foot, row.axis): row.mean_abs_error for row in unseen}
    rows = [
        CrossBeside(
            row.motion, row.foot, row.axis, row.mean_abs_error, row.zero_mean_abs,
            theirs.get((row.motion, row.foot, row.axis)),
            TABLE_3.get(row.motion, {}).get((row.foot, row.axis)),
        )
        for row in result.validation
        if row.kind == "cross"
    ]  # fmt: skip
    motions = list(dict.fromkeys((*TABLE_3, *(row.motion for row in rows))))
    return tuple(sorted(rows, key=lambda row: motions.index(row.motion)))


def _true(bush: Bush, axis: str, name: str) -> float | None:
    """What the twin was given under that name; None for what it does not have."""
    value = getattr(bush, f"{axis}_{name}", None)
    return None if value is None else float(value)


def _percent(value: float | None, truth: float) -> float | None:
    return None if value is None or truth == 0 else 100 * (value - truth) / truth


def _composed(rows: Iterable[ValidationRow]) -> dict[tuple[str, str], ValidationRow]:
    """Direct validation over the samples of all motions, by foot and axis."""
    merged = over_all_motions([row for row in rows if row.kind == "direct"])
    return {(row.foot, row.axis): row for row, _, _ in merged}
