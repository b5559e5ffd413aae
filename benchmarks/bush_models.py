"""Which law of the bush is chosen, and what it makes of spring and damper, over rubbers drawn by seed.

    python benchmarks/bush_models.py --seeds 20

Recordings are computed from a known deflection (no simulator): sways of 0.3-1 Hz and 0.05-0.14 rad, slow tilts, sensors
with bias, drift and noise. Rubbers: slip torques of 7 to 20 % of the largest torque, slip angles of 4 to 20 mrad.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "support"))
from bush_data_sets import Rubber, campaign, largest_torque, unseen, unseen_error
from plantar.model_selection.selection import choose_model

RUBBERS = ("none", "jenkins", "bouc_wen 1", "bouc_wen 2", "hardening", "coulomb")


def rubber(kind: str, seed: int) -> Rubber:
    """The truth of one seed."""
    rng = np.random.default_rng(1000 + seed)
    share, slip_angle = rng.uniform(0.07, 0.2), rng.uniform(0.004, 0.02)
    slip_torque = share * largest_torque(campaign(seed, Rubber()))
    if kind.startswith("bouc_wen"):
        return Rubber(slip_torque=slip_torque, slip_angle=slip_angle, sharpness=float(kind.split()[1]))
    return {
        "none": Rubber(),
        "jenkins": Rubber(slip_torque=slip_torque, slip_angle=slip_angle),
        "hardening": Rubber(hardening=rng.uniform(3000, 10000)),
        "coulomb": Rubber(coulomb=rng.uniform(2, 6)),
    }[kind]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--rubbers", nargs="+", default=list(RUBBERS), choices=RUBBERS)
    chosen = parser.parse_args()
    print(
        "errors in % of the truth: median and largest; 'linear' is spring and damper alone on the same motions"
    )
    print(f"{'rubber':11} {'laws chosen':46} {'K':>12} {'C':>13} {'linear K':>12} {'linear C':>14} "
          f"{'covered K C':>12} {'unseen':>7} {'CPU s':>6}")  # fmt: skip
    for kind in chosen.rubbers:
        models: Counter[str] = Counter()
        errors, inside, ratios, spent = [], [], [], []
        for seed in range(chosen.seeds):
            truth = rubber(kind, seed)
            data_sets = campaign(seed, truth)
            started = time.process_time()
            choice = choose_model(data_sets, shared_offset=False, before=None)
            spent.append(time.process_time() - started)
            models[choice.fit.model.name] += 1
            pair = np.array([truth.stiffness, truth.damping])
            fits = (choice.fit, choice.equivalent)
            errors.append(np.concatenate([100 * np.abs(fit.values[:2] / pair - 1) for fit in fits]))
            bounds = [choice.fit.interval95(name) for name in ("stiffness", "damping")]
            inside.append([low <= value <= high for (low, high), value in zip(bounds, pair, strict=True)])
            others = unseen(seed, truth)
            ratios.append(unseen_error(choice.fit, others) / unseen_error(choice.equivalent, others))
        middle, most = np.median(errors, axis=0), np.max(errors, axis=0)
        covered = np.sum(inside, axis=0)
        names = ", ".join(f"{name} {count}" for name, count in models.most_common())
        print(f"{kind:11} {names:46} {middle[0]:5.2f} {most[0]:6.2f} {middle[1]:6.2f} {most[1]:6.2f} "
              f"{middle[2]:5.1f} {most[2]:6.1f} {middle[3]:7.1f} {most[3]:6.1f} "
              f"{covered[0]:6d} {covered[1]:5d} {np.max(ratios):7.2f} {np.mean(spent):6.2f}", flush=True)  # fmt: skip
    print(
        "unseen: largest over the seeds of (error of the chosen law / error of the linear one) on motions unseen"
    )


if __name__ == "__main__":
    main()
