"""How often intervals of base parameters and of joint friction hold the truth, over seeds, a small biped and an arm.

Each seed draws another robot (masses, centres and inertias away from the URDF's), another motion and other noise.

    python benchmarks/coverage_dynamics.py --seeds 20
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pinocchio as pin

from plantar.dynamics import Equation, base_parameters, model_parameters
from plantar.logs.motion_log import MotionLog
from plantar.results.dynamics import BaseParameter, DynamicsResult, JointParameter
from plantar.robot.model import RobotModel, load_robot
from plantar.whole_body.dataset import COULOMB_SPEED
from plantar.whole_body.inertia import identify_inertia
from plantar.whole_body.joints import identify_joints
from plantar.whole_body.settings import DynamicsSettings

sys.path.append(str(Path(__file__).parents[1] / "tests" / "support"))
import example_robots
import small_biped

FRICTION = {"viscous": 3.0, "coulomb": 2.0, "offset": 0.5}
BIPED_NOISE = 2.0  # N and a tenth of it in N.m
ARM_NOISE = 0.3  # N.m


class Score(NamedTuple):
    """One parameter: whether its interval holds the truth, its error over the deviation, and over the value."""

    kind: str
    inside: bool
    ratio: float
    relative: float


def scored(kind: str, row: BaseParameter | JointParameter, exact: float) -> Score:
    error = row.value - exact
    inside = row.interval95[0] <= exact <= row.interval95[1]
    return Score(kind, inside, error / row.std, abs(error / exact) if exact else np.nan)


def with_friction(log: MotionLog, robot: RobotModel) -> MotionLog:
    changed = {}
    for name in robot.joint_names:
        velocity = log.column(f"joint.{name}.velocity")
        friction = FRICTION["viscous"] * velocity + FRICTION["coulomb"] * np.tanh(velocity / COULOMB_SPEED)
        changed[f"joint.{name}.effort"] = log.column(f"joint.{name}.effort") + friction + FRICTION["offset"]
    return log.with_columns(changed)


def arm_log(arm: RobotModel, real: pin.Model, seed: int) -> MotionLog:
    rng = np.random.default_rng(seed)
    time = np.arange(0, 30, 0.01)
    states = np.array([small_biped.smooth(rng, time, 1.2) for _ in arm.joint_names])
    q, v, a = (states[:, k].T for k in range(3))
    data = real.createData()
    torque = np.array([pin.rnea(real, data, *sample) for sample in zip(q, v, a, strict=True)])
    torque += rng.normal(0, ARM_NOISE, torque.shape)
    columns = {}
    for k, joint in enumerate(arm.joint_names):
        for quantity, values in (("position", q), ("velocity", v), ("acceleration", a), ("effort", torque)):
            columns[f"joint.{joint}.{quantity}"] = values[:, k]
    return MotionLog("arm", time, columns)


def scores(label: str, result: DynamicsResult, model: pin.Model, real: pin.Model) -> Iterator[Score]:
    base = base_parameters(Equation(model))
    true, cad = (base.grouping @ model_parameters(one) for one in (real, model))
    for row, exact, guess in zip(result.base_parameters, true, cad, strict=True):
        # Decided by the data: the deviation is small beside how far a robot may be from its URDF.
        kind = "decided" if row.std < 0.1 * max(abs(exact), abs(exact - guess)) else "all others"
        yield scored(f"{label}, base, {kind}", row, exact)
    for joint in result.parameters:
        yield scored(f"{label}, {joint.name}", joint, FRICTION.get(joint.name, 0.0))


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--cutoff", type=float, default=DynamicsSettings.cutoff)
    arguments = parser.parse_args()
    settings = DynamicsSettings(arguments.cutoff)
    found: dict[str, list[Score]] = defaultdict(list)
    with tempfile.TemporaryDirectory() as folder:
        biped = small_biped.robot(Path(folder), "uncertainty: {wrench_gain: 0}\n")  # its sensors have none
        (Path(folder) / "arm.urdf").write_text(example_robots.UR5.read_text())
        (Path(folder) / "arm.yaml").write_text("name: arm\nurdf: arm.urdf\nbase: fixed\n")
        arm = load_robot(Path(folder) / "arm.yaml")
    for seed in range(100, 100 + arguments.seeds):
        walker, reacher = (small_biped.truth(model, seed) for model in (biped.floating_model, arm.model))
        log = with_friction(small_biped.record(biped, walker, "walk", seed, 30.0, BIPED_NOISE), biped)
        for label, result, model, real in (
            ("biped eq. 2", identify_inertia(biped, [log], settings=settings), biped.floating_model, walker),
            ("biped eq. 3", identify_joints(biped, [log], settings=settings), biped.floating_model, walker),
            (
                "arm eq. 3",
                identify_joints(arm, [with_friction(arm_log(arm, reacher, seed), arm)]),
                arm.model,
                reacher,
            ),
        ):
            for score in scores(label, result, model, real):
                found[score.kind].append(score)
        print(f"seed {seed}", file=sys.stderr, flush=True)
    print(
        f"{'parameters':36} {'count':>6} {'inside [%]':>11} {'rms error/std':>14} {'median |error| [%]':>19}"
    )
    for kind, group in sorted(found.items()):
        ratio = np.array([score.ratio for score in group])
        inside = 100 * np.mean([score.inside for score in group])
        relative = np.median([score.relative for score in group])
        print(f"{kind:36} {len(group):6} {inside:11.1f} "
              f"{np.sqrt(np.mean(ratio**2)):14.2f} {100 * relative:19.2f}")  # fmt: skip


if __name__ == "__main__":
    main()
