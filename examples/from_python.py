"""Feet from logs in Python: identify, look at the numbers that can be trusted, hand them on.

python examples/from_python.py ROBOT.yaml LOG... [--validate LOG...]
"""

from __future__ import annotations

import argparse
from pathlib import Path

import plantar


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("robot", type=Path)
    parser.add_argument("logs", type=Path, nargs="+")
    parser.add_argument("--validate", type=Path, nargs="+", default=[])
    chosen = parser.parse_args()

    robot = plantar.load_robot(chosen.robot)
    logs = [plantar.open_log(path, robot) for path in chosen.logs]
    unseen = [plantar.open_log(path, robot) for path in chosen.validate]
    result = plantar.identify_feet(robot, logs, unseen)

    for row in result.parameters:
        if row.verdict == "unidentifiable" or row.value is None or row.interval95 is None:
            print(f"{row.foot} {row.axis} {row.name}: not from these logs, {row.reason}")
            continue
        name, (low, high) = f"{row.foot} {row.axis} {row.name}", row.interval95
        print(f"{name}: {row.value:.4g} {row.unit}, 95 % in {low:.4g} to {high:.4g} ({row.verdict})")
    for score in result.validation:
        if score.kind == "cross":
            alone = f"{score.zero_mean_abs:.3f} by its offset alone"
            print(
                f"{score.motion}, {score.foot} {score.axis}: mean error {score.mean_abs_error:.3f} N·m, {alone}"
            )


if __name__ == "__main__":
    main()
