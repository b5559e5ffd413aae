"""Do draws from a randomisation file move as the record did? A demo's unseen motions on drawn feet, with drawn sensors.

    plantar demo --out out/demo
    plantar export out/demo/result.json --to randomization --out ranges.yaml
    python benchmarks/randomised_replay.py out/demo ranges.yaml

Each draw has feet from the ranges and noise, biases and zeros of the demo's preset with a seed of its own, as an
episode in training would. At each sample the band from the lowest to the highest of n draws either holds the record or
does not. Of a record that is one more such draw it holds (n - 1) / (n + 1) on average: 95 % with 39 draws.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from plantar.logs.inputs import open_together
from plantar.motions.plan import Plan
from plantar.robot.model import RobotModel, load_robot
from plantar.twin.bush import Bush, Feet
from plantar.twin.play import play_all
from plantar.twin.replay import Record, moved_onto, pitch_and_roll, plan_of, record_of

SEEDS = 1000  # of the draws' sensors: the demo's own is another


def drawn_feet(ranges: dict[str, Any], count: int) -> list[Feet]:
    """By the lines of docs/how_to/randomisation.md."""
    mean, std = (np.array([row[key] for row in ranges["parameters"]]) for key in ("mean", "std"))
    random = np.random.default_rng(0)
    draws = mean + std * random.multivariate_normal(0 * mean, ranges["correlation"], count)
    draws = np.where([row.get("above") == 0 for row in ranges["parameters"]], np.maximum(draws, 0), draws)
    found = []
    for draw in draws:
        values: dict[str, dict[str, float]] = {}
        for row, value in zip(ranges["parameters"], draw, strict=True):
            foot, *rest = row["name"].split(".")
            if len(rest) == 2 and rest[1] != "offset":
                values.setdefault(foot, {})["_".join(rest)] = float(value)
        found.append({foot: Bush(**own) for foot, own in values.items()})
    return found


def curves(robot: RobotModel, plan: Plan, record: Record, onto: Record) -> dict[str, np.ndarray]:
    chest = pitch_and_roll(moved_onto(onto.attitude, record.attitude))
    named = {"chest pitch": chest[:, 0], "chest roll": chest[:, 1]}
    return named | {f"{foot} {axis} torque": values for (foot, axis), values in record.torque.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("demo", type=Path)
    parser.add_argument("ranges", type=Path)
    parser.add_argument("--draws", type=int, default=39)
    parser.add_argument("--preset", default="realistic")
    parser.add_argument("--motions", nargs="+", default=["Tilt5", "Myrand5"])
    chosen = parser.parse_args()
    robot = load_robot(chosen.demo / "logs" / "robot.yaml")
    feet = drawn_feet(yaml.safe_load(chosen.ranges.read_text()), chosen.draws)
    logs = open_together(
        [chosen.demo / "logs" / f"{motion}.parquet" for motion in chosen.motions], robot, None
    )
    expected = (chosen.draws - 1) / (chosen.draws + 1)
    print(f"the band of {chosen.draws} draws holds one more of them for {100 * expected:.1f} % of the time")
    for log in logs:
        plan = plan_of(robot, log)
        record = record_of(robot, log, plan)
        held: dict[str, list[np.ndarray]] = {}
        for place, one in enumerate(feet):
            recording = play_all([log.name], robot, one, chosen.preset, [SEEDS + place])[0][0]
            played = record_of(robot, recording.log, plan)
            for name, values in curves(robot, plan, played, record).items():
                held.setdefault(name, []).append(values)
        truth = curves(robot, plan, record, record)
        for name, values in held.items():
            low, high = np.min(values, axis=0), np.max(values, axis=0)
            covered = np.mean((truth[name] >= low) & (truth[name] <= high))
            print(
                f"{log.name:8} {name:20} {100 * covered:5.1f} % of the time, half width {np.mean(high - low) / 2:.3g}"
            )


if __name__ == "__main__":
    main()
