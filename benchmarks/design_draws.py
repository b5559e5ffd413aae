"""Designed motions on feet of stiffness drawn from the whole range: does the robot fall, tip, slip?

    python benchmarks/design_draws.py --robots hrp2,g1 --draws 20 --out DIR

Plays the motions that `design_motions.py` left in DIR, each on feet between half and twice the stiffness told (no
softer than the robot can stand on), and says the worst of all draws: how near a sole's border a centre of pressure
comes, the least load of a foot, the friction that a foot needs, the torques.
"""

from __future__ import annotations

import argparse
import json
from dataclasses import replace
from pathlib import Path

import numpy as np

from design_motions import ROBOTS, robot_file
from plantar.conventions import GRAVITY
from plantar.design.rehearsals.rehearsal import Rehearsal, rehearse
from plantar.design.soft_feet import Softness
from plantar.twin.own_motion import own_plan

AT_ONCE = 4  # rollouts in memory


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--robots", default=",".join(ROBOTS))
    parser.add_argument("--draws", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, required=True)
    given = parser.parse_args()
    for name in given.robots.split(","):
        robot, motion = robot_file(name, given.out / name), given.out / name / "motion.csv"
        promised = json.loads(motion.with_suffix(".json").read_text())
        told = Softness.told(robot, promised["settings"]["stiffness"], promised["settings"]["damping"])
        low, high = (stiffness / told.stiffness for stiffness in promised["stiffness_range"])
        factors = np.exp(np.random.default_rng(given.seed).uniform(np.log(low), np.log(high), given.draws))
        plan = own_plan(motion, robot)
        found: list[Rehearsal] = []
        for begin in range(0, given.draws, AT_ONCE):
            played = rehearse(
                robot, plan, told, factors[begin : begin + AT_ONCE].tolist(), progress=lambda _: None
            )
            found += [replace(one, rollout=None) for one in played]
        stood = [one for one in found if one.fell is None]
        for one in found:
            if one.fell is not None:
                print(f"{name} x{one.factor:.2f}: {one.fell}")
        near = min(stood, key=lambda one: one.sole_margin)
        kept = next(limit["kept"] for limit in promised["limits"] if limit["unit"] == "m")
        print(
            f"{name}, {robot.mass * GRAVITY:.0f} N: {len(stood)} of {len(found)} draws stand; margin "
            f"{1e3 * near.sole_margin:.1f} mm at x{near.factor:.2f} (promised {1e3 * kept:.1f}), least load "
            f"{100 * min(one.least_load for one in stood):.0f} %, friction {max(one.friction for one in stood):.2f}, "
            f"torque {100 * max(one.effort for one in stood):.0f} %, bend {max(one.bend for one in stood):.3f} rad",
            flush=True,
        )


if __name__ == "__main__":
    main()
