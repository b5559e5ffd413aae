"""A fleet's robot files: brought to the machine that needs them, with the hash of all that they hold."""

from __future__ import annotations

import hashlib
import tempfile
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from plantar.errors import PlantarError, located
from plantar.fleet.places import brought, is_remote, joined_place
from plantar.robot.model import RobotModel, load_robot
from plantar.robot.schema import read_robot_file

KEPT = 64  # robots that a process keeps in memory


@dataclass(frozen=True)
class FleetRobot:
    """A robot file by its place, and the hash of its content and its URDF's."""

    place: str
    sha256: str


def robot_at(place: str) -> FleetRobot:
    """The robot file at a place, checked.

    Raises RobotError where it or its URDF is wrong, PlantarError where one is not there.
    """
    robot = _loaded(place)
    digest = hashlib.sha256(robot.path.read_bytes())
    digest.update(hashlib.sha256(robot.urdf.encode()).digest())
    return FleetRobot(place, digest.hexdigest())


@lru_cache(KEPT)
def robot_model(robot: FleetRobot) -> RobotModel:
    """The robot, read once a process. Raises PlantarError where its file is not the one that was asked for any more."""
    if robot_at(robot.place) != robot:
        raise PlantarError(
            located("changed while the fleet was running", path=robot.place, valid="a new run")
        )
    return _loaded(robot.place)


def _loaded(place: str) -> RobotModel:
    if not is_remote(place):
        return load_robot(place)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        path = brought(place, folder)
        entry, _ = read_robot_file(path)
        urdf = folder / entry.urdf
        if not urdf.resolve().is_relative_to(folder.resolve()):
            valid = "a URDF beside or below the robot file"
            raise PlantarError(
                located("names a URDF outside its folder", path=place, column="urdf", valid=valid)
            )
        urdf.parent.mkdir(parents=True, exist_ok=True)
        brought(_beside(place, entry.urdf), urdf.parent)
        return load_robot(path)


def _beside(place: str, name: str) -> str:
    return place.rsplit("/", 1)[0] + "/" + name if is_remote(place) else joined_place(Path(place), name)
