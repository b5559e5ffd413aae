"""A foot on its bush, at rest and bent, with the keys of the robot file and the symbols of the model: foot.png.

python docs/images/make_foot.py
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np

HERE = Path(__file__).resolve().parent
RED, BLUE, DARK, GREY = "#c8470a", "#0063b1", "#3a444d", "#c9d1d8"
ANKLE, BUSH, SOLE = 0.12, 0.04, 0.0  # heights over the floor [m]
HEEL, TOE = -0.10, 0.13  # of the sole [m]
LEAN = np.radians(8.0)


def turned(points: Any, angle: float) -> np.ndarray:
    """Points (n, 2) of x forward and z up, turned about the bush's centre as a pitch turns them."""
    centre = np.array([0.0, BUSH])
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    return (np.asarray(points) - centre) @ turn.T + centre


def draw(panel: Any, lean: float) -> None:
    """The foot from its left side; the ankle leans forwards by `lean` over a sole that stands flat."""
    panel.axhline(SOLE, color="black", linewidth=1)
    panel.fill([HEEL, TOE, TOE, HEEL], [SOLE, SOLE, 0.018, 0.018], color=DARK)
    panel.fill(*turned([[-0.05, 0.055], [0.06, 0.055], [0.03, ANKLE + 0.03], [-0.03, ANKLE + 0.03]], lean).T,
               facecolor=GREY, edgecolor=DARK)  # fmt: skip
    for x in (-0.035, 0.045):
        foot, head = np.array([x, 0.018]), turned([[x, 0.055]], lean)[0]
        way = np.linspace(0, 1, 9)[:, None] * (head - foot) + foot
        way[:, 0] += 0.008 * np.array([0, 0, 1, -1, 1, -1, 1, 0, 0])
        panel.plot(*way.T, color=RED, linewidth=1.6)
    panel.plot(*turned([[0, ANKLE]], lean)[0], "o", color="white", markeredgecolor=DARK, markersize=9)
    panel.plot(0, BUSH, "+", color=RED, markersize=12, markeredgewidth=2)
    panel.plot(*turned([[0, 0.075]], lean)[0], "s", color=BLUE, markersize=7)
    panel.set(xlim=(-0.21, 0.27), ylim=(-0.065, 0.215), aspect="equal")
    panel.axis("off")


def label(panel: Any, text: str, place: Any, at: tuple[float, float], colour: str = DARK) -> None:
    panel.annotate(text, place, at, color=colour, fontsize=9, va="center", ha="right" if at[0] < 0 else "left",
                   arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.8})  # fmt: skip


def main() -> None:
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.1))
    figure.subplots_adjust(left=0, right=1, bottom=0, top=0.93, wspace=0)
    draw(left, 0.0)
    left.set_title("keys of the robot file", fontsize=10)
    label(left, "ankle: last link\nabove the rubber", (0.0, ANKLE), (-0.07, 0.17))
    label(left, "wrench: where the sensor\nmeasures, as a driver says", (0.0, 0.075), (0.085, 0.125), BLUE)
    label(left, "bush: centre of what gives way", (0.0, BUSH), (0.085, 0.065), RED)
    label(left, "sole: plane and polygon", (HEEL + 0.01, 0.0), (-0.03, -0.035))
    for way, name in (((0.06, 0), "x"), ((0, 0.06), "z")):
        left.annotate("", (-0.18 + way[0], 0.03 + way[1]), (-0.18, 0.03), arrowprops={"arrowstyle": "->"})
        left.text(-0.18 + 1.2 * way[0], 0.03 + 1.2 * way[1], name, ha="center", va="center")
    draw(right, LEAN)
    right.set_title("the same, leaning forwards", fontsize=10)
    right.plot([0, 0], [BUSH, 0.2], ":", color=DARK, linewidth=1)
    right.plot(*np.array([[0, BUSH], turned([[0, 0.2]], LEAN)[0]]).T, "-.", color=DARK, linewidth=1)
    label(
        right,
        "deflection: sole against ankle,\nfrom IMU and encoders",
        turned([[0, 0.18]], LEAN / 2)[0],
        (-0.05, 0.18),
    )
    right.annotate(
        "", (0.05, 0.0), (0.05, -0.055), arrowprops={"arrowstyle": "-|>", "color": BLUE, "linewidth": 2}
    )
    label(right, "force of the floor", (0.05, -0.04), (0.085, -0.04), BLUE)
    label(right, "torque = K·deflection\n+ C·rate + offset", (0.0, BUSH), (0.085, 0.065), RED)
    figure.savefig(HERE / "foot.png", dpi=100, metadata={"Software": None})
    print(HERE / "foot.png")


if __name__ == "__main__":
    main()
