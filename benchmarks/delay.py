"""The sensors' delays put in and found again, and what damping is worth with them, without, and where they are unknown.

    python benchmarks/delay.py --seeds 3
    python benchmarks/delay.py --seeds 2 --apart

Recordings of the twin, whose wrench columns are moved in time; `realistic` is 5 ms late by itself. `corrected`: an arm
sweep (Myrand5) is among the logs; `not corrected`: the same logs, taken as if nothing were late; `no sweep`: the
composed motion alone (slow tilts, and sways with an operator's unmeasured force), whose intervals have to allow for it.
With `--apart` the left sensor, the right one and the encoders are each late by a delay of their own.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence

import numpy as np

from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.motions.campaign import FIT
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.signals.resampling import shifted
from plantar.twin import PAPER, PRESETS, play_all
from plantar.twin.robots import hrp2

UNEQUAL = ((10, 0, 0), (0, 0, 5), (0, 0, -5), (5, -5, 0), (8, 3, -4))  # ms: left and right wrench, encoders


def late(log: MotionLog, delay: float, columns: str = "wrench.") -> MotionLog:
    """The log with every column that begins so read `delay` [s] later than it was."""
    names = [name for name in log.columns if name.startswith(columns)]
    moved = shifted(log.stack(names), log.period, -delay)
    return log.with_columns(dict(zip(names, moved.T, strict=True)))


def damping_errors(result: FeetResult) -> tuple[list[float], list[bool], list[float]]:
    """Relative error, whether the interval holds the truth, and its relative half width: for every foot and axis."""
    errors, inside, halves = [], [], []
    for row in result.parameters:
        if row.name == "damping" and row.axis != "z" and row.value is not None and row.interval95 is not None:
            truth = getattr(PAPER[row.foot], f"{row.axis}_damping")
            low, high = row.interval95
            errors.append(row.value / truth - 1)
            inside.append(low <= truth <= high)
            halves.append((high - low) / 2 / truth)
    return errors, inside, halves


def print_apart(robot: RobotModel, presets: Sequence[str], seeds: int, others: Sequence[str]) -> None:
    """What comes of sensors that are late by different delays: worst of all seeds."""
    print("late [ms]: left wrench, right wrench, encoders, beside the preset's own; C in %")
    print(
        f"{'preset':10} {'put in':>12} | {'worst err ms':>12} {'C err':>6} {'half':>5} {'covered':>8} | {'as read':>8}"
    )
    for preset in presets:
        own = 1e3 * PRESETS[preset].sensors.wrench_delay
        campaigns = play_all([*FIT, *others], robot, PAPER, preset, range(seeds))
        for left, right, encoders in UNEQUAL:
            misses, rows, taken = [], [], []
            for recordings in campaigns:
                logs = [
                    late(late(late(recording.log, 1e-3 * left, "wrench.left"), 1e-3 * right, "wrench.right"),
                         1e-3 * encoders, "joint.")
                    for recording in recordings
                ]  # fmt: skip
                found = identify_feet(robot, logs[: len(FIT)], logs[len(FIT) :])
                sensor_delay = found.sensor_delay
                for foot, delay in (("left", left), ("right", right)):
                    told = sensor_delay.feet.get(foot, sensor_delay.wrench_delay)
                    misses.append(abs(1e3 * told - delay - own))
                misses.append(abs(1e3 * sensor_delay.encoder_delay - encoders))
                rows.append(damping_errors(found))
                as_read = FeetSettings(wrench_delay=1e-3 * own)
                taken.append(damping_errors(identify_feet(robot, logs[: len(FIT)], settings=as_read)))
            worst, uncorrected = (
                100 * max(abs(e) for one in group for e in one[0]) for group in (rows, taken)
            )
            inside = [flag for one in rows for flag in one[1]]
            half = 100 * max(h for one in rows for h in one[2])
            print(f"{preset:10} {left:4} {right:3} {encoders:3} | {max(misses):12.2f} {worst:6.1f} {half:5.1f} "
                  f"{sum(inside):4}/{len(inside):3} | {uncorrected:8.1f}", flush=True)  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--presets", nargs="+", default=["sensors", "realistic"])
    parser.add_argument("--delays", nargs="+", type=float, default=[-10, -5, 0, 5, 10, 20], help="ms, put in")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--others", nargs="+", default=["Myrand5"], help="motions that show the delay")
    parser.add_argument("--apart", action="store_true", help="a delay of its own for each sensor")
    chosen = parser.parse_args()
    robot, split = hrp2.robot(), len(FIT)
    if chosen.apart:
        print_apart(robot, chosen.presets, chosen.seeds, chosen.others)
        return
    print("errors and half widths of C in %: worst foot and axis of all seeds; covered: C's 95 % intervals")
    print(
        f"{'preset':10} {'late ms':>8} | {'found ms':>9} {'worst err':>9} {'claimed':>8} {'C err':>6} {'half':>5} "
        f"{'covered':>8} | {'not corrected':>13} | {'no sweep: C err':>15} {'half':>5} {'covered':>8}  told"
    )
    for preset in chosen.presets:
        own = 1e3 * PRESETS[preset].sensors.wrench_delay
        campaigns = play_all([*FIT, *chosen.others], robot, PAPER, preset, range(chosen.seeds))
        for delay in chosen.delays:
            found, claimed, told = [], [], set()
            results: list[list[FeetResult]] = [[], [], []]
            for seed, recordings in enumerate(campaigns):
                logs = [late(recording.log, 1e-3 * delay) for recording in recordings]
                corrected = identify_feet(robot, logs[:split], logs[split:])
                sensor_delay = corrected.sensor_delay
                found.append(1e3 * sensor_delay.wrench_delay)
                claimed.append(1e3 * 1.96 * sensor_delay.std)
                results[0].append(corrected)
                if seed == 0:
                    results[1].append(
                        identify_feet(robot, logs[:split], settings=FeetSettings(wrench_delay=0.0))
                    )
                results[2].append(identify_feet(robot, logs[:split]))
                told |= {note.code for note in results[2][-1].notes if note.code.startswith("delay")}
            true, rows = delay + own, [[damping_errors(one) for one in group] for group in results]
            worst = [100 * max(abs(e) for one in group for e in one[0]) for group in rows]
            inside = [[flag for one in group for flag in one[1]] for group in rows]
            half = [100 * max(h for one in group for h in one[2]) for group in rows]
            print(f"{preset:10} {true:8.0f} | {np.mean(found):9.2f} {max(abs(f - true) for f in found):9.2f} "
                  f"{np.mean(claimed):8.2f} {worst[0]:6.1f} {half[0]:5.1f} {sum(inside[0]):4}/{len(inside[0]):3} | "
                  f"{worst[1]:13.1f} | {worst[2]:15.1f} {half[2]:5.1f} {sum(inside[2]):4}/{len(inside[2]):3}  "
                  f"{', '.join(sorted(told))}", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
