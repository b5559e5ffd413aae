"""Rubber with a memory of which the estimator is told nothing: is it seen, and is it seen where there is none?

    python benchmarks/online_memory.py --seeds 4

The twin's motions, a few logs one after the other, on feet that are springs and dampers (`sensors`) and on feet with an
elastoplastic element (`realistic`); no batch result. For each foot and axis at the end: whether the memory is told, or
K is called identified, and how far it is off then. Seeds below 100 were used to choose thresholds.
"""

from __future__ import annotations

import argparse
from collections import Counter
from dataclasses import replace

from online_ground import Player
from plantar.conventions import ROTATIONAL_AXES
from plantar.online.estimates import Flag
from plantar.online.estimator import FootEstimator
from plantar.robot.uncertainty import EXACT
from plantar.twin import PAPER
from plantar.twin.presets import preset_named
from plantar.twin.robots import hrp2

CAMPAIGNS = (
    ("Tilt1", "Tilt3"),
    ("Tilt4", "Squat", "Tilt6"),
    ("Manual_right_roll", "Manual_right_pitch", "Manual_left_roll", "Manual_left_pitch"),
    ("Myrand4", "Myrand5"),
    ("Walk8", "Walk12"),
    ("Walk16", "WalkTurn"),
    ("WalkSlow8", "WalkInPlace"),
    ("Tilt1", "Walk12", "Tilt3", "Walk16"),
)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--first", type=int, default=100, help="seed")
    told = parser.parse_args()
    robot = replace(hrp2.robot(), uncertainty=EXACT)
    for name in ("sensors", "realistic"):
        preset, whole = preset_named(name), Counter[str]()
        for campaign in CAMPAIGNS:
            players = [Player(motion, PAPER, preset) for motion in campaign]
            found, errors = Counter[str](), list[float]()
            for seed in range(told.first, told.first + told.seeds):
                estimator = FootEstimator(robot, wrench_delay=preset.sensors.wrench_delay)
                for player in players:
                    replay = estimator.replay(player(seed).log)
                for foot in replay.feet:
                    last = replay.estimate(foot)
                    for axis, flag in zip(
                        ROTATIONAL_AXES, (Flag.PITCH_MEMORY, Flag.ROLL_MEMORY), strict=True
                    ):
                        one = getattr(last, axis)
                        said = (
                            "memory" if last.flags & flag else "identified" if one.identified else "unknown"
                        )
                        found[said] += 1
                        if said == "identified":
                            errors.append(one.stiffness.value / getattr(PAPER[foot], f"{axis}_stiffness") - 1)
            whole += found
            far = f", K off by up to {100 * max(map(abs, errors)):.1f} %" if errors else ""
            counts = ", ".join(f"{count} {said}" for said, count in sorted(found.items()))
            print(f"{name}, {' '.join(campaign)}: {counts}{far}", flush=True)
        print(f"{name}: {dict(sorted(whole.items()))}")


if __name__ == "__main__":
    main()
