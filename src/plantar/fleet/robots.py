"""A fleet's robot files: brought to the machine that needs them, with the hash of all that they hold."""

from __future__ import annotations

import hashlib
import tempfile
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from plantar.errors import PlantarError
from plantar.fleet.places import brought, is_remote
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
    return _loaded(place)[0]


@lru_cache(KEPT)
def robot_model(robot: FleetRobot) -> RobotModel:
    """The robot, read once a process. Raises PlantarError where its file is not the one that was asked for any more."""
    found, model = _loaded(robot.place)
    if found != robot:
        raise PlantarError("changed while the fleet was running", path=robot.place, valid="a new run")
    return model


def _loaded(place: str) -> tuple[FleetRobot, RobotModel]:
    if not is_remote(place):
        return _hashed(place, load_robot(place))
    beside = place.rsplit("/", 1)[0]
    with tempfile.TemporaryDirectory(prefix="plantar-") as folder:
        try:
            return _hashed(place, _copied(place, beside, Path(folder)))
        except PlantarError as error:
            raise PlantarError(str(error).replace(folder, beside)) from error


def _copied(place: str, beside: str, folder: Path) -> RobotModel:
    """A remote robot file through copies of it and its URDF in a folder."""
    path = brought(place, folder)
    entry, _ = read_robot_file(path)
    urdf = folder / entry["urdf"]
    if not urdf.resolve().is_relative_to(folder.resolve()):
        valid = "a URDF beside or below the robot file"
        raise PlantarError("names a URDF outside its folder", path=place, column="urdf", valid=valid)
    urdf.parent.mkdir(parents=True, exist_ok=True)
    brought(f"{beside}/{entry['urdf']}", urdf.parent)
    return load_robot(path)


def _hashed(place: str, model: RobotModel) -> tuple[FleetRobot, RobotModel]:
    """The robot with the hash of its file and of its URDF."""
    digest = hashlib.sha256(model.path.read_bytes())
    digest.update(hashlib.sha256(model.urdf.encode()).digest())
    return FleetRobot(place, digest.hexdigest()), model
