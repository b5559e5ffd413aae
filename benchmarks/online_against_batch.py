"""The estimator of controllers against the batch fit, on recordings whose truth nobody knows.

    python benchmarks/online_against_batch.py ROBOT.yaml LOG...

The batch tool fits all logs together. The estimator begins anew with each log and goes on with the next ones: after one
log, two and so on, is its stiffness within the batch result's 95 % interval, and how far is it off, as a rule and from
beginning to beginning? With the cutoff that the batch fit chose. What can be expected of short logs, the batch fit of
each two says.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.online.estimates import Flag
from plantar.online.estimator import FootEstimator
from plantar.results.feet import FeetResult
from plantar.results.feet_rows import Parameter
from plantar.robot.model import RobotModel, load_robot


def main(robot_file: str, *paths: str) -> None:
    robot = load_robot(robot_file)
    logs = [open_log(path, robot) for path in paths]
    batch = identify_feet(robot, logs)
    rows = _stiffnesses(batch)
    names = [f"{row.foot} {row.axis}" for row in rows]
    low, high = np.array([row.interval95 for row in rows]).T
    middle = np.array([row.value for row in rows])
    found = np.array([_learnt(robot, batch, rows, [*logs[n:], *logs[:n]]) for n in range(len(logs))])
    value, half, alarms = np.moveaxis(found, -1, 0)
    for place in range(len(logs)):
        one, its = value[:, place], half[:, place]
        inside, overlap = (one >= low) & (one <= high), (one - its <= high) & (one + its >= low)
        away = 100 * (one / middle - 1)
        usual = ", ".join(
            f"{name} {mean:+.1f} ± {spread:.1f} %"
            for name, mean, spread in zip(names, away.mean(axis=0), away.std(axis=0), strict=True)
        )
        print(
            f"after {place + 1} logs {inside.sum()} of {inside.size} are within the batch intervals, "
            f"{overlap.sum()} intervals overlap them; {usual}"
        )
    seconds = sum(log.duration for log in logs)
    told = int(alarms.any(axis=-1).sum())
    print(f"a change of ground told in {told} of {len(logs) ** 2} logs, {len(logs)} times {seconds:.0f} s")
    both = [_stiffnesses(identify_feet(robot, logs[n : n + 2])) for n in range(len(logs) - 1)]
    pairs = np.array([[np.nan if row.value is None else row.value for row in two] for two in both])
    print(
        f"batch fits of two logs: {((pairs >= low) & (pairs <= high)).sum()} of {pairs.size} are within the intervals"
    )


def _stiffnesses(result: FeetResult) -> list[Parameter]:
    return [row for row in result.parameters if row.name == "stiffness" and row.axis != "z"]


def _learnt(
    robot: RobotModel, batch: FeetResult, rows: Sequence[Parameter], logs: Sequence[MotionLog]
) -> list[list[tuple[float, float, float]]]:
    """After each log, of each row: stiffness, half width, whether another ground was told in it."""
    estimator, learnt = FootEstimator(robot, batch), []
    for log in logs:
        replay = estimator.replay(log)
        after = []
        for row in rows:
            stiffness = getattr(replay.estimate(row.foot), row.axis).stiffness
            told = (replay.column(row.foot, "flags").astype(int) & Flag.GROUND_CHANGED).any()
            after.append((stiffness.value, stiffness.half_width, float(told)))
        learnt.append(after)
    return learnt


if __name__ == "__main__":
    main(*(str(Path(word)) for word in sys.argv[1:]))
