"""What Newton's law says against the sensors: the IMU's mount, and channels of the wrench sensors.

Two faults of a wrench sensor can be told from a wrong CAD, since the base's motion and the CAD give the ground's whole
wrench: a torque channel of the wrong sign, and a force channel that holds a share of a torque (crosstalk). Both spoil
several rows of the base wrench at once, because a wrong lateral force stands half a metre below the base. Of all such
explanations the one that leaves least is taken, and only if it is clear in both halves of the data.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from plantar.conventions import FORCE, GRAVITY, TORQUE, WRENCH_AXES, Array
from plantar.errors import DataError
from plantar.notes import Note
from plantar.whole_body.dataset import Body, Whole
from plantar.whole_body.equations import Calibration, carried, foot_wrenches, turned

TILT_SAID = np.radians(1.0)  # a mount that is wrong by less is not mentioned
CLEAR_GAIN = 0.75  # a mended channel must bring its row's misfit below this share, in both halves
HARMLESS = 1.05  # and may not raise any other row's above this one
LEAST_MISFIT = 0.02  # of the weight: smaller misfits of a force may be the CAD's or the IMU's
NO_MISFIT = 1e-6  # N, N.m: a robot that does not move at all leaves none
MENDED_AT_MOST = 3  # channels; a sensor with more faults than that is not to be mended here


def calibrate(
    body: Body, recordings: Sequence[Whole], *, as_recorded: bool
) -> tuple[Calibration, list[Note]]:
    """Mount of the IMU and faults of the wrench channels, from Newton's law with the CAD's parameters.

    The mean force of the ground lies along the mean proper acceleration: the smallest rotation that makes it so is the
    IMU's tilt. A channel that contradicts Newton and agrees when mended is read mended, or only named where wrenches
    are to be taken `as_recorded`. Everything is said in a note.
    """
    calibration = _levelled(body, recordings, {})
    mended, notes = calibration, []
    for _ in range(MENDED_AT_MOST):
        fault = _worst_fault(body, recordings, mended)
        if fault is None:
            break
        mended = _levelled(body, recordings, fault.sensors)
        said = "left as recorded" if as_recorded else "corrected here, and scored so"
        notes.append(Note(fault.code, "warning", f"{fault.text}; {said}"))
    calibration = calibration if as_recorded else mended
    angle = pin.log3(calibration.rotation)
    if np.linalg.norm(angle) > TILT_SAID:
        about = ", ".join(f"{value:.2f}" for value in np.degrees(angle))
        text = (
            "the ground's mean force is not along the IMU's mean acceleration: taken as a tilt of the IMU's mount by "
            f"({about}) deg about the root link's x, y, z; correct the robot file's imu.rpy or the force sensors' zeros"
        )
        notes.append(Note("imu_tilt", "warning", text))
    return calibration, notes


def _levelled(body: Body, recordings: Sequence[Whole], sensors: Mapping[str, Array]) -> Calibration:
    """The smallest rotation that lays the mean proper acceleration along the ground's mean force."""
    calibration = Calibration(np.eye(3), sensors)
    predicted = np.hstack(
        [body.equation.inverse_dynamics(one.motion, body.prior.cad)[:3, one.valid] for one in recordings]
    ).mean(axis=1)
    measured = np.hstack([carried(body, one, calibration)[:3, one.valid] for one in recordings]).mean(axis=1)
    if np.linalg.norm(measured) < 1e-3 * np.linalg.norm(predicted):
        raise DataError("the feet carry nothing: no ground wrench to explain (valid: a robot that stands)")
    return Calibration(pin.Quaternion.FromTwoVectors(predicted, measured).toRotationMatrix(), sensors)


@dataclass(frozen=True)
class _Fault:
    """A channel's fault, what mends it, and what is left of the misfit (sum over the rows' logarithms)."""

    code: str
    text: str
    sensors: Mapping[str, Array]
    left: float


def _worst_fault(body: Body, recordings: Sequence[Whole], calibration: Calibration) -> _Fault | None:
    """The fault whose mending leaves least, if it is clear."""
    predicted = np.hstack(
        [
            body.equation.inverse_dynamics(turned(one.motion, calibration.rotation), body.prior.cad)[
                :6, one.valid
            ]
            for one in recordings
        ]
    )
    error = np.hstack([carried(body, one, calibration)[:6, one.valid] for one in recordings]) - predicted
    before, parts = _misfit(error)
    found = []
    for channel, text, changes, shares in (
        *_reversals(body, calibration),
        *_crosstalks(body, recordings, calibration, error, before),
    ):
        tried = Calibration(calibration.rotation, changes)
        after, tried_parts = _misfit(
            np.hstack([carried(body, one, tried)[:6, one.valid] for one in recordings]) - predicted
        )
        clear = np.all(tried_parts[:, channel] < CLEAR_GAIN * parts[:, channel])
        large = channel in range(TORQUE.start, TORQUE.stop) or (
            before[channel] > LEAST_MISFIT * GRAVITY * body.robot.mass
        )
        if clear and large and np.all(after < HARMLESS * before):
            name = WRENCH_AXES[channel]
            text = (
                f"{name} of the wrench sensors contradicts Newton's law as recorded: the URDF's masses miss it by "
                f"{before[channel]:.3g} {'N' if name.startswith('force') else 'N.m'} rms, and by "
                f"{after[channel]:.3g} {text}"
            )
            code = "wrench_crosstalk" if shares else "wrench_polarity"
            found.append(_Fault(code, text, changes, float(np.log(after / before).sum())))
    return min(found, key=lambda fault: fault.left, default=None)


Candidate = tuple[int, str, Mapping[str, Array], bool]


def _reversals(body: Body, calibration: Calibration) -> Iterator[Candidate]:
    for channel in range(TORQUE.start, TORQUE.stop):
        change = np.eye(6)
        change[channel, channel] = -1.0
        sensors = {foot: change @ calibration.sensor(foot) for foot in body.robot.feet}
        yield channel, "with the sign reversed; check the sensors' axes", sensors, False


def _crosstalks(
    body: Body, recordings: Sequence[Whole], calibration: Calibration, error: Array, scale: Array
) -> Iterator[Candidate]:
    """For each force and torque: the share of the torque that each foot's force should lose."""
    feet = tuple(body.robot.feet)
    target = (error - error.mean(axis=1, keepdims=True)) / scale[:, None]
    for force in range(FORCE.start, FORCE.stop):
        for torque in range(TORQUE.start, TORQUE.stop):
            columns = []
            for foot in feet:
                parts = []
                for one in recordings:
                    leak = {name: np.zeros_like(wrench) for name, wrench in one.wrenches.items()}
                    leak[foot][:, force] = foot_wrenches(body, one, calibration)[foot][:, torque]
                    parts.append(carried(body, one, calibration, leak)[:6, one.valid])
                column = np.hstack(parts)
                columns.append(((column - column.mean(axis=1, keepdims=True)) / scale[:, None]).ravel())
            shares = np.linalg.lstsq(np.column_stack(columns), target.ravel(), rcond=None)[0]
            sensors = {}
            for foot, share in zip(feet, shares, strict=True):
                change = np.eye(6)
                change[force, torque] = -share
                sensors[foot] = change @ calibration.sensor(foot)
            said = ", ".join(f"{foot} {share:.2g}" for foot, share in zip(feet, shares, strict=True))
            text = f"without {said} N per N.m of {WRENCH_AXES[torque]}: crosstalk; calibrate the sensors"
            yield force, text, sensors, True


def _misfit(error: Array) -> tuple[Array, Array]:
    """Rms of every row about its mean: (6,), and over the two halves, (2, 6); never below the least that counts."""
    error = error - error.mean(axis=1, keepdims=True)
    half = error.shape[1] // 2
    parts = np.array([np.sqrt(np.mean(part**2, axis=1)) for part in (error[:, :half], error[:, half:])])
    return np.maximum(np.sqrt(np.mean(error**2, axis=1)), NO_MISFIT), np.maximum(parts, NO_MISFIT)
