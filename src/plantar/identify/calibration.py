"""Mount of the IMU and polarity of the wrench channels, as Newton's law has them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pinocchio as pin

from plantar.conventions import TORQUE, WRENCH_AXES, Array
from plantar.errors import DataError
from plantar.identify.whole_body import Body, Calibration, Whole, carried, turned
from plantar.notes import Note

TILT_SAID = np.radians(1.0)  # a mount that is wrong by less is not mentioned
POLARITY_GAIN = 0.75  # a reversed channel must bring its row's misfit below this share, in both halves
POLARITY_LOSS = 1.05  # and may not raise any other row's above this one


def calibrate(body: Body, recordings: Sequence[Whole]) -> tuple[Calibration, list[Note]]:
    """Mount of the IMU and polarity of the wrench channels, from Newton's law with the CAD's parameters.

    The mean force of the ground lies along the mean proper acceleration: the smallest rotation that makes it so is the
    IMU's tilt. A torque channel that contradicts Newton as recorded and agrees when reversed is read reversed. Both
    are said in a note.
    """
    level = Calibration(np.eye(3))
    predicted = [
        body.equation.inverse_dynamics(one.motion, body.prior.cad)[:6, one.valid] for one in recordings
    ]
    measured = [carried(body, one, level)[:6, one.valid] for one in recordings]
    notes: list[Note] = []
    a, b = (np.hstack(rows)[:3].mean(axis=1) for rows in (predicted, measured))
    if min(np.linalg.norm(a), np.linalg.norm(b)) < 1e-3 * np.linalg.norm(a):
        raise DataError("the feet carry nothing: no ground wrench to explain (valid: a robot that stands)")
    rotation = pin.Quaternion.FromTwoVectors(a, b).toRotationMatrix()
    angle = pin.log3(rotation)
    if np.linalg.norm(angle) > TILT_SAID:
        about = ", ".join(f"{value:.2f}" for value in np.degrees(angle))
        text = (
            "the ground's mean force is not along the IMU's mean acceleration: taken as a tilt of the IMU's mount by "
            f"({about}) deg about the root link's x, y, z; mend the robot file's imu.rpy or the force sensors' zeros"
        )
        notes.append(Note("imu_tilt", "warning", text))
    calibration = Calibration(rotation)
    reversed_channel = _reversed_channel(body, recordings, calibration)
    if reversed_channel is not None:
        channel, before, after = reversed_channel
        row = WRENCH_AXES[channel]
        text = (
            f"{row} of the wrench sensors contradicts Newton's law as recorded: the CAD misses the ground's {row} "
            f"by {before:.3g}, and by {after:.3g} with the sign reversed. It is read reversed here; "
            "check the sensors' axes"
        )
        notes.append(Note("wrench_polarity", "warning", text))
        calibration = replace(calibration, reversed_channels=(channel,))
    return calibration, notes


def _reversed_channel(
    body: Body, recordings: Sequence[Whole], calibration: Calibration
) -> tuple[int, float, float] | None:
    """The torque channel that fits the CAD's prediction better reversed; its row's misfit before and after."""
    predicted = np.hstack(
        [
            body.equation.inverse_dynamics(turned(one.motion, calibration.rotation), body.prior.cad)[
                :6, one.valid
            ]
            for one in recordings
        ]
    )

    def misfit(channels: tuple[int, ...]) -> tuple[Array, Array]:
        tried = replace(calibration, reversed_channels=channels)
        measured = np.hstack([carried(body, one, tried)[:6, one.valid] for one in recordings])
        error = measured - predicted
        error = error - error.mean(axis=1, keepdims=True)
        half = error.shape[1] // 2
        parts = np.array([np.sqrt(np.mean(part**2, axis=1)) for part in (error[:, :half], error[:, half:])])
        return parts, np.sqrt(np.mean(error**2, axis=1))

    parts, before = misfit(())
    best = None
    for channel in range(TORQUE.start, TORQUE.stop):
        tried, after = misfit((channel,))
        clear = np.all(tried[:, channel] < POLARITY_GAIN * parts[:, channel])
        if clear and np.all(after < POLARITY_LOSS * before) and (best is None or after.sum() < best[3]):
            best = (channel, float(before[channel]), float(after[channel]), float(after.sum()))
    return None if best is None else best[:3]
