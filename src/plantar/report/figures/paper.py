"""The paper's figures 7 to 13 for any campaign, numbered where the paper has that motion."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from plantar.errors import DataError
from plantar.report.content import Figure
from plantar.report.figures import plots
from plantar.results.residuals import Track, read_residuals, residuals_path

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

ANGLES: Final = {"tilt3": 7, "manual_left_roll": 8}
CROSS: Final = {"tilt1": 10, "squat": 11, "myrand4": 12, "manual_both_pitch": 13}
DIRECT: Final = 9


@dataclass(frozen=True)
class Plate:
    """A drawing with its file name, title and caption; `number` is the paper's figure, None where it has none."""

    name: str
    number: int | None
    title: str
    caption: str
    drawing: Drawing

    def picture(self) -> Figure:
        """The plate for `write_feet_report(figures=...)`."""
        return plots.picture(self.drawing, self.title, self.caption)


def plates(tracks: Sequence[Track], only_paper: bool = False) -> list[Plate]:
    """Bush angles of each motion, direct validation of the composed motion, cross-validation of each unseen motion.

    Ordered by the paper's figure number, then those that the paper lacks; `only_paper` leaves these out.
    """
    made = sorted(_plates(tracks, only_paper), key=lambda plate: plate.number or 99)
    names: Counter[str] = Counter()
    return [replace(plate, name=_unique(plate.name, names)) for plate in made]


def write_figures(
    directory: Path, out: Path, formats: Sequence[plots.Format] = ("svg", "pdf"), only_paper: bool = False
) -> list[Path]:
    """Write each plate of the residuals in `directory` to `out` in each format; returns the paths.

    Raises `DataError` where there are no residuals, `MissingExtra` without matplotlib.
    """
    source = residuals_path(directory)
    if source is None:
        raise DataError("holds no residuals", path=directory, valid="the directory of a result.json")
    made = plates(read_residuals(source), only_paper)
    return [path for plate in made for path in plots.save(plate.drawing, out, plate.name, formats)]


def _plates(tracks: Sequence[Track], only_paper: bool) -> Iterator[Plate]:
    roles = {track.motion: track.role for track in tracks}
    for motion in roles:
        number = ANGLES.get(motion.casefold())
        if number is not None or not only_paper:
            title = _title(number, f"Bush angles in {motion}")
            drawing = plots.bush_angles(tracks, motion)
            yield Plate(
                _name(number, f"angles_{motion}"), number, title, "Right foot red, left foot blue.", drawing
            )
    colours = (
        "Sensor red, reconstructed blue; grey: left out, such as in the air or tipping over the sole's edge."
    )
    fitted = [motion for motion, role in roles.items() if role == "fit"]
    if fitted:
        title = _title(DIRECT, "Direct validation of the composed motion")
        caption = f"{colours} In order: {', '.join(fitted)}."
        yield Plate(_name(DIRECT, "direct"), DIRECT, title, caption, plots.torques(tracks, fitted))
    for motion, role in roles.items():
        number = CROSS.get(motion.casefold())
        if role == "validate" and (number is not None or not only_paper):
            title = _title(number, f"Cross-validation of {motion}")
            drawing = plots.torques(tracks, [motion])
            yield Plate(_name(number, f"cross_{motion}"), number, title, colours, drawing)


def _unique(name: str, names: Counter[str]) -> str:
    """Motions such as `a b` and `a/b` share a safe name; the second and later ones get a number."""
    key = name.casefold()
    names[key] += 1
    return name if names[key] == 1 else _unique(f"{name}-{names[key]}", names)


def _title(number: int | None, text: str) -> str:
    return f"{text}." if number is None else f"Figure {number}. {text}."


def _name(number: int | None, text: str) -> str:
    """A file name that is safe whatever a motion is called."""
    safe = re.sub(r"[^A-Za-z0-9_-]+", "-", text)[:80]
    return safe if number is None else f"figure{number:02d}_{safe}"
