"""Empty figures that no global state knows, in the style of the paper's figures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, Literal

from plantar.errors import needs

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

STYLE: Final = {
    "font.size": 9,
    "axes.grid": True,
    "grid.color": "#e4e8ec",
    "axes.spines.top": False,
    "axes.spines.right": False,
}


def panels(
    rows: int, columns: int, size: tuple[float, float], share_x: bool | Literal["col"] = False
) -> tuple[Drawing, Any]:
    """A figure of `size` [inches] with (rows, columns) panels. Raises MissingExtra without matplotlib."""
    with needs("matplotlib", "figures", "drawing figures"):
        import matplotlib
        from matplotlib.figure import Figure as Drawing
    with matplotlib.rc_context(STYLE):
        drawing = Drawing(figsize=size, layout="constrained")
        grid = drawing.subplots(rows, columns, squeeze=False, sharex=share_x)
    return drawing, grid
