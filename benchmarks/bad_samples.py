"""What bad samples and loud sensors do to K and C on the twin.

    python benchmarks/bad_samples.py --seeds 1

`spikes`: 0.5 % of the samples of every wrench with 50 times its noise. `bursts`: three stretches of 0.2 s in each
recording with 50 times the noise; `held`: with a constant error of that size. `gyroscope spikes`: as `spikes`, there.
`loud gyroscope`, `loud attitude`: ten times the white noise throughout.
"""

from __future__ import annotations

import argparse

import numpy as np

from plantar.feet.identify import identify_feet
from plantar.logs.motion_log import MotionLog
from plantar.motions.campaign import FIT
from plantar.twin import PAPER, play_all
from plantar.twin.robots import hrp2

KINDS = ("clean", "spikes", "bursts", "held", "gyroscope spikes", "loud gyroscope", "loud attitude")
NOISE = {"force": 1.0, "torque": 0.1, "angular_velocity": 0.0013, "orientation": 4.4e-5}
TOUCHED = {
    "gyroscope spikes": "angular_velocity",
    "loud gyroscope": "angular_velocity",
    "loud attitude": "orientation",
}
TIMES = 50.0


def spoilt(log: MotionLog, kind: str, seed: int) -> MotionLog:
    """The log with bad samples of one kind."""
    random, count = np.random.default_rng(seed), len(log)
    lone, bad = random.random(count) < 0.005, np.zeros(count, dtype=bool)
    for start in random.integers(count // 10, count - count // 10, 3):
        bad[start : start + round(0.2 / log.period)] = True
    columns = {}
    for name, column in log.columns.items():
        quantity = name.split(".")[2] if name.startswith(("imu.", "wrench.")) else ""
        if quantity not in NOISE or (
            quantity != TOUCHED[kind] if kind in TOUCHED else not name.startswith("wrench.")
        ):
            continue
        white = NOISE[quantity] * random.standard_normal(count)
        columns[name] = column + {
            "clean": 0.0,
            "bursts": TIMES * bad * white,
            "held": TIMES * bad * NOISE[quantity],
            "loud gyroscope": 10 * white,
            "loud attitude": 10 * white,
        }.get(kind, TIMES * lone * white)
    return log.with_columns(columns)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--presets", nargs="+", default=["sensors", "realistic"])
    parser.add_argument("--kinds", nargs="+", default=list(KINDS), choices=KINDS)
    parser.add_argument("--seeds", type=int, default=1)
    chosen = parser.parse_args()
    robot, split = hrp2.robot(), len(FIT)
    print(
        "largest errors and half widths in % over feet, axes and seeds; inside: intervals that hold the truth"
    )
    print(
        f"{'preset':10} {'bad samples':17} {'K err':>6} {'half':>6} {'inside':>7} {'C err':>6} {'half':>6} "
        f"{'inside':>7} {'left out s':>11}  told"
    )
    for preset in chosen.presets:
        campaigns = play_all([*FIT, "Myrand5"], robot, PAPER, preset, range(chosen.seeds))
        for kind in chosen.kinds:
            rows: dict[str, list[tuple[float, float, bool]]] = {"stiffness": [], "damping": []}
            seconds, told = 0.0, set()
            for seed, recordings in enumerate(campaigns):
                logs = [spoilt(one.log, kind, 10 * seed + place) for place, one in enumerate(recordings)]
                result = identify_feet(robot, logs[:split], logs[split:])
                for row in result.parameters:
                    if (
                        row.name in rows
                        and row.axis != "z"
                        and row.value is not None
                        and row.interval95 is not None
                    ):
                        truth = getattr(PAPER[row.foot], f"{row.axis}_{row.name}")
                        low, high = row.interval95
                        found = (abs(row.value / truth - 1), (high - low) / 2 / truth, low <= truth <= high)
                        rows[row.name].append(found)
                seconds += sum(
                    phase.end - phase.start
                    for phase in result.phases
                    if phase.reason is not None and phase.reason.startswith("outlier")
                )
                told |= {note.code for note in result.notes} & {"spikes", "noisy_regressors", "delay_unknown"}
            numbers = " ".join(
                f"{100 * max(each[0] for each in group):6.2f} {100 * max(each[1] for each in group):6.2f} "
                f"{sum(each[2] for each in group):3}/{len(group):3}"
                for group in rows.values()
            )
            print(f"{preset:10} {kind:17} {numbers} {seconds:11.1f}  {', '.join(sorted(told))}", flush=True)


if __name__ == "__main__":
    main()
