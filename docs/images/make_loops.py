"""Torque over angle of the bush models, swayed slowly and quickly: docs/images/loops.png.

python docs/images/make_loops.py
"""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np

from plantar.models import MODELS, BushMotion

HERE = Path(__file__).resolve().parent
STEP, REACH = 0.002, 0.025  # s, rad
PACES = {"0.1 Hz": ("#0063b1", 0.1), "1 Hz": ("#c8470a", 1.0)}
# Model, what it looks like, its parameters beside K and C in the order of its terms, its nonlinear parameters.
SHOWN = (
    ("kelvin_voigt", "a line, wider with pace", (), ()),
    ("hardening", "bends up at both ends", (6e5,), ()),
    ("coulomb", "steps where the rate turns", (4.0,), (0.002,)),
    ("elastoplastic", "open however slow, with corners", (5.0,), (0.01,)),
    ("bouc_wen", "open however slow, and round", (5.0,), (0.01, 1.0)),
    ("standard_linear_solid", "stiffer when quick", (250.0,), (0.4,)),
)
STIFFNESS, DAMPING = 480.0, 8.0  # N·m/rad, N·m·s/rad


def loop(
    name: str, extra: tuple[float, ...], shape: tuple[float, ...], pace: float
) -> tuple[np.ndarray, ...]:
    """Angle [mrad] and torque [N·m] of the last of three swings."""
    time = np.arange(0.0, 3 / pace, STEP)
    turn = 2 * np.pi * pace
    motion = BushMotion(REACH * np.sin(turn * time), REACH * turn * np.cos(turn * time), STEP)
    torque = MODELS[name].columns(motion, shape) @ [STIFFNESS, DAMPING, *extra]
    last = time >= 2 / pace - STEP
    return 1e3 * motion.deflection[last], torque[last]


def main() -> None:
    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False})
    figure, panels = plt.subplots(2, 3, figsize=(9, 5), sharex=True, sharey=True, layout="constrained")
    for panel, (name, said, extra, shape) in zip(panels.flat, SHOWN, strict=True):
        for label, (colour, pace) in PACES.items():
            panel.plot(*loop(name, extra, shape, pace), color=colour, label=label, linewidth=1.4)
        panel.set_title(f"{name}\n{said}", fontsize=9)
    for panel in panels[1]:
        panel.set_xlabel("angle [mrad]")
    for panel in panels[:, 0]:
        panel.set_ylabel("torque [N·m]")
    panels[0, 0].legend(frameon=False)
    figure.savefig(HERE / "loops.png", dpi=100, metadata={"Software": None})
    print(HERE / "loops.png")


if __name__ == "__main__":
    main()
