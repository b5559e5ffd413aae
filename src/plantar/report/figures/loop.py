"""Torque over angle of one foot and axis: measured (red) and reconstructed (blue), as the paper colours them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from plantar.conventions import ROTATIONAL_AXES
from plantar.errors import DataError, needs
from plantar.report.figures.plots import BLUE, LINE, RED
from plantar.results.feet import FeetResult
from plantar.results.feet_text import title_of_axis
from plantar.results.residuals import Track, tracks_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def plot_torque(
    result: FeetResult, foot: str, axis: str, *, motions: str | Sequence[str] = (), axes: Axes | None = None
) -> Axes:
    """Draw the torque of one foot over its bush's angle: measured in red, what the model says in blue.

    Samples that were left out are not drawn. A loop says that energy is lost, a bend that the spring is not linear, and
    a difference between the colours what the model does not know.

    Args:
        result: with residuals, as from `identify_feet` or `FeetResult.load`.
        foot: the foot's name.
        axis: "pitch" or "roll".
        motions: names of motions, or one name; all that have samples where left out.
        axes: matplotlib axes to draw into; new ones where left out.

    Returns:
        The axes: angle [mrad] to the right, torque [N·m] up.

    Raises:
        DataError: no residuals, or no such foot, axis or motion. MissingExtra: matplotlib is not installed.

    Example:
        >>> import plantar
        >>> result = plantar.FeetResult.load("out/feet")
        >>> plantar.plot_torque(result, "left", "pitch", motions=["sway_1"]).get_xlabel()
        'left pitch [mrad]'
    """
    tracks = _chosen(result, foot, axis, (motions,) if isinstance(motions, str) else tuple(motions))
    panel = _new_axes() if axes is None else axes
    for place, track in enumerate(tracks):
        angle = np.where(track.used, 1e3 * track.values[f"{axis}.deflection"], np.nan)
        for what, colour, label in (("torque", RED, "measured"), ("predicted", BLUE, "model")):
            torque = track.values[f"{axis}.{what}"]
            panel.plot(angle, torque, color=colour, linewidth=LINE, label=label if place == 0 else None)
    panel.set_xlabel(f"{foot} {axis} [mrad]")
    panel.set_ylabel("torque [N·m]")
    panel.set_title(title_of_axis(result.parameters, foot, axis), fontsize="medium")
    panel.legend(frameon=False)
    return panel


def _chosen(result: FeetResult, foot: str, axis: str, motions: tuple[str, ...]) -> list[Track]:
    """The tracks to draw; DataError that names what there is where one is asked for that is not there."""
    if result.residuals is None:
        valid = "a result of identify_feet, or FeetResult.load of a folder with residuals.parquet"
        raise DataError("the result holds no residuals to draw", valid=valid)
    tracks = tracks_of(result.residuals)
    for what, asked, known in (
        ("foot", (foot,), [track.foot for track in tracks]),
        ("axis", (axis,), ROTATIONAL_AXES),
        ("motion", motions, [track.motion for track in tracks]),
    ):
        for name in asked:
            if name not in known:
                raise DataError(f"no {what} has that name", value=name, valid=", ".join(dict.fromkeys(known)))
    found = [track for track in tracks if track.foot == foot and (not motions or track.motion in motions)]
    drawn = [track for track in found if track.used.any()]
    if not drawn:
        raise DataError(f"no sample of the {foot} foot was used", valid="other motions")
    return drawn


def _new_axes() -> Axes:
    with needs("matplotlib", "figures", "drawing torque over angle"):
        from matplotlib import pyplot
    made: Axes = pyplot.subplots(layout="constrained")[1]
    return made
