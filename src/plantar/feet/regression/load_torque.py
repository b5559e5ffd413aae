"""Torque about a bush that is not the bush's: of the load on a centre beside its place, of a turned force sensor."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, Array, Axis, Mask
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit, FittedModel
from plantar.feet.regression.model_columns import memory_path, own_torque
from plantar.signals.filters import differentiate

ALL = slice(None)  # rows of a recording
# By which a centre that is higher turns a horizontal force into torque, of pitch and roll.
ACROSS = (1.0, -1.0)
# s: a device's own filter delays an IMU by as much at most, and encoders not at all; what looks later is another fault.
ENCODERS_APART = 0.005
LATER = 2e-4  # s, over which a memory's slope is taken: a small part of what makes it slip


def load_of(recording: Recording, foot: str) -> Array:
    """The vertical force through the fit's filter, (N,) [N], 0 where it is not known: where nothing is used."""
    return recording.loads(foot)[:, 2]


def moment_columns(recording: Recording, foot: str, axis: Axis, rows: Mask | slice) -> Array:
    """Torque (n, 2) for each metre by which the bush's centre is beside and above its place in the robot file.

    A centre that is dz higher takes dz·F_x off the pitch torque and adds dz·F_y to the roll torque; the compressed z
    slide is such a height. One that is aside adds a torque as large as the load.
    """
    column, loads = ROTATIONAL_AXES.index(axis), recording.loads(foot)[rows]
    return np.column_stack([loads[:, 2], ACROSS[column] * loads[:, column]])


def place_columns(recording: Recording, foot: str, axis: Axis, rows: Mask | slice = ALL) -> Array:
    """`moment_columns`, and the other axis' torque, which shows in this one where a sensor is turned, (n, 3)."""
    own = moment_columns(recording, foot, axis, rows)
    return np.column_stack([own, others_torque(recording, foot, axis, rows)])


def step_columns(recording: Recording, foot: str, axis: Axis, rows: Mask | slice = ALL) -> Array:
    """`place_columns`, the yaw torque, which shows where a sensor leans about the other axis, and the horizontal force
    that turns the other axis, which shows by crosstalk alone, (n, 5).

    A foot that steps turns the robot, and pushes it to all sides: these are as large as the others.
    """
    loads, along = recording.loads(foot)[rows], 1 - ROTATIONAL_AXES.index(axis)
    return np.column_stack([place_columns(recording, foot, axis, rows), loads[:, 3], loads[:, along]])


def others_torque(recording: Recording, foot: str, axis: Axis, rows: Mask | slice = ALL) -> Array:
    """The torque about the other axis, (n,) [N·m], 0 where it is not known."""
    return np.asarray(np.nan_to_num(recording.bushes[foot].torque[rows, 1 - ROTATIONAL_AXES.index(axis)]))


def late_encoder_torque(recording: Recording, fit: AxisFit) -> Array:
    """Torque (N,) for each second by which encoders are read later than the IMU, 0 where that is not known."""
    rates = recording.encoder_rates.get(fit.foot)
    if rates is None:
        return np.zeros(len(recording.time))
    return torque_of_angle(recording, fit, rates[:, ROTATIONAL_AXES.index(fit.axis)], LATER)


def torque_of_angle(recording: Recording, fit: AxisFit, change: Array, little: float) -> Array:
    """Torque (N,) for each unit of what changes the bush's angle by `change` (N,) [rad]; 0 where that is NaN.

    Beside spring and damper a memory follows the angle, too: until it slips it is a spring, over a `little` of it. Of a
    foot that steps it is left out, as are its states (`Tangent`).
    """
    torque = fit.values[0] * change + fit.values[1] * differentiate(change, recording.period)
    if len(fit.shape) and recording.stances[fit.foot] is None:
        path = memory_path(recording, fit)
        moved = [replace(path, deflection=path.deflection + by * change) for by in (-little, little)]
        torque += own_torque(recording, fit, moved, fit.shape[None]) @ [-0.5, 0.5] / little
    return np.asarray(np.nan_to_num(torque))


def load_torque(recording: Recording, fitted: FittedModel) -> Array:
    """The torque (N,) that is not the bush's: of the load on a centre beside its place, of a sensor that is turned."""
    place = fitted.place
    if not place.any():
        return np.zeros(len(recording.time))
    if not place[3:].any():  # as where a foot stands
        return np.asarray(place_columns(recording, fitted.foot, fitted.axis) @ place[:3])
    return np.asarray(step_columns(recording, fitted.foot, fitted.axis) @ place)


def yaw_torque(recording: Recording, foot: str) -> Array:
    """The torque about the bush's third axis, (N,) [N·m]."""
    return np.asarray(recording.bushes[foot].wrench[:, 5])


def across_force(recording: Recording, foot: str, column: int) -> Array:
    """The horizontal force that a higher centre turns into torque, (N,) [N], unfiltered."""
    return np.asarray(ACROSS[column] * recording.bushes[foot].wrench[:, column])


def along_force(recording: Recording, foot: str, column: int) -> Array:
    """The horizontal force that reaches a torque by crosstalk alone, (N,) [N], unfiltered."""
    return np.asarray(recording.bushes[foot].wrench[:, 1 - column])
