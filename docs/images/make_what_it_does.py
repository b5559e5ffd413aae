"""The picture at the top of the README: what goes in, what is found, how near it is. From the twin, nothing typed in.

python docs/images/make_what_it_does.py [FOLDER]      # logs and result go to FOLDER, out/picture where left out
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import numpy as np

import plantar
from plantar.campaign.pictures import boxes, look_of
from plantar.cli import main as plantar_command
from plantar.contact.polygon import convex_hull
from plantar.report.figures.plots import BLUE, RED
from plantar.twin.play import planned

HERE = Path(__file__).resolve().parent
GREY, DARK = "#c9d1d8", "#3a444d"
LEAN = np.radians(7.0)  # of the drawn robot, some times what rubber gives, so that it can be seen
RUBBER = 0.075  # m, drawn thicker than it is
ONE_STEP = ("simulate", "Tilt3,Manual_right_pitch,Manual_left_roll,Myrand5,Squat", "--preset", "realistic")
AXES = [(foot, axis) for foot in ("right", "left") for axis in ("pitch", "roll")]


def call(*words: object) -> None:
    """One command; the script ends where it fails."""
    try:
        plantar_command([str(word) for word in words])
    except SystemExit as done:
        if done.code:
            raise


def identified(folder: Path) -> plantar.FeetResult:
    """The feet of the built-in robot, identified from logs that the twin records."""
    logs = folder / "logs"
    call(*ONE_STEP, "--out", logs, "--quiet")
    fitted = [logs / f"{name}.parquet" for name in ONE_STEP[1].split(",")[:-1]]
    unseen = ("--validate", logs / "Squat.parquet")
    call("identify", "feet", logs / "robot.yaml", *fitted, *unseen, "--out", folder / "feet", "--quiet")
    return plantar.FeetResult.load(folder / "feet")


def draw_robot(panel: Any, robot: plantar.RobotModel) -> None:
    """The robot from its left, leaning over its bushes; where the sensors are."""
    shapes = sorted(boxes(look_of(robot), planned("Tilt1", robot)), key=lambda box: box.corners[:, 1].mean())
    soles = min(box.corners[:, 2].min() for box in shapes)
    centre = np.array([0.0, soles + 0.02])
    turn = np.array([[np.cos(LEAN), np.sin(LEAN)], [-np.sin(LEAN), np.cos(LEAN)]])
    top = 0.0
    for box in shapes:
        outline = (convex_hull(box.corners[:, [0, 2]]) - centre) @ turn.T + centre
        outline[:, 1] += RUBBER
        top = max(top, outline[:, 1].max())
        panel.fill(
            *outline.T, facecolor="white" if box.side == "left" else GREY, edgecolor=DARK, linewidth=0.8
        )
    panel.fill([-0.11, 0.11, 0.11, -0.11], [soles, soles, soles + 0.018, soles + 0.018], color=DARK)
    for x in (-0.07, 0.07):  # springs between sole and ankle
        gap = RUBBER - x * np.tan(LEAN)
        z = soles + 0.018 + np.linspace(0, gap, 9)
        panel.plot(x + 0.018 * np.array([0, 0, 1, -1, 1, -1, 1, 0, 0]), z, color=RED, linewidth=1.8)
    panel.axhline(soles, color="black", linewidth=1.0)
    chest, knee, ankle = (np.array([x, z]) for x, z in ((0.11, 1.10), (0.08, 0.39), (0.02, 0.16)))
    for name, place, text in (
        ("one IMU", chest, (0.42, 1.2)), ("joint encoders", knee, (0.42, 0.62)),
        ("force sensors", ankle, (0.42, 0.27)),
    ):  # fmt: skip
        panel.plot(*place, "o", color=DARK, markersize=5)
        panel.annotate(name, place, text, fontsize=11, va="center", color=DARK,
                       arrowprops={"arrowstyle": "-", "color": DARK, "linewidth": 0.8})  # fmt: skip
    panel.annotate("rubber: K, C ?", (0.1, soles + 0.05), (0.42, 0.05), fontsize=11, va="center", color=RED,
                   fontweight="bold", arrowprops={"arrowstyle": "-", "color": RED, "linewidth": 0.8})  # fmt: skip
    panel.set(xlim=(-0.3, 1.02), ylim=(soles - 0.05, top + 0.05), aspect="equal")
    panel.axis("off")


def draw_numbers(panel: Any, result: plantar.FeetResult, truth: dict[str, dict[str, float]]) -> None:
    """Stiffness of each foot and axis with its interval, and what the simulated robot really has."""
    for place, (foot, axis) in enumerate(reversed(AXES)):
        row = result.parameter(foot, axis, "stiffness")
        assert row.value is not None
        assert row.half_width is not None
        true = truth[foot][f"{axis}_stiffness"]
        panel.plot([true, true], [place - 0.3, place + 0.3], color="black", linewidth=1.2,
                   label="truth" if place == 0 else None)  # fmt: skip
        panel.errorbar(row.value, place, xerr=row.half_width, fmt="o", color=BLUE, capsize=4, markersize=5,
                       label="identified, 95 % interval" if place == 0 else None)  # fmt: skip
        panel.text(row.value, place + 0.31, f"{row.value:.0f} ± {row.half_width:.0f}, {row.verdict}", fontsize=9,
                   ha="center", va="bottom", color=DARK)  # fmt: skip
    panel.set_yticks(range(len(AXES)), [f"{foot} {axis}" for foot, axis in reversed(AXES)])
    panel.set(
        xlabel="stiffness K [N·m/rad]",
        ylim=(-0.6, len(AXES) - 0.3),
        title="how far each number can be trusted",
    )
    panel.margins(x=0.15)
    panel.legend(frameon=False, fontsize=9, loc="lower center", bbox_to_anchor=(0.5, -0.34), ncols=2)


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/picture")
    result = identified(folder)
    robot = plantar.load_robot(folder / "logs" / "robot.yaml")
    truth = json.loads((folder / "logs" / "Tilt3.truth.json").read_text())["bushes"]
    plt.rcParams.update({"svg.fonttype": "path", "svg.hashsalt": "plantar", "font.size": 10,
                         "axes.spines.top": False, "axes.spines.right": False})  # fmt: skip
    figure, (left, middle, right) = plt.subplots(
        1, 3, figsize=(13, 4.2), width_ratios=(1.15, 1.2, 1.2), layout="constrained"
    )
    draw_robot(left, robot)
    left.set_title("what your robot records anyway")
    plantar.plot_torque(result, "right", "pitch", motions="Manual_right_pitch", axes=middle)
    middle.lines[0].set(linewidth=3.5, alpha=0.7)  # so that it is seen under the model
    middle.set_title("torque over angle of one foot, with its hysteresis")
    draw_numbers(right, result, truth)
    figure.savefig(HERE / "what_it_does.png", dpi=110, metadata={"Software": None})
    print(HERE / "what_it_does.png")


if __name__ == "__main__":
    main()
