"""The estimator of controllers against the batch fit, on recordings whose truth nobody knows.

    python benchmarks/online_against_batch.py ROBOT.yaml LOG...

The batch tool fits all logs together. The estimator begins anew with each log and goes on with the next one: after two
short logs, is its stiffness within the batch result's 95 % interval? With the cutoff that the batch fit chose.
"""

from __future__ import annotations

import sys
from pathlib import Path

from plantar.feet.identify import identify_feet
from plantar.logs.readers import open_log
from plantar.online.estimator import FootEstimator
from plantar.robot.model import load_robot


def main(robot_file: str, *paths: str) -> None:
    robot = load_robot(robot_file)
    logs = [open_log(path, robot) for path in paths]
    batch = identify_feet(robot, logs)
    rows = [row for row in batch.parameters if row.name == "stiffness" and row.axis != "z" and row.interval95]
    scored = inside = agree = alarms = 0
    for place, first in enumerate(logs):
        estimator = FootEstimator(robot, batch)
        estimator.replay(first)
        replay = estimator.replay(logs[(place + 1) % len(logs)])
        said = []
        for row in rows:
            found = getattr(replay.estimate(row.foot), row.axis).stiffness
            low, high = row.interval95
            scored += 1
            inside += low <= found.value <= high
            agree += found.value - found.half_width <= high and found.value + found.half_width >= low
            said.append(
                f"{row.foot} {row.axis} {found.value:.0f} ± {found.half_width:.0f} ({low:.0f} to {high:.0f})"
            )
        print(f"{first.name} and the next: {', '.join(said)}")
    estimator = FootEstimator(robot, batch)
    for log in logs:
        replay = estimator.replay(log)
        alarms += sum(bool((replay.column(foot, "flags").astype(int) & 1024).any()) for foot in replay.feet)
    seconds = sum(log.duration for log in logs)
    print(f"{inside} of {scored} within the batch intervals, {agree} of the intervals overlap them")
    print(f"{alarms} changes of ground told in {seconds:.0f} s")


if __name__ == "__main__":
    main(*(str(Path(word)) for word in sys.argv[1:]))
