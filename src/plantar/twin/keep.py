"""Plans and rollouts as arrays, to be kept in the cache and found there again."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

import numpy as np

from plantar.conventions import Array
from plantar.motions.campaign import Postures
from plantar.motions.plan import Hand, Plan, Walk
from plantar.robot.model import Placement, RobotModel
from plantar.twin import cache
from plantar.twin.simulation.physics import Physics
from plantar.twin.simulation.rollout import Rollout

TABLES = ("sensors", "bush", "bush_rates", "rubber")
ARRAYS = ("time", "base", "positions", "velocities", "efforts", "hand")


def plan_key(name: str, robot: RobotModel, postures: Postures, options: Mapping[str, float | None]) -> str:
    """What a plan comes from."""
    with np.printoptions(
        floatmode="unique", threshold=sys.maxsize
    ):  # else arrays are rounded to eight digits
        mounting = repr((robot.imu, dict(robot.feet)))
    return cache.key("plan", name, robot.urdf, mounting, repr(postures), repr(sorted(options.items())))


def rollout_key(plan: Plan, physics: Physics, xml: str) -> str:
    """What a rollout comes from."""
    arrays = plan_arrays(plan)
    return cache.key("rollout", plan.name, xml, repr(physics), *(arrays[field] for field in sorted(arrays)))


def plan_arrays(plan: Plan) -> dict[str, Array]:
    arrays: dict[str, Array] = {
        "time": plan.time, "joints": np.array(plan.joints), "positions": plan.positions, "base": plan.base,
        "standing": np.array(sorted(plan.standing)),
    }  # fmt: skip
    arrays |= {f"stance/{foot}": pose for foot, pose in plan.stance.items()}
    if plan.hand is not None:
        held = plan.hand.held
        arrays |= {"hand/link": np.array(held.link), "hand/xyz": held.xyz, "hand/rpy": held.rpy}
        arrays |= {"hand/path": plan.hand.path, "hand/law": np.array([plan.hand.spring, plan.hand.damper])}
    if plan.walk is not None:
        arrays |= {"walk/zmp": plan.walk.zmp, "walk/centre": plan.walk.centre}
        arrays |= {f"walk/soles/{foot}": poses for foot, poses in plan.walk.soles.items()}
        arrays |= {f"walk/stands/{foot}": stands for foot, stands in plan.walk.stands.items()}
    return arrays


def plan_from(name: str, arrays: Mapping[str, Array]) -> Plan:
    hand = None
    if "hand/path" in arrays:
        held = Placement(str(arrays["hand/link"]), arrays["hand/xyz"], arrays["hand/rpy"])
        hand = Hand(held, arrays["hand/path"], *(float(value) for value in arrays["hand/law"]))
    walk = None
    if "walk/zmp" in arrays:
        soles, stands = _table(arrays, "walk/soles"), _table(arrays, "walk/stands")
        walk = Walk(soles, stands, arrays["walk/zmp"], arrays["walk/centre"])
    standing = frozenset(str(foot) for foot in arrays["standing"])
    joints = tuple(str(joint) for joint in arrays["joints"])
    return Plan(
        name,
        arrays["time"],
        joints,
        arrays["positions"],
        arrays["base"],
        standing,
        _table(arrays, "stance"),
        hand,
        walk,
    )


def rollout_arrays(rollout: Rollout) -> dict[str, Array]:
    arrays = {field: getattr(rollout, field) for field in ARRAYS} | {"joints": np.array(rollout.joints)}
    for table in TABLES:
        arrays |= {f"{table}/{name}": values for name, values in getattr(rollout, table).items()}
    return arrays


def rollout_from(name: str, arrays: Mapping[str, Array]) -> Rollout:
    tables: dict[str, Any] = {table: _table(arrays, table) for table in TABLES}
    plain: dict[str, Any] = {field: arrays[field] for field in ARRAYS}
    return Rollout(name=name, joints=tuple(str(joint) for joint in arrays["joints"]), **plain, **tables)


def _table(arrays: Mapping[str, Array], table: str) -> dict[str, Array]:
    prefix = f"{table}/"
    return {name.removeprefix(prefix): values for name, values in arrays.items() if name.startswith(prefix)}
