"""The wrenches' delay put in and found again, and what damping is worth with it, without it, and where it is unknown.

    python benchmarks/delay.py --seeds 3

Recordings of the twin, whose wrench columns are moved in time; `realistic` is 5 ms late by itself. `corrected`: an arm
sweep (Myrand5) is among the logs; `not corrected`: the same logs, taken as if nothing were late; `no sweep`: the
composed motion alone (slow tilts, and sways with an operator's unmeasured force), whose intervals have to allow for it.
"""

from __future__ import annotations

import argparse

import numpy as np

from plantar.identify.feet import identify_feet
from plantar.identify.settings import FeetSettings
from plantar.log import MotionLog
from plantar.motions.campaign import FIT
from plantar.result import FeetResult
from plantar.signals import shifted
from plantar.twin import PAPER, PRESETS, hrp2, play_all


def late(log: MotionLog, delay: float) -> MotionLog:
    """The log with every wrench column read `delay` [s] later than it was."""
    names = [name for name in log.columns if name.startswith("wrench.")]
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


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--presets", nargs="+", default=["sensors", "realistic"])
    parser.add_argument("--delays", nargs="+", type=float, default=[-10, -5, 0, 5, 10, 20], help="ms, put in")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--others", nargs="+", default=["Myrand5"], help="motions that show the delay")
    chosen = parser.parse_args()
    robot, split = hrp2.robot(), len(FIT)
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
                latency = corrected.extras["latency"]
                found.append(1e3 * latency["wrench_delay"])
                claimed.append(1e3 * 1.96 * latency["std"])
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
