"""What joints have to hold while a robot moves slowly: its weight, less what the ground carries."""

from __future__ import annotations

import numpy as np
import pinocchio as pin

from plantar.contact.balance import soles_in_root
from plantar.conventions import GRAVITY, Array
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel

EVERY = 20  # samples at the replay's 200 Hz: slow torques need no more


def holding_torques(robot: RobotModel, log: MotionLog) -> Array:
    """Joint torques (N, n_joints) [N·m] that keep the robot still at each sample, in the order of its joints.

    τ = g(q) - Σ Jᵀ F over the feet's recorded wrenches F. Up is where the soles have it, flat on the floor: what the
    bushes lean, a degree or two, changes these torques by a few per cent.
    """
    model = robot.model.copy()
    data = model.createData()
    positions = log.positions(robot)
    seats = {name: robot.frame(foot.wrench.placement) for name, foot in robot.feet.items()}
    read = {
        name: foot.wrench.sign * np.nan_to_num(log.wrench(foot.wrench.name))
        for name, foot in robot.feet.items()
    }
    rows = np.append(np.arange(0, len(log) - 1, EVERY), len(log) - 1)
    still, held = np.zeros(model.nv), np.empty((len(rows), len(robot.joint_names)))
    for place, row in enumerate(rows):
        soles = soles_in_root(robot, positions[row])
        up = np.mean([pose[:3, 2] for pose in soles.values()], axis=0)
        model.gravity.linear = -GRAVITY * up / np.linalg.norm(up)
        carried = pin.StdVec_Force()
        carried.extend(pin.Force.Zero() for _ in range(model.njoints))
        for name, (joint, seat) in seats.items():
            carried[joint] += seat.act(pin.Force(read[name][row]))
        held[place] = pin.rnea(model, data, robot.configuration(positions[row]), still, still, carried)
    time = log.time
    return np.column_stack([np.interp(time, time[rows], column) for column in held.T])
