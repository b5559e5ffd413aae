"""How often the 95 % intervals of K and C cover the truth, over noise seeds and presets of the twin.

    python benchmarks/coverage.py --presets sensors --seeds 20

One rollout a motion and preset; the sensors are drawn anew for every seed.
"""

from __future__ import annotations

import argparse
import time
from collections import Counter, defaultdict

import numpy as np

from plantar.identify.feet import identify_feet
from plantar.identify.settings import FeetSettings
from plantar.motions.campaign import FIT
from plantar.twin import PAPER, hrp2, play_all

NAMES = {"stiffness": "K", "damping": "C"}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--presets", nargs="+", default=["sensors"])
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--motions", nargs="+", default=list(FIT))
    parser.add_argument(
        "--others", nargs="*", default=["Myrand5"], help="motions to validate: they show the delay"
    )
    parser.add_argument("--offset", default="per-motion")
    parser.add_argument("--model", default="auto")
    chosen = parser.parse_args()
    robot = hrp2.robot()
    for preset in chosen.presets:
        started = time.perf_counter()
        campaigns = play_all([*chosen.motions, *chosen.others], robot, PAPER, preset, range(chosen.seeds))
        print(f"\n{preset}: {len(chosen.motions)} motions, {chosen.seeds} seeds, offset {chosen.offset}; "
              f"rollouts {time.perf_counter() - started:.0f} s")  # fmt: skip
        errors = defaultdict(list)
        models: Counter[str] = Counter()
        settings = FeetSettings(offset=chosen.offset, model=chosen.model)
        for recordings in campaigns:
            logs = [recording.log for recording in recordings]
            split = len(chosen.motions)
            result = identify_feet(robot, logs[:split], logs[split:], settings)
            models[result.model] += 1
            for row in result.parameters:
                truth = getattr(PAPER[row.foot], f"{row.axis}_{row.name}", None)
                if row.name in NAMES and truth and row.value is not None and row.interval95 is not None:
                    inside = row.interval95[0] <= truth <= row.interval95[1]
                    half = (row.interval95[1] - row.interval95[0]) / 2
                    errors[row.foot, row.axis, row.name].append(
                        (row.value / truth - 1, inside, half / truth, row.relative_std_percent)
                    )
        print(f"laws chosen: {dict(models)}")
        _print(errors)


def _print(errors: dict[tuple[str, str, str], list[tuple[float, bool, float, float]]]) -> None:
    heads = ("mean err %", "max |err| %", "half width %", "white std %", "covered %")
    print(f"{'foot':6} {'axis':6} {'':2}" + "".join(f"{head:>14}" for head in heads))
    rotational = []
    for (foot, axis, name), rows in errors.items():
        relative, inside, half, white = (np.array(column, dtype=float) for column in zip(*rows, strict=True))
        numbers = (
            100 * relative.mean(),
            100 * abs(relative).max(),
            100 * half.mean(),
            white.mean(),
            100 * inside.mean(),
        )
        print(
            f"{foot:6} {axis:6} {NAMES.get(name, name):2}" + "".join(f"{number:14.3f}" for number in numbers)
        )
        if axis != "z":
            rotational += rows
    for name in ("K", "C"):
        rows = [
            row
            for key, all_rows in errors.items()
            if key[1] != "z" and NAMES.get(key[2]) == name
            for row in all_rows
        ]
        print(f"{name}: {100 * np.mean([row[1] for row in rows]):.1f} % of {len(rows)} intervals cover")
    print(
        f"K and C: {100 * np.mean([row[1] for row in rotational]):.1f} % of {len(rotational)} intervals cover the truth"
    )


if __name__ == "__main__":
    main()
