"""The campaign's tables, the same for the report and the terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from plantar.campaign.choice import choice_table
from plantar.campaign.compared import CrossBeside, DirectBeside, ParameterBeside
from plantar.campaign.replay import IDENTIFIED, RIGID, ReplayRow, scores
from plantar.campaign.run import Campaign
from plantar.conventions import ROTATIONAL_AXES
from plantar.report.content import Cell, Column, Mark, Table
from plantar.report.verdict import symbol
from plantar.results.numbers import MISSING, number, percent, unit, with_uncertainty

GOOD: Final = {"stiffness": 1.0, "damping": 3.0}  # percent of the truth
PAPER: Final = "paper's robot"
PAPER_WAY: Final = "paper's way"
FALLS: Final = "falls"


def tables(campaign: Campaign) -> tuple[Table, ...]:
    """Tables 1, 2 and 3 beside the paper's and the truth, the choice of motions, then the simulator's where motions
    were replayed."""
    made = [table_1(campaign.parameters), table_2(campaign.direct), table_3(campaign.cross)]
    made.append(choice_table(campaign.selection))
    if campaign.replayed:
        made.append(simulator_table(campaign.replayed))
    return tuple(made)


def table_1(rows: Sequence[ParameterBeside]) -> Table:
    """Identified parameters, their true errors, and the errors of the paper's way on the same logs."""
    lines = []
    for row in rows:
        half = None if row.interval95 is None else (row.interval95[1] - row.interval95[0]) / 2
        published = MISSING
        if row.published is not None:
            published = f"{number(row.published)} ({percent(row.published_relative_std_percent)})"
        lines.append(
            (
                row.foot, row.axis, f"{symbol(row.name)} [{unit(row.unit)}]", with_uncertainty(row.value, half),
                number(row.truth), _error(row.error_percent, GOOD.get(row.name)), _covered(row.covered),
                number(row.paper_way), _error(row.paper_way_error_percent, GOOD.get(row.name)),
                percent(row.paper_way_relative_std_percent), published,
            )
        )  # fmt: skip
    columns = Column.words("foot", "axis", "parameter")
    columns += [Column("identified"), Column("truth"), Column("error"), Column("inside", numeric=False)]
    columns += [Column(PAPER_WAY), Column("error"), Column("claimed std"), Column(PAPER)]
    remark = (
        "The twin's stiffness and damping are what the paper identified on its robot. Inside: whether the 95 % "
        "interval holds the truth. The paper's way on the same logs: one offset for the composed motion, a spring and "
        "a damper, no delay; the deviation that it claims is no measure of its error."
    )
    return Table.of("Table 1 beside the truth and the paper", columns, lines, remark=remark)


def table_2(rows: Sequence[DirectBeside]) -> Table:
    """Direct validation over the composed motion."""
    lines = [
        (row.axis, row.foot, number(row.mean_abs_error, 3), number(row.max_abs, 3),
         Cell(percent(row.percent_of_max), _mark(row.percent_of_max, 5.0)), number(row.paper_way, 3),
         percent(row.paper_way_percent_of_max), number(row.published, 3), percent(row.published_percent_of_max))
        for row in sorted(rows, key=lambda row: row.axis)
    ]  # fmt: skip
    columns = Column.words("axis", "foot")
    columns += [Column("mean |error|", "N·m"), Column("largest |torque|", "N·m"), Column("of largest")]
    columns += [Column(PAPER_WAY, "N·m"), Column("of largest"), Column(PAPER, "N·m"), Column("of largest")]
    return Table.of("Table 2 beside the paper: direct validation of the composed motion", columns, lines)


def table_3(rows: Sequence[CrossBeside]) -> Table:
    """Cross-validation: each cell as the default finds it, in the paper's way, and as the paper published it."""
    found = {(row.motion, row.foot, row.axis): row for row in rows}
    lines = []
    for motion, foot in dict.fromkeys((row.motion, row.foot) for row in rows):
        cells: list[Cell | str] = [motion, foot]
        for axis in ROTATIONAL_AXES:
            row = found.get((motion, foot, axis))
            cells += (
                [_cell(row), number(row.paper_way, 3), number(row.published, 3)] if row else [MISSING] * 3
            )
        lines.append(cells)
    columns = Column.words("motion", "foot")
    for axis in ROTATIONAL_AXES:
        columns += [Column(axis, "N·m"), Column(PAPER_WAY, "N·m"), Column(PAPER, "N·m")]
    remark = "Mean |error| of the torque on motions that the fit has not seen; a dash: the paper has none."
    return Table.of("Table 3 beside the paper: cross-validation", columns, lines, remark=remark)


def simulator_table(rows: Sequence[ReplayRow]) -> Table:
    """All replayed motions together, one line for each kind of feet."""
    lines = []
    found = {score.feet: score for score in scores(rows)}
    rigid = found.get(RIGID)
    for name, score in found.items():
        mark: Mark = "good" if name == IDENTIFIED else ""
        cells: list[Cell | str] = [Cell(name, mark)]
        for axis in (*ROTATIONAL_AXES, "both"):
            error, stiff = getattr(score, axis), getattr(rigid, axis) if rigid else None
            cells += [_milli(error), _share(error, stiff)]
        for axis in ROTATIONAL_AXES:
            mine = [row.error for row in rows if row.feet == name and row.quantity.endswith(f"{axis} torque")]
            known = [error for error in mine if error is not None]
            whole = len(known) == len(mine)
            cells.append((number(float(np.mean(known)), 3) if whole else FALLS) if mine else MISSING)
        lines.append(cells)
    columns = Column.words("feet")
    for what in ("chest pitch", "chest roll", "both"):
        columns += [Column(what, "mrad"), Column("of rigid")]
    columns += [Column(f"{axis} torque", "N·m") for axis in ROTATIONAL_AXES]
    motions = ", ".join(dict.fromkeys(row.motion for row in rows))
    remark = (
        f"{motions}, played again on a fresh twin by the recorded joints alone and compared with the record. Chest: "
        "root mean square of simulated minus recorded attitude. The bias and slow drift of an IMU's attitude turn its "
        "world by a straight line in time and are not the feet's: the turn nearest to the record is taken out, for "
        "every kind of feet alike. Torques: mean |error| after the first second, from which their zeros come. "
        f"'{FALLS}': that robot did not stay upright. The last line is how far the record itself is from the truth, by "
        "the same measure."
    )
    return Table.of("In a simulator: identified, rigid and guessed feet", columns, lines, remark=remark)


def replay_table(rows: Sequence[ReplayRow]) -> Table:
    """Every replayed motion: one line for each motion and kind of feet."""
    quantities = list(dict.fromkeys((row.quantity, row.unit) for row in rows))
    found = {(row.motion, row.feet, row.quantity): row.error for row in rows}
    lines = []
    for motion, feet in dict.fromkeys((row.motion, row.feet) for row in rows):
        cells = [motion, feet]
        for quantity, name in quantities:
            error = found.get((motion, feet, quantity))
            text = FALLS if (motion, feet, quantity) in found else MISSING
            cells.append(text if error is None else number((1e3 if name == "rad" else 1.0) * error, 3))
        lines.append(cells)
    lines.sort(key=lambda line: [row.motion for row in rows].index(line[0]))
    columns = Column.words("motion", "feet")
    columns += [Column(quantity, "mrad" if name == "rad" else "N·m") for quantity, name in quantities]
    return Table.of("In a simulator, motion by motion", columns, lines, folded=True)


def _cell(row: CrossBeside) -> Cell:
    better = row.published is None or row.mean_abs_error <= row.published / 2
    mark: Mark = "" if row.published is None else "good" if better else "weak"
    return Cell(number(row.mean_abs_error, 3), mark, f"offset alone: {number(row.zero_mean_abs, 3)} N·m")


def _error(value: float | None, good: float | None) -> Cell:
    if value is None:
        return Cell(MISSING)
    return Cell(f"{value:+.2f} %".replace("-", "−"), _mark(abs(value), good))


def _mark(value: float, good: float | None) -> Mark:
    return "" if good is None else "good" if value <= good else "bad"


def _covered(covered: bool | None) -> str:
    return MISSING if covered is None else "yes" if covered else "no"


def _milli(error: float | None) -> str:
    return FALLS if error is None else number(1e3 * error, 3)


def _share(error: float | None, rigid: float | None) -> str:
    return MISSING if error is None or not rigid else f"{error / rigid:.3f}"
