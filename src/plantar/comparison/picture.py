"""The comparison as a picture: chest attitude and foot torques, recorded and simulated, a column a motion."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from plantar.comparison.scenes import CONTACT
from plantar.report.figures.plots import save
from plantar.report.figures.simulation import replays
from plantar.twin.replay import Replayed


def write_picture(folder: Path, found: Sequence[Replayed]) -> list[Path]:
    """Write `comparison.svg` to a folder; the paths. Raises MissingExtra without matplotlib."""
    return save(replays(found, CONTACT), folder, "comparison", ["svg"])
