"""How high a bush sits, as torque and force of its foot show it.

A spring's torque follows its deflection; about a point that lies a height dz from the bush's centre the torque also
follows the horizontal force, by dz·F_x in pitch and -dz·F_y in roll. Every foot and axis gives dz by itself: where they
do not agree, as on stiff feet or in walking, the logs do not tell.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.conventions import FORCE, ROTATIONAL_AXES, Array
from plantar.errors import PlantarError
from plantar.feet.coherent_band import coherent_band
from plantar.feet.prepare_log import checked, prepare
from plantar.feet.recording import Recording, filtered_recording
from plantar.feet.settings import DEFAULT_CUTOFF
from plantar.logs.motion_log import MotionLog
from plantar.robot.model import RobotModel
from plantar.signals.filters import low_pass

FEWEST_SAMPLES = 200  # of loaded feet: a height is a fit's, which fewer do not carry
AGREE = 0.015  # m: standard deviation of the heights that feet and axes give, beyond which none is believed
FEWEST_HEIGHTS = 3  # of feet and axes: of two nobody knows which is wrong
LEAST_SPREAD = 0.01  # m: a loaded bush sinks by millimetres, and its centre with it
EXPLAINED = 0.05  # of the torque's variance at most is left by a spring and damper about a bush that is one


def bush_shift(robot: RobotModel, logs: Sequence[MotionLog]) -> tuple[float, float] | None:
    """How much higher the bushes sit than the robot file says, and its spread [m], as far as sensors sit as it says.

    None where the logs do not tell.
    """
    recordings = []
    for log in logs:
        try:
            recordings.append(prepare(robot, checked(robot, log), "fit"))
        except PlantarError:
            return None  # what is wrong with the log is said where it is checked
    cutoff = min(DEFAULT_CUTOFF, coherent_band(recordings))
    recordings = [filtered_recording(recording, cutoff) for recording in recordings]
    heights = [
        height
        for foot in robot.feet
        for axis in range(len(ROTATIONAL_AXES))
        if (height := _height(recordings, foot, axis)) is not None
    ]
    if len(heights) < FEWEST_HEIGHTS or np.std(heights) > AGREE:
        return None
    return float(np.median(heights)), max(2 * float(np.std(heights)), LEAST_SPREAD)


def _height(recordings: Sequence[Recording], foot: str, axis: int) -> float | None:
    """dz of one foot by one axis from torque = K·deflection + C·rate + dz·force + a·load + an offset a recording."""
    sign = (1.0, -1.0)[axis]
    rows, torques = list[Array](), list[Array]()
    for recording in recordings:
        bush, used = recording.bushes[foot], recording.used(foot)
        force = low_pass(bush.wrench[:, FORCE], recording.period, recording.cutoff)
        columns = [bush.deflection[:, axis], bush.rate[:, axis], sign * force[:, axis], force[:, 2]]
        table = np.column_stack([*columns, bush.torque[:, axis]])
        table = table[used & np.isfinite(table).all(axis=1)]
        if len(table):
            table = table - table.mean(axis=0)
            rows.append(table[:, :-1])
            torques.append(table[:, -1])
    if sum(map(len, rows)) < FEWEST_SAMPLES:
        return None
    matrix, torque = np.concatenate(rows), np.concatenate(torques)
    scale = matrix.std(axis=0) + 1e-12
    found, _, rank, _ = np.linalg.lstsq(matrix / scale, torque, rcond=1e-6)
    left = torque - matrix / scale @ found
    if rank < matrix.shape[1] or found[0] <= 0 or np.var(left) > EXPLAINED * np.var(torque):
        return None
    return float(found[2] / scale[2])
