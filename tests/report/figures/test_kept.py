"""Figures as they are kept: every line's points and looks, every label, limit and legend of each panel."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kept_texts import assert_as_kept, described
from plantar.comparison.scenes import CONTACT
from plantar.online.estimates import FIELDS, Contact
from plantar.online.replay import Replay
from plantar.report.figures import plots
from plantar.report.figures.loop import plot_torque
from plantar.report.figures.paper import plates
from plantar.report.figures.replay import replay_picture
from plantar.report.figures.robot_drawing import Box, stances
from plantar.report.figures.simulation import replays, zmp_planned
from plantar.results.feet import FeetResult
from plantar.results.residuals import tracks_of
from plantar.twin.replay import Replayed
from report_samples import write_campaign

pytest.importorskip("matplotlib")
KEPT = Path(__file__).parent / "kept"
FOOT = np.array([[0.1, 0.05], [-0.1, 0.05], [-0.1, -0.05], [0.1, -0.05]])
POINTS = np.column_stack([0.05 * np.sin(np.arange(40.0)), 0.12 * np.cos(0.3 * np.arange(40.0))])


def drawn(figure: Any, name: str) -> Iterator[str]:
    """What is on a figure: its size and legends, then panel by panel."""
    legends = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    yield described(
        {
            "size": figure.get_size_inches(),
            "legends": legends,
            "where": [legend._outside_loc for legend in figure.legends],
            "title": figure.get_suptitle(),
        },
        name,
    )
    for place, panel in enumerate(figure.axes):
        legend = panel.get_legend()
        told: dict[str, Any] = {
            "words": [panel.get_title(), panel.get_xlabel(), panel.get_ylabel()],
            "texts": [text.get_text() for text in panel.texts],
            "limits": [*panel.get_xlim(), *panel.get_ylim()], "aspect": panel.get_aspect(),
            "legend": [] if legend is None else [text.get_text() for text in legend.get_texts()],
        }  # fmt: skip
        for number, line in enumerate(panel.lines):
            looks = [
                line.get_color(),
                line.get_linewidth(),
                line.get_linestyle(),
                line.get_alpha(),
                line.get_zorder(),
            ]
            told[f"line {number}"] = [np.asarray(values, float) for values in line.get_data()], looks
        for number, patch in enumerate(panel.patches):
            told[f"patch {number}"] = patch.get_path().vertices, patch.get_facecolor()
        for number, band in enumerate(panel.collections):
            told[f"band {number}"] = [path.vertices for path in band.get_paths()], band.get_facecolor()
        yield described(told, f"{name} {place}")


def replayed() -> Replay:
    time = np.linspace(0.0, 10.0, 101)
    rows = np.sin(time[:, None, None] * (1 + 0.1 * np.arange(len(FIELDS)))) + np.array([2.0, 3.0])[:, None]
    rows[:, :, FIELDS.index("contact")] = Contact.STANCE
    rows[40:60, 1, FIELDS.index("contact")] = Contact.AIR
    rows[:, :, FIELDS.index("flags")] = 0
    return Replay(time, ("left", "right"), rows, np.ones(101))


def simulated() -> list[Replayed]:
    time = np.linspace(0.0, 1.0, 50)
    chest = 0.01 * np.column_stack([np.sin(5 * time), np.cos(4 * time)])
    torque = {("left", "pitch"): 3 * time, ("right", "roll"): 1 - time}
    other = {key: 1.1 * values for key, values in torque.items()}
    return [
        Replayed(motion, feet, time, torque, other, chest, (1 + 0.1 * place) * chest)
        for motion in ("Squat", "Tilt5") for place, feet in enumerate(("rigid", CONTACT))
    ]  # fmt: skip


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> FeetResult:
    folder = tmp_path_factory.mktemp("campaign")
    write_campaign(folder, seconds=4.0, rate=50.0)
    return FeetResult.load(folder)


def test_figures_are_as_they_are_kept(result: FeetResult) -> None:
    assert result.residuals is not None
    made = {
        plate.name: (plate.title, plate.number, plate.drawing)
        for plate in plates(tracks_of(result.residuals))
    }
    text = ""
    for name, (title, number, drawing) in list(made.items())[:7]:
        text += f"{title} {number}\n" + "".join(drawn(drawing, name))
    corners = np.array([[x, y, z] for x in (0, 0.2) for y in (0, 0.1) for z in (0, 0.3)])
    boxes = [Box(corners + shift, side) for shift, side in ((0.0, ""), (0.3, "left"), (-0.2, "right"))]
    others = {
        "loop": plot_torque(result, "left", "pitch").figure, "replay": replay_picture(replayed()),
        "simulated": replays(simulated(), CONTACT),
        "zmp": plots.zmp(POINTS, {"left": FOOT + [0, 0.1], "right": FOOT}, FOOT),
        "planned": zmp_planned(POINTS, 1.1 * POINTS, {"left": FOOT}, FOOT),
        "stances": stances([("one", boxes), ("two", boxes[:1])]),
    }  # fmt: skip
    text += "".join("".join(drawn(figure, name)) for name, figure in others.items())
    assert_as_kept(text, KEPT / "figures.txt", share=1e-4, least=1e-6)
