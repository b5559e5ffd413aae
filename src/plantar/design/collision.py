"""Does the robot touch itself? Its links' collision geometry along a motion, where the URDF brings one along."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pinocchio as pin

from plantar.conventions import Array
from plantar.robot.model import RobotModel

EVERY: Final = 10  # configurations: five a second
SHARES: Final = (1.0, 0.75, 0.5, 0.25)  # of a swing, tried in this order
BESIDE: Final = 1.3  # times as far, as legs and trunk move as well
PLACES: Final = 9
FOLDERS: Final = 5  # above the URDF, in which its meshes' packages may lie


@dataclass(frozen=True)
class SelfCollision:
    """`pairs`: how many pairs of links were watched, 0 where there is no geometry; `touching`: names of a pair that
    touches in the motion and not at rest, with the first time's row; None where none does."""

    pairs: int
    touching: tuple[str, str, int] | None = None


def self_collision(robot: RobotModel, configurations: Array) -> SelfCollision:
    """Watch all pairs of links that are apart at rest, the first row of (K, nq), and no neighbours."""
    model = robot.floating_model
    geometry = _geometry(robot, model)
    if geometry is None or not geometry.ngeoms:
        return SelfCollision(0)
    geometry.addAllCollisionPairs()
    data, shapes = model.createData(), geometry.createData()
    pin.computeCollisions(model, data, geometry, shapes, configurations[0], False)
    for place in reversed(range(len(geometry.collisionPairs))):
        pair = geometry.collisionPairs[place]
        joints = [geometry.geometryObjects[number].parentJoint for number in (pair.first, pair.second)]
        # What is fixed to a parent may come after its children.
        neighbours = any(model.parents[joint] == other for joint, other in (joints, joints[::-1]))
        if neighbours or shapes.collisionResults[place].isCollision():
            geometry.removeCollisionPair(pair)
    shapes = geometry.createData()
    for row in range(0, len(configurations), EVERY):
        if pin.computeCollisions(model, data, geometry, shapes, configurations[row], True):
            hit = next(p for p, result in enumerate(shapes.collisionResults) if result.isCollision())
            pair = geometry.collisionPairs[hit]
            first, second = (geometry.geometryObjects[number].name for number in (pair.first, pair.second))
            return SelfCollision(len(geometry.collisionPairs), (first, second, row))
    return SelfCollision(len(geometry.collisionPairs))


def free_swing(robot: RobotModel, rest: Array, swing: Array) -> float:
    """How much of a swing (nv,) of the arms to both sides of `rest` (nq,) no links touch in, as a share."""
    turns = np.repeat(np.linspace(-1.0, 1.0, PLACES), EVERY)
    for share in SHARES:
        places = [pin.integrate(robot.floating_model, rest, BESIDE * share * turn * swing) for turn in turns]
        if self_collision(robot, np.array([*EVERY * [rest], *places])).touching is None:
            return share
    return 0.0


def _geometry(robot: RobotModel, model: pin.Model) -> pin.GeometryModel | None:
    """The links' shapes; None where meshes are missing."""
    folders = [str(folder) for folder in robot.urdf_path.resolve().parents[:FOLDERS]]
    try:
        return pin.buildGeomFromUrdfString(
            model, robot.urdf, pin.GeometryType.COLLISION, package_dirs=folders
        )
    except (ValueError, RuntimeError):
        return None
