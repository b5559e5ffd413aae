"""The campaign on paper: figures as SVG and PDF, one report, one page with the robot in motion."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from plantar.campaign import pictures, tables
from plantar.campaign.run import Campaign
from plantar.campaign.scene import write_campaign_scene
from plantar.report import Section, write_feet_report
from plantar.report.figures import paper as paper_plates
from plantar.report.figures.plots import save
from plantar.results.residuals import read_residuals, residuals_path

STORY = (
    "A robot in MuJoCo stands on bushes whose stiffness and damping are the paper's table 1, and records what a "
    "robot's sensors would: encoders, one IMU, the force sensors over its feet, with noise, and with biases and zeros "
    "of their own in each recording. plantar read the recordings from their files and knew nothing else."
)


@dataclass(frozen=True)
class Written:
    """What was written."""

    report: Path
    scene: Path
    figures: tuple[Path, ...]


def write_campaign_report(campaign: Campaign, progress: Callable[[str], None]) -> Written:
    """Write `report.html`, `robot.html` and `figures/` beside the campaign's `result.json`."""
    directory = campaign.directory
    progress("draw the figures")
    source = residuals_path(directory)
    tracks = read_residuals(source) if source is not None else ()
    plates = [*pictures.plates(campaign), *paper_plates.plates(tracks, only_paper=True)]
    plates.sort(key=lambda plate: plate.number or 99)
    saved = []
    for plate in plates:
        progress(f"draw {plate.name}")
        saved += save(plate.drawing, directory / "figures", plate.name)
    progress("write the report")
    beside = Section("Beside the paper", (STORY,), tables.tables(campaign))
    details = [tables.replay_table(campaign.replayed)] if campaign.replayed else []
    simulator = Section(
        "In a simulator",
        (
            "The paper's future work: identified numbers go into a fresh simulation, which plays the unseen motions by "
            "the recorded joints alone. robot.html, beside this page, shows the robot move, its bushes bent further.",
        ),
        tuple(details),
        tuple(plate.picture() for plate in plates if plate.number is None),
    )
    report = write_feet_report(
        directory,
        figures=[plate.picture() for plate in plates if plate.number is not None],
        sections=[beside, simulator] if campaign.replayed else [beside],
    )
    progress("write the scene")
    scene = write_campaign_scene(campaign, directory / "robot.html")
    return Written(report, scene, tuple(saved))
