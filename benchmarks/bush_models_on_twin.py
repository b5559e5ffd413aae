"""Which law of the bush is chosen on the twin, over noise seeds, without hysteresis, with it, and with twice as much.

    python benchmarks/bush_models_on_twin.py --seeds 20

One rollout a motion and rubber; the sensors are drawn anew for every seed. `slip` is the torque at which the rubber's
elastoplastic elements slip, in pitch and roll. The linear law is fitted to the same motions with the same delay.
"""

from __future__ import annotations

import argparse
from collections import Counter
from dataclasses import replace

import numpy as np

from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.models import MODELS
from plantar.models.hysteresis import Hysteretic
from plantar.motions.campaign import FIT
from plantar.results.feet import FeetResult
from plantar.twin import PAPER, PRESETS
from plantar.twin.play import planned, roll_all
from plantar.twin.presets import SLIP_TORQUE
from plantar.twin.recording import record
from plantar.twin.robots import hrp2

NAMES = ("stiffness", "damping")
UNSEEN = ("Tilt1", "Myrand5")


def errors(result: FeetResult) -> dict[str, list[float]]:
    """Relative errors of K and C in %, every foot and rotational axis."""
    found: dict[str, list[float]] = {name: [] for name in NAMES}
    for row in result.parameters:
        if row.name in NAMES and row.axis != "z" and row.value is not None:
            truth = getattr(PAPER[row.foot], f"{row.axis}_{row.name}")
            found[row.name].append(100 * abs(row.value / truth - 1))
    return found


def unseen_error(result: FeetResult) -> float:
    """Mean absolute error on motions outside the fit, the mean of all feet, axes and motions [N·m]."""
    return float(np.mean([row.mean_abs_error for row in result.validation if row.kind == "cross"]))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument(
        "--slip", nargs="+", type=float, default=[0, 1, 2], help="times the usual slip torque"
    )
    parser.add_argument("--unseen", nargs="+", default=list(UNSEEN))
    chosen = parser.parse_args()
    robot = hrp2.robot()
    plans = [planned(name, robot) for name in [*FIT, *chosen.unseen]]
    print(
        "errors in %: median of all feet, axes and seeds, and largest; unseen: error over the linear law's, worst seed"
    )
    print(f"{'slip N·m':>12} {'laws chosen (seeds, by axis)':44} {'K':>6} {'max':>6} {'C':>6} {'max':>6} "
          f"{'linear K':>9} {'C':>6} {'unseen':>7} {'worst':>6} {'right':>6}")  # fmt: skip
    for share in chosen.slip:
        slip = (share * SLIP_TORQUE[0], share * SLIP_TORQUE[1])
        preset = replace(PRESETS["realistic" if share else "sensors"], slip_torque=slip)
        physics = preset.physics(PAPER)
        rollouts = roll_all([(plan, physics) for plan in plans], robot)
        models: Counter[str] = Counter()
        right, ratios = 0, []
        auto: dict[str, list[float]] = {name: [] for name in NAMES}
        linear: dict[str, list[float]] = {name: [] for name in NAMES}
        for seed in range(chosen.seeds):
            logs: list[MotionLog] = [record(one, robot, physics, preset, seed).log for one in rollouts]
            fit, unseen = logs[: len(FIT)], logs[len(FIT) :]
            result = identify_feet(robot, fit, unseen)
            known = FeetSettings(model="kelvin_voigt", wrench_delay=result.sensor_delay.wrench_delay)
            plain = identify_feet(robot, fit, unseen, known)
            names = [row.model for row in result.models]
            models.update(names)
            wanted = [
                isinstance(MODELS[name], Hysteretic) if share else name == "kelvin_voigt" for name in names
            ]
            right += all(wanted)
            for name in NAMES:
                auto[name] += errors(result)[name]
                linear[name] += errors(plain)[name]
            ratios.append(unseen_error(result) / unseen_error(plain))
        told = ", ".join(f"{name} {count}" for name, count in models.most_common())
        print(f"{slip[0]:5.1f} {slip[1]:5.1f}  {told:44} "
              + " ".join(f"{np.median(auto[name]):6.2f} {max(auto[name]):6.2f}" for name in NAMES)
              + f" {np.median(linear['stiffness']):9.1f} {np.median(linear['damping']):6.0f}"
              f" {np.mean(ratios):7.2f} {max(ratios):6.2f} {right:3}/{chosen.seeds}", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
