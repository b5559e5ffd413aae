"""The report of a feet identification: the verdict first, then tables, then every sample to look at."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from plantar.files import write_text
from plantar.notes import kinds
from plantar.pages import on_feet
from plantar.report import tables
from plantar.report.charts.chart import Chart
from plantar.report.charts.loop import loop_charts
from plantar.report.charts.strips import STRIP_REMARK, strip_charts
from plantar.report.charts.unseen import unseen_charts
from plantar.report.charts.zeros import ZERO_REMARK, zero_charts
from plantar.report.content import Figure, Section, Table
from plantar.report.motions import motion_views
from plantar.report.page import get_ready, render
from plantar.report.verdict import foot_verdicts, limits, reach, trust
from plantar.results.feet import FeetResult
from plantar.results.io import result_path
from plantar.results.residuals import FILE_NAMES, Track, read_residuals, residuals_path, tracks_of

TEMPLATES: Final = ("feet.html.j2", "base.html.j2", "macros.html.j2", "charts.html.j2", "motions.html.j2")


def get_report_ready() -> None:
    """What a report costs before there is a result: to be called while nothing else is to be done."""
    get_ready(*TEMPLATES)


def write_feet_report(
    result: str | os.PathLike[str],
    out: str | os.PathLike[str] | None = None,
    *,
    figures: Sequence[Figure] = (),
    sections: Sequence[Section] = (),
) -> Path:
    """Write `report.html` beside a `result.json` (or to `out`) and return its path.

    `result` is the file or its directory. The residuals beside it (`residuals.parquet`, `.csv` or `.csv.gz`) give the
    plots; without them the page has none and says so.
    `sections` come after the tables, `figures` after the plots. The page is one file that needs no network. Raises
    `PlantarError` for a result or residuals that cannot be read.
    """
    path = result_path(result)
    content = FeetResult.load(path, residuals=False)
    residuals = residuals_path(path.parent)
    tracks = read_residuals(residuals) if residuals is not None else ()
    page = _page(content, residuals, tracks, figures, sections)
    target = Path(out) if out is not None else path.parent / "report.html"
    write_text(target, page)
    return target


def feet_page(result: FeetResult) -> str:
    """The report of a result that is still in memory, as `write_feet_report` writes it once it is saved."""
    if result.residuals is None:
        return _page(result, None, ())
    return _page(result, Path(FILE_NAMES[0]), tracks_of(result.residuals))


def _page(
    content: FeetResult,
    residuals: Path | None,
    tracks: Sequence[Track],
    figures: Sequence[Figure] = (),
    sections: Sequence[Section] = (),
) -> str:
    motions, stride = motion_views(content, tracks)
    return render(
        TEMPLATES[0],
        styles=["uPlot.min.css", "report.css"],
        scripts=["uPlot.iife.min.js", "payload.js", "colours.js", "plots.js", "planes.js", "report.js"],
        title=f"The feet of {content.robot}",
        result=content,
        verdicts=foot_verdicts(content.parameters),
        trust=trust(content),
        reach=reach(content),
        loops=loop_charts(content, tracks),
        limits=limits(content),
        read_on=on_feet(row.verdict for row in content.parameters),
        walks=walk_section(content, tracks),
        warnings=kinds(content.notes, "warning"),
        notes=kinds(content.notes, "info"),
        tables=_tables(content),
        sections=sections,
        motions=motions,
        soles=_soles(content),
        stride=stride,
        residuals=residuals,
        figures=figures,
        appendix=[tables.input_table(content.inputs), tables.settings_table(content.settings)],
    )


def _soles(result: FeetResult) -> dict[str, list[list[float]]]:
    """Each foot's sole outline, x forward and y left [mm], where the result knows it."""
    outlines = {name: [[1e3 * x, 1e3 * y] for x, y in outline] for name, outline in result.soles.items()}
    return {name: outline for name, outline in outlines.items() if np.isfinite(outline).all()}


def _tables(result: FeetResult) -> list[Table]:
    kinds = {row.kind for row in result.validation}
    made = [tables.parameter_table(result.parameters)]
    made += [
        tables.validation_table(result.validation, kind) for kind in ("direct", "cross") if kind in kinds
    ]
    made += tables.comparison_tables(result)
    made += [tables.assumption_table(result.assumptions)] if result.assumptions else []
    made += [tables.offset_table(result.offsets)] if result.offsets else []
    made += [tables.used_table(result.phases)] if result.phases else []
    made.append(tables.neighbour_table(result.parameters))
    return made


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
