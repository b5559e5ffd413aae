"""What a feet result says in text: the table to paste into a mail, then reasons, prediction and warnings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import degrees

from plantar.conventions import NORMAL95
from plantar.results.feet_rows import Assumption, DelayEstimate, Parameter, ValidationRow
from plantar.results.numbers import MISSING, number, percent, unit, with_uncertainty

HEADS = ("foot", "axis", "parameter", "value", "unit", "±", "verdict")
PREDICTION_HEADS = ("motions", "foot", "axis", "mean |error|", "offset alone", "")
ASSUMPTION_HEADS = ("uncertainty", "std", "of", "found, ± for 95 %", "K by it alone", "C by it alone")
# How the keys of `uncertainty` are printed: factor and unit.
PRINTED_IN = {
    "wrench_gain": (100.0, "%"),
    "wrench_crosstalk": (1e3, "mm"),
    "wrench_delay": (1e3, "ms"),
    "bush_position": (1e3, "mm"),
    "encoder_zero": (degrees(1), "deg"),
    "joint_compliance": (1e3, "mrad/N·m"),
    "imu_mount": (degrees(1), "deg"),
    "link_mass": (100.0, "%"),
    "total_mass": (100.0, "%"),
    "link_com": (1e3, "mm"),
    "between_recordings": (100.0, "%"),
}
# Where the logs show no number of its own.
NOT_FOUND = {
    "wrench_crosstalk": "like a bush that is elsewhere: counted in bush_position",
    "encoder_zero": "taken up by the offset of each recording",
    "link_mass": "in how well wrench_delay is known",
    "link_com": "in how well wrench_delay is known",
    "total_mass": "not from the feet's forces, which it calibrates",
    "between_recordings": "none: recordings are alike as far as they show",
}
SYMBOLS = {"stiffness": "K", "damping": "C"}
KINDS = {"direct": "fitted", "cross": "unseen"}


def parameter_cells(rows: Sequence[Parameter]) -> list[tuple[str, ...]]:
    """Table 1: value ± half width of the 95 % interval, unit, the half width in percent, verdict."""
    values = [with_uncertainty(row.value, row.half_width) for row in rows]
    room = max((len(value.split(" ± ")[0]) for value in values), default=0)
    return [
        (
            row.foot,
            row.axis,
            _term(row),
            " " * (room - len(value.split(" ± ")[0])) + value,  # decimal places under each other
            unit(row.unit),
            percent(row.half_width_percent),
            row.verdict,
        )
        for row, value in zip(rows, values, strict=True)
    ]


def weak_lines(rows: Sequence[Parameter]) -> list[str]:
    """Why each number that is not usable is not, and what to record next; those with the same text stand together."""
    why: dict[tuple[str, str], list[str]] = {}
    todo: dict[str, list[str]] = {}
    for row in rows:
        if row.verdict != "usable":
            name = f"{row.foot} {row.axis} {_term(row)}"
            why.setdefault((row.verdict, row.reason), []).append(name)
            if row.advice:
                todo.setdefault(row.advice, []).append(name)
    lines = [f"  {', '.join(names)} ({verdict}): {reason}" for (verdict, reason), names in why.items()]
    advice = [f"  for {', '.join(names)}: {text}" for text, names in todo.items()]
    return [
        *(["Not usable as they are", *lines] if lines else []),
        *(["What to record next", *advice] if advice else []),
    ]


def _term(row: Parameter) -> str:
    return row.name.replace("_", " ")


def title_of_axis(rows: Sequence[Parameter], foot: str, axis: str) -> str:
    """One axis in a line, such as `left pitch: K = 434.0 ± 0.3 N·m/rad (usable), C = ...`."""
    terms = [
        f"{SYMBOLS[row.name]} = {with_uncertainty(row.value, row.half_width)} "
        f"{unit(row.unit)} ({row.verdict})"
        for row in rows
        if (row.foot, row.axis) == (foot, axis) and row.name in SYMBOLS
    ]
    return f"{foot} {axis}: {', '.join(terms)}"


def prediction_cells(rows: Sequence[ValidationRow]) -> list[tuple[str, ...]]:
    """Tables 2 and 3 in short: the mean error of each foot and axis over all samples, beside the offset alone's."""
    return [
        (
            f"{count} {KINDS[row.kind]}",
            row.foot,
            row.axis,
            number(row.mean_abs_error, 3),
            number(row.zero_mean_abs, 3),
            f"no better than the offset alone: {', '.join(lost)}" if lost else "",
        )
        for row, count, lost in over_all_motions(rows)
    ]


def over_all_motions(rows: Sequence[ValidationRow]) -> list[tuple[ValidationRow, int, list[str]]]:
    """One row for each kind, foot and axis, over all samples; of how many motions; those that the offset alone predicts
    as well."""
    groups: dict[tuple[str, str, str], list[ValidationRow]] = {}
    for row in rows:
        groups.setdefault((row.kind, row.foot, row.axis), []).append(row)
    merged = []
    for group in groups.values():
        samples = [row.samples for row in group]
        mean, square, alone = (
            sum(value * count for value, count in zip(values, samples, strict=True)) / max(sum(samples), 1)
            for values in (
                [row.mean_abs_error for row in group],
                [row.rms_error**2 for row in group],
                [row.zero_mean_abs for row in group],
            )
        )
        largest = max(row.max_abs for row in group)
        share = 100 * mean / largest if largest > 0 else None
        row = replace(
            group[0], motion="all", mean_abs_error=mean, rms_error=square**0.5, max_abs=largest,
            percent_of_max=share, zero_mean_abs=alone, samples=sum(samples),
        )  # fmt: skip
        merged.append((row, len(group), [row.motion for row in group if not row.has_skill]))
    return merged


def delay_line(delay: DelayEstimate | None) -> list[str]:
    """How late the force sensors were taken to be."""
    if delay is None:
        return []
    late = with_uncertainty(1e3 * delay.wrench_delay, 1e3 * NORMAL95 * delay.std if delay.std > 0 else None)
    known = "measured" if delay.measured else "as given" if delay.std == 0 else "not measured from these logs"
    return [f"Force sensors {late} ms late, {known}"]


def assumption_cells(rows: Sequence[Assumption]) -> list[tuple[str, ...]]:
    """What the robot file allows for, what the logs show of it, and how wide it makes K and C; none where nothing may
    be wrong and nothing is."""
    cells, last = [], ""
    for row in rows:
        if not (row.assumed or row.found or row.stiffness_percent or row.damping_percent):
            continue
        factor, shown = PRINTED_IN.get(row.name, (1.0, ""))
        found = NOT_FOUND.get(row.name, "not in these logs")
        assumed = f"{number(factor * row.assumed, 2)} {shown}".strip()
        if row.found is not None:
            value = factor * row.found
            half = None if row.std is None else factor * NORMAL95 * row.std
            text = number(value, 2) if half is None else with_uncertainty(value, half)
            found = f"{text} {shown}".strip()
        both = row.stiffness_percent, row.damping_percent
        widths = [f"± {percent(width)}" if width else MISSING for width in both]
        new = row.name != last
        cells.append(
            (row.name, assumed, row.what, found, *widths) if new else ("", "", row.what, found, "", "")
        )
        last = row.name
    return cells
