"""A log made ready for eq. 6: even samples, bush angles, rates and torques, contact, and what is left out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from plantar.checks.log_checks import check_log
from plantar.contact.deflection import BushState, bush_states
from plantar.contact.phases import IMPACT, NOT_RECORDED, FootContact, carried_weight, detect_contact, shaken
from plantar.conventions import FORCE, GRAVITY, Array, Mask
from plantar.errors import DataError, RobotError, located
from plantar.estimation.errors_in_variables import noise_after_filter
from plantar.feet.sensors.tilt_error import NO_TILT_ERROR, TiltError, right_attitude
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.notes import Note
from plantar.robot.model import Imu, RobotModel
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.orientation import attitude
from plantar.signals.resampling import evenly_sampled, without_holes
from plantar.signals.segments import run_ends
from plantar.signals.spikes import without_spikes

FILTER_EDGE = 1.0  # of the filter's period, left out where a run of samples begins or ends
WIDE_BAND = 4.0  # times the cutoff: filter of what is differentiated before the common filter
WEIGHT_MISMATCH = 0.15  # share by which the feet may carry more or less than the model weighs

Role = Literal["fit", "validate"]


@dataclass(frozen=True)
class Recording:
    """One log with each foot's bush state, as measured and filtered, and its contact. Arrays run over `time` (N,).

    `noise` (2, 2) of each foot: variance of white noise that is left in deflection and rate, of pitch and roll.
    `places` (N, 2) of each foot: of the sole from the IMU [m] in the attitude as recorded, which slides are judged by.
    """

    log: MotionLog
    role: Role
    cutoff: float
    raw: Mapping[str, BushState]
    bushes: Mapping[str, BushState]
    contacts: Mapping[str, FootContact]
    noise: Mapping[str, Array]
    places: Mapping[str, Array]
    notes: tuple[Note, ...]

    @property
    def name(self) -> str:
        return self.log.name

    @property
    def time(self) -> Array:
        return self.log.time

    @property
    def period(self) -> float:
        return self.log.period

    def used(self, foot: str) -> Mask:
        """Samples of this foot that serve."""
        return self.contacts[foot].used

    def without(self, foot: str, samples: Mask) -> Recording:
        """The same recording in which these samples of one foot do not serve; its own contact stays as it is."""
        contact = self.contacts[foot]
        less = FootContact(contact.support, contact.code.copy(), list(contact.reasons))
        less.leave_out(samples, "left aside")
        return replace(self, contacts={**self.contacts, foot: less})


def checked(robot: RobotModel, log: MotionLog) -> MotionLog:
    """The log on an even grid, with what is odd about it as notes.

    Raises RobotError without IMU or feet in the robot file, LogError for a missing column, DataError where a sensor
    reads something impossible (degrees for radians, a flipped sign, swapped feet; see `checks`).
    """
    _require(robot)
    findings = check_log(robot, log)
    problems = [finding for finding in findings if finding.fatal]
    if problems:
        raise DataError(located(problems[0].text, path=log.source))
    odd = [Note(found.code, found.severity, f"{log.name}: {found.text}") for found in findings]
    return without_spikes(without_holes(evenly_sampled(log))).with_columns({}, *log.joint_notes(robot), *odd)


def prepare(
    robot: RobotModel,
    log: MotionLog,
    role: Role,
    settings: FeetSettings,
    tilt_error: TiltError = NO_TILT_ERROR,
) -> Recording:
    """Bush states and contact of every foot in a `checked` log whose sensors were read together.

    pull: of the attitude towards the accelerometer, from all logs of this IMU.
    """
    imu = _require(robot)
    notes = list(log.notes)
    period = log.period
    velocities = _velocities(robot, log, settings.cutoff, notes)
    orientation, rates = attitude(log, imu, notes)
    wrenches = {name: log.wrench(foot.wrench.name) for name, foot in robot.feet.items()}
    raw = bush_states(robot, log.positions(robot), velocities, orientation, rates, wrenches)
    contacts = _contacts(robot, log, raw, settings, notes)
    places = {name: state.sole_position[:, :2] for name, state in raw.items()}
    if (right := right_attitude(log, imu, orientation, tilt_error, raw, contacts)) is not None:
        raw = bush_states(robot, log.positions(robot), velocities, right[0], rates, wrenches)
        notes.append(right[1])
    smooth = {name: filtered(state, period, settings.cutoff) for name, state in raw.items()}
    for name, state in smooth.items():
        valid = np.asarray(
            np.isfinite(np.column_stack([state.deflection, state.rate, state.torque])).all(axis=1)
        )
        contacts[name].leave_out(~valid, NOT_RECORDED)
        contacts[name].leave_out(
            run_ends(valid, round(FILTER_EDGE / settings.cutoff / period)), "filter's edge"
        )
    noise = {name: _noise(state, period, settings.cutoff) for name, state in raw.items()}
    return Recording(log, role, settings.cutoff, raw, smooth, contacts, noise, places, tuple(notes))


def _noise(state: BushState, period: float, cutoff: float) -> Array:
    """Variance (2, 2) of the noise left in deflection and rate (rows) of pitch and roll (columns)."""
    angles = np.hstack([state.deflection, state.rate])
    return noise_after_filter(angles, state.torque, period, cutoff).reshape(2, 2)


def _require(robot: RobotModel) -> Imu:
    if not robot.feet:
        raise RobotError(located("names no feet", path=robot.path, valid="feet: {left: ..., right: ...}"))
    if robot.imu is None:
        message = "names no imu: bush angles need the direction of gravity"
        raise RobotError(located(message, path=robot.path, valid="imu: {name: ..., link: ...}"))
    return robot.imu


def _velocities(robot: RobotModel, log: MotionLog, cutoff: float, notes: list[Note]) -> Array:
    """Joint velocities (N, n_joints), differentiated from the positions; 0 for joints off the feet's paths.

    Recorded velocities serve only where there is no position: a controller's own filter makes them late, and that goes
    straight into the damping; coarse steps make small ones vanish.
    """
    velocities = np.zeros((len(log), len(robot.joint_names)))
    missing = []
    needed = _path_joints(robot)
    for place, name in enumerate(robot.joint_names):
        if name not in needed:
            continue
        position, recorded = log.joint(name, "position"), log.joint(name, "velocity")
        if position is not None:
            velocities[:, place] = differentiate(
                low_pass(position, log.period, WIDE_BAND * cutoff), log.period
            )
            continue
        missing.append(name)
        if recorded is not None:
            velocities[:, place] = recorded
    if missing:
        names = ", ".join(missing)
        text = f"{log.name}: between IMU and feet, but not recorded: {names}; angles are right only if they stood at 0"
        notes.append(Note("path_joint_missing", "warning", text))
    return velocities


def _path_joints(robot: RobotModel) -> frozenset[str]:
    """The joints between the IMU and any foot."""
    imu = _require(robot).placement
    return frozenset().union(*(robot.joints_between(imu, foot.bush) for foot in robot.feet.values()))


def _contacts(
    robot: RobotModel,
    log: MotionLog,
    bushes: Mapping[str, BushState],
    settings: FeetSettings,
    notes: list[Note],
) -> dict[str, FootContact]:
    """Phases from the vertical forces, and impacts left out."""
    force = {name: low_pass(state.force_z, log.period, 2 * settings.cutoff) for name, state in bushes.items()}
    always = {name: foot.contact == "always" for name, foot in robot.feet.items()}
    carried, model_weight = carried_weight(force), robot.mass * GRAVITY
    if not any(always.values()) and abs(carried - model_weight) > WEIGHT_MISMATCH * model_weight:
        text = (
            f"{log.name}: the feet carry {carried / GRAVITY:.1f} kg where the URDF weighs {robot.mass:.1f} kg"
        )
        notes.append(Note("weight", "warning", text))
    weight = carried if carried > 0.3 * model_weight else model_weight
    contacts = detect_contact(force, always, weight, log.period)
    for name, state in bushes.items():
        if not always[name]:  # zeroed under load: its force is no share of the weight
            contacts[name].leave_out(shaken(state.wrench[:, FORCE], weight, log.period), IMPACT)
    return contacts


def filtered(state: BushState, period: float, cutoff: float) -> BushState:
    """The state with angles, rates and torques through one zero-phase filter: the law between them stays."""
    values = low_pass(np.column_stack([state.deflection, state.rate, state.torque]), period, cutoff)
    return replace(state, deflection=values[:, 0:2], rate=values[:, 2:4], torque=values[:, 4:6])


def moved_centre(recording: Recording, compliance: Mapping[str, float], cutoff: float) -> Recording:
    """The recording with torques about the bush's centre where its z slide has carried it.

    Under a load F_z the slide is compressed by z = compliance·F_z, so that pitch and roll turn about a point z higher
    in the ankle: torque' = torque - z e_z × force. Left out, K comes out too large by F_z²·compliance.
    """
    bushes = {
        foot: replace(
            bush, torque=bush.torque + compliance[foot] * moment_arm_effect(bush, recording.period, cutoff)
        )
        for foot, bush in recording.bushes.items()
    }
    return replace(recording, bushes=bushes)


def moment_arm_effect(bush: BushState, period: float, cutoff: float) -> Array:
    """Change of pitch and roll torque for each m/N of vertical compliance, (N, 2) [N·m per m/N], filtered alike."""
    x, y, z = bush.wrench[:, FORCE].T
    return low_pass(np.column_stack([-z * x, np.cos(bush.deflection[:, 0]) * z * y]), period, cutoff)
