"""What logs show of a standing robot: some samples in which its feet carry it, with the poses that the joints give."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from plantar.conventions import FORCE, GRAVITY, Array, Mask, rotation_from_quaternion
from plantar.feet.interval_width.force_gain import CARRIED
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.robot.kinematics import KinematicTree, centre_of_mass
from plantar.robot_guess.feet import Sole
from plantar.signals.filters import low_pass
from plantar.signals.segments import spread_out

SAMPLES = 400  # of one log: gravity, balance and outline change slowly
FEWEST = 20  # samples of a robot that stands, or of a foot that is loaded: fewer say nothing of how
SHARES = 0.15  # of the weight on a foot that takes part
CALM = 1.0  # Hz: what an accelerometer reads below this is mostly gravity


@dataclass(frozen=True)
class Stance:
    """Samples (n) of a robot that stands, all logs together, in the axes of its root link.

    rotations, places: of each foot's ankle link, (n, 3, 3) and (n, 3) [m]; centre: of mass, (n, 3) [m];
    up: by the soles that are loaded, flat on level ground, (n, 3); loaded: each foot, (n,);
    logs: the number of each sample's log, (n,);
    wrenches: of each foot as recorded, (n, 6); felt: up in the IMU's axes, (n, 3), None without IMU; carriers: pose of
    every link asked for, (n, 4, 4).
    """

    rotations: Mapping[str, Array]
    places: Mapping[str, Array]
    centre: Array
    up: Array
    loaded: Mapping[str, Mask]
    wrenches: Mapping[str, Array]
    felt: Array | None
    carriers: Mapping[str, Array]
    logs: NDArray[np.intp]

    @property
    def double(self) -> Mask:
        """Samples in which every foot takes part."""
        return np.asarray(np.all(list(self.loaded.values()), axis=0))


def find_stance(
    model: pin.Model,
    soles: Sequence[Sole],
    sensors: Mapping[str, str],
    imu: str | None,
    links: Sequence[str],
    logs: Sequence[MotionLog],
) -> Stance | None:
    """The samples of all logs in which the feet carry the robot; None where there are too few.

    sensors: of each side, the name of its force sensor; imu: its name; links: whose poses are wanted.
    """
    weight = float(sum(inertia.mass for inertia in model.inertias)) * GRAVITY
    chosen = [_rows(log, sensors, imu, weight, model) for log in logs]
    count = sum(len(rows) for rows in chosen)
    if count < FEWEST or not soles:
        return None
    stacked = [
        {side: log.wrench(name)[rows] for side, name in sensors.items()}
        for log, rows in zip(logs, chosen, strict=True)
    ]
    wrenches = {side: np.concatenate([each[side] for each in stacked]) for side in sensors}
    felt = None
    if imu is not None:
        felt = np.concatenate([felt_up(log, imu)[rows] for log, rows in zip(logs, chosen, strict=True)])
    positions = np.concatenate([_positions(model, log, rows) for log, rows in zip(logs, chosen, strict=True)])
    ankles = [sole.limb.link for sole in soles]
    poses, centre = _poses(model, positions, [*ankles, *links])
    loaded = {side: np.linalg.norm(w[:, FORCE], axis=1) > SHARES * weight for side, w in wrenches.items()}
    up = np.zeros((count, 3))
    for sole in soles:
        normal = poses[sole.limb.link][:, :3, :3] @ sole.upright[:, 2]
        up += normal * loaded[sole.limb.side][:, None]
    up /= np.maximum(np.linalg.norm(up, axis=1), 1e-9)[:, None]
    return Stance(
        {sole.limb.side: poses[sole.limb.link][:, :3, :3] for sole in soles},
        {sole.limb.side: poses[sole.limb.link][:, :3, 3] for sole in soles},
        centre,
        up,
        loaded,
        wrenches,
        felt,
        {link: poses[link] for link in links},
        np.repeat(np.arange(len(chosen)), [len(rows) for rows in chosen]),
    )


def felt_up(log: MotionLog, imu: str) -> Array:
    """The world's up in the IMU's axes, (N, 3), by its orientation or, without one, by its calm acceleration."""
    orientation = log.orientation(imu)
    if orientation is not None:
        norm = np.linalg.norm(orientation, axis=1)
        known = np.where((norm > 0.5)[:, None], orientation, np.nan)
        return np.asarray(rotation_from_quaternion(known)[:, 2, :])
    if not log.has_imu(imu, "linear_acceleration"):
        return np.full((len(log), 3), np.nan)
    calm = low_pass(log.linear_acceleration(imu), log.period, CALM)
    return np.asarray(calm / np.maximum(np.linalg.norm(calm, axis=1), 1e-9)[:, None])


def _rows(
    log: MotionLog, sensors: Mapping[str, str], imu: str | None, weight: float, model: pin.Model
) -> NDArray[np.int64]:
    columns = [column for name in sensors.values() for column in wrench_columns(name)]
    if not sensors or not log.has(*columns):
        return np.zeros(0, dtype=np.int64)
    wrenches = [log.wrench(name) for name in sensors.values()]
    whole = np.isfinite(np.column_stack(wrenches)).all(axis=1)
    if imu is not None:
        whole &= np.isfinite(felt_up(log, imu)).all(axis=1)
    for name in model.names:
        values = log.joint(name, "position")
        if values is not None:
            whole &= np.isfinite(values)
    force = sum(np.linalg.norm(np.nan_to_num(wrench[:, FORCE]), axis=1) for wrench in wrenches)
    return spread_out(np.flatnonzero(whole & (force > CARRIED * weight)), SAMPLES)


def _positions(model: pin.Model, log: MotionLog, rows: NDArray[np.int64]) -> Array:
    """Of the joints at some samples, 0 where they are not recorded, (n, n_joints)."""
    read = [log.joint(name, "position") for name in list(model.names)[1:]]
    return np.column_stack([np.zeros(len(rows)) if values is None else values[rows] for values in read])


def _poses(model: pin.Model, positions: Array, links: Sequence[str]) -> tuple[dict[str, Array], Array]:
    """Poses (n, 4, 4) of links and the centre of mass (n, 3), in the root link's axes."""
    rotations, places = KinematicTree.from_model(model).poses(positions)
    frames = np.tile(np.eye(4), (*places.shape[:2], 1, 1))
    frames[..., :3, :3], frames[..., :3, 3] = rotations, places
    found = [model.frames[model.getFrameId(link)] for link in links]
    poses = {
        link: frames[frame.parentJoint] @ frame.placement.homogeneous
        for link, frame in zip(links, found, strict=True)
    }
    return poses, centre_of_mass(model, rotations, places)
