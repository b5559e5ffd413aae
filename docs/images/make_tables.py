"""Pictures from tables that benchmarks printed: delay.png, coverage.png, bush_models.png.

python docs/images/make_tables.py

delay.csv holds what `python benchmarks/delay.py --seeds 2 --delays -10 0 5 10 20` printed, coverage.csv what
`python benchmarks/worlds.py` did, with the options that the page names;
bush_models.csv what `python benchmarks/bush_models.py --seeds 20` did.
"""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np
from scipy.stats import beta

HERE = Path(__file__).resolve().parent
RED, BLUE, GREY = "#c8470a", "#0063b1", "#8a949d"
COLOURS = {"HRP-2-like": BLUE, "TALOS": RED}
PROMISED = 95.0  # %
LEAST = 0.01  # %: smaller errors are drawn here


def rows(name: str) -> list[dict[str, str]]:
    with (HERE / name).open(newline="") as file:
        return list(csv.DictReader(file))


def delay() -> Any:
    """Worst error of the damping over the delay that was put in: with a sweep, without one, not corrected."""
    figure, panels = plt.subplots(1, 2, figsize=(10, 3.4), sharey=True, layout="constrained")
    for panel, preset in zip(panels, ("sensors", "realistic"), strict=True):
        found = [row for row in rows("delay.csv") if row["preset"] == preset]

        def column(name: str, found: list[dict[str, str]] = found) -> np.ndarray:
            return np.array([float(row[name]) for row in found])

        late = column("put_in_ms")
        panel.plot(late, column("c_not_corrected_percent"), "s--", color=GREY, label="not corrected")
        for kind, colour in (("without", RED), ("with", BLUE)):
            panel.plot(late, column(f"c_{kind}_sweep_percent"), "o", color=colour, label=f"{kind} arm sweep")
            width = column(f"half_width_{kind}_sweep_percent")
            panel.plot(late, width, "_", color=colour, markersize=14, label=f"its half width, {kind} sweep")
        panel.set(title=f"preset {preset}", xlabel="delay put in [ms]", yscale="log", ylim=(0.1, 120))
    panels[0].set_ylabel("worst error of C [%]")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=5, frameon=False)
    return figure


def coverage() -> Any:
    """How many of the 95 % intervals hold the truth, with what chance alone leaves open (Clopper and Pearson) where all
    are taken as independent."""
    found = rows("coverage.csv")
    names = list(dict.fromkeys((row["kind"], row["number"]) for row in found))
    figure, panel = plt.subplots(figsize=(8, 3.6), layout="constrained")
    for shift, (robot, colour) in zip((-0.14, 0.14), COLOURS.items(), strict=True):
        own = [row for row in found if row["robot"] == robot]
        place = np.array([names.index((row["kind"], row["number"])) for row in own]) + shift
        count = np.array([int(row["of"]) for row in own])
        held = np.round(count * np.array([float(row["held_percent"]) for row in own]) / 100)
        low = np.nan_to_num(beta.ppf(0.025, held, count - held + 1))
        high = np.nan_to_num(beta.ppf(0.975, held + 1, count - held), nan=1.0)
        share = held / count
        reach = 100 * np.array([share - low, high - share])
        panel.errorbar(place, 100 * share, yerr=reach, fmt="o", color=colour, capsize=3, label=robot)
    panel.axhline(PROMISED, color="black", linewidth=0.8)
    labels = [kind.replace(" by ", "\nby ") if kind.startswith("K ") else number for kind, number in names]
    panel.set_xticks(range(len(names)), labels, fontsize=8)
    panel.set(ylabel="intervals that hold the truth [%]", ylim=(60, 101))
    panel.legend(frameon=False, loc="lower left")
    return figure


def bush_models() -> Any:
    """Errors of K and C by the model that was chosen and by spring and damper alone: median and largest of 20 seeds."""
    found = rows("bush_models.csv")[::-1]
    figure, panels = plt.subplots(1, 2, figsize=(10, 3.2), sharey=True, layout="constrained")
    for panel, number in zip(panels, "kc", strict=True):
        for way, colour, shift in (("", BLUE, 0.15), ("linear_", RED, -0.15)):
            ends = [row[f"{way}{number}_{size}_percent"] for row in found for size in ("median", "largest")]
            median, largest = np.array([max(float(end or "nan"), LEAST) for end in ends]).reshape(-1, 2).T
            place = np.arange(len(found)) + shift
            label = "spring and damper alone" if way else "the model chosen"
            panel.hlines(place, median, largest, color=colour, linewidth=2, alpha=0.5)
            panel.plot(median, place, "o", color=colour, label=label)
            panel.plot(largest, place, "|", color=colour, markersize=9)
        panel.set(xscale="log", xlabel=f"error of {number.upper()} [%]", xlim=(0.8 * LEAST, 400))
    panels[0].set_yticks(range(len(found)), [row["rubber"] for row in found])
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, frameon=False)
    return figure


def main() -> None:
    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False})
    for name, figure in (("delay", delay()), ("coverage", coverage()), ("bush_models", bush_models())):
        figure.savefig(HERE / f"{name}.png", dpi=100, metadata={"Software": None})
        print(HERE / f"{name}.png")


if __name__ == "__main__":
    main()
