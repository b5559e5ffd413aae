"""One log made ready: checked, on an even grid, its bush states, contacts and stances found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from plantar.contact.deflection import BushState, foot_motions, loaded
from plantar.contact.imu_turn import imu_turn_effects
from plantar.contact.phases import FootContact, carried_weight, detect_contact, hoisted_note, shaken
from plantar.contact.reasons import Reason
from plantar.contact.stances import Stances, stances_of, without_rolling
from plantar.conventions import FORCE, GRAVITY, Array, Mask
from plantar.errors import RobotError
from plantar.faults.gyroscope import BY_LEANS, beside_leans
from plantar.faults.imu import ACCELEROMETER_UNIT, without_odd_accelerometer
from plantar.faults.log_faults import check_log, finding_notes, refuse_impossible
from plantar.feet.recording import Recording, Role
from plantar.feet.settings import DEFAULT_CUTOFF
from plantar.logs.freed_memory import return_freed
from plantar.logs.motion_log import MotionLog
from plantar.logs.stretches import most_moving
from plantar.notes import Finding, Note, listing
from plantar.robot.model import Imu, RobotModel, check_feet
from plantar.sensors.air_zero import LOADED, AirZero, air_zero
from plantar.sensors.attitude_scale import AttitudeScale, log_attitude_scale
from plantar.sensors.newton_euler import held_for_a_while
from plantar.sensors.tilt_error import NO_TILT_ERROR, TiltError, right_attitude
from plantar.signals.dropouts import without_dropouts
from plantar.signals.filters import differentiate, low_pass
from plantar.signals.heading import with_one_heading
from plantar.signals.held import without_held
from plantar.signals.orientation import attitude
from plantar.signals.resampling import evenly_sampled, is_even, without_holes
from plantar.signals.spikes import without_spikes
from plantar.signals.thinning import thinned

# Samples: with fewer, threads mostly hand Python's lock to each other; with more, copies of the process hold much.
LONG = 50_000
VELOCITY_BAND = 4.0  # times the fit's cutoff, up to which joint angles are differentiated
CONTACT_BAND = 2.0  # times the fit's cutoff, up to which a force tells landing from lifting
FEWEST_READINGS = 10  # of a force sensor in a stance: fewer miss how its torque changes
LIFTED = 0.05  # of a sole's length: a bush that is let go rises by less, and steps rise higher
# Of putting a tilted attitude right: a sole is flat below its bush however wrong it is, and crouching changes the IMU's
# height, so that one round leaves some percent of the tilt.
TILT_ROUNDS = 3
WEIGHT_MISMATCH = 0.15  # share by which the feet may carry more or less than the model weighs


def checked(robot: RobotModel, log: MotionLog, findings: Sequence[Finding] | None = None) -> MotionLog:
    """The log on an even grid, without held samples, dropouts and spikes, oddities as notes; of a long one what moves.

    findings: of `check_log`, where that has been asked already.

    Raises RobotError without IMU or feet in the robot file, LogError for a missing column, DataError where a sensor
    reads something impossible (degrees for radians, a flipped sign, swapped feet; see `faults`).
    """
    imu = _require(robot)
    log = most_moving(log, {foot.wrench.name for foot in robot.feet.values()})
    even: MotionLog | None = None
    # Its samples are put right while it is checked; where time is wrong, an even grid could take any memory.
    if len(log) > LONG and findings is None and is_even(log):
        with ThreadPoolExecutor(1) as pool:
            pending = pool.submit(_even, log)
            findings = check_log(robot, log)
            even = pending.result()
    else:
        findings = check_log(robot, log) if findings is None else findings
    refuse_impossible(log, findings)
    if log.orientation(imu.name) is None:  # feet need to know where up is
        refuse_impossible(log, [replace(one, fatal=one.code == ACCELEROMETER_UNIT) for one in findings])
    odd = finding_notes(log, findings)
    return_freed(log.size)
    even = without_odd_accelerometer(imu.name, even or _even(log))
    return even.with_columns({}, *log.joint_notes(robot), *odd)


def _even(log: MotionLog) -> MotionLog:
    """The log on an even grid, without held samples, dropouts, spikes and jumps of a heading."""
    whole = with_one_heading(without_held(without_dropouts(evenly_sampled(log))))
    return thinned(without_spikes(without_holes(whole)))


def prepare(
    robot: RobotModel,
    log: MotionLog,
    role: Role,
    own_tilt: TiltError = NO_TILT_ERROR,
    tilt_error: TiltError = NO_TILT_ERROR,
    highest_cutoff: float = DEFAULT_CUTOFF,
) -> Recording:
    """Bush states, contacts and stances of every foot in a `checked` log whose sensors were read together; unfiltered.

    own_tilt, tilt_error: of the attitude towards the accelerometer, from this log and from all of this IMU;
    highest_cutoff: of the filter that the fit may use [Hz].
    """
    imu = _require(robot)
    notes = list(log.notes)
    velocities = _velocities(robot, log, VELOCITY_BAND * highest_cutoff, notes)
    orientation, rates = attitude(log, imu, notes)
    positions = log.positions(robot)
    wrenches = {name: log.wrench(foot.wrench.name) for name, foot in robot.feet.items()}
    motions = foot_motions(robot, positions, velocities, orientation, rates)
    raw = loaded(robot, motions, wrenches)
    zeros = _air_zeros(robot, log, wrenches, raw)
    if zeros:
        wrenches = wrenches | {name: wrenches[name] - zero.at(log.time) for name, zero in zeros.items()}
        raw = loaded(robot, motions, wrenches)
        notes += [
            Note("air_zero", "info", f"{log.name}: {name} foot: {zero.text}") for name, zero in zeros.items()
        ]
    contacts, stances = _contacts(robot, log, raw, CONTACT_BAND * highest_cutoff, notes)
    places = {name: state.sole_position[:, :2] for name, state in raw.items()}
    for _ in range(TILT_ROUNDS):
        right = right_attitude(log, imu, orientation, (own_tilt, tilt_error), raw, contacts)
        if right is None:
            break
        orientation = right[0]
        motions = foot_motions(robot, positions, velocities, orientation, rates)
        raw = loaded(robot, motions, wrenches)
    scale = AttitudeScale()
    if right is None:
        scale = log_attitude_scale(log, imu, orientation, raw, contacts)
    else:
        notes.append(right[1])
    if noted := BY_LEANS & {note.code for note in notes}:
        # What was said of the sensors as recorded is said of them as they are used.
        left = [one for one in beside_leans(imu.name, log, orientation) if one.code in noted]
        notes = [note for note in notes if note.code not in noted] + finding_notes(log, left)
    return Recording(
        log=log,
        role=role,
        cutoff=np.inf,
        raw=raw,
        bushes=raw,
        contacts=contacts,
        stances=stances,
        noise={name: np.zeros((2, 2)) for name in raw},
        places=places,
        notes=tuple(notes),
        imu_turns=imu_turn_effects(motions),
        encoder_rates={name: motion.encoder_rate for name, motion in motions.items()},
        attitude_scale=scale,
        zeros=tuple(row for name, zero in zeros.items() for row in zero.rows(log.name, name)),
    )


def _air_zeros(
    robot: RobotModel, log: MotionLog, wrenches: Mapping[str, Array], raw: Mapping[str, BushState]
) -> dict[str, AirZero]:
    """The zeros that sensors show while their feet swing; of feet that do not swing none."""
    weight, found = robot.mass * GRAVITY, {}
    for name, foot in robot.feet.items():
        zero = air_zero(log.time, wrenches[name], raw[name].force_z, weight, _lifted(robot, raw, name))
        if zero is not None and foot.contact != "always":
            found[name] = zero
    return found


def _lifted(robot: RobotModel, raw: Mapping[str, BushState], foot: str) -> Mask:
    """Where a sole is clearly above that of another foot which carries the robot, and above where it stood when it
    carried it itself, as on a step, (N,)."""
    state, carried = raw[foot], LOADED * robot.mass * GRAVITY
    clear = LIFTED * float(np.ptp(robot.feet[foot].sole.polygon, axis=0).max())
    found = np.zeros(len(state.force_z), dtype=bool)
    for name, other in raw.items():
        if name != foot:
            above = state.sole_position[:, 2] - other.sole_position[:, 2]
            stood = above[(state.force_z > carried) & np.isfinite(above)]
            level = max(0.0, float(stood.min())) if stood.size else 0.0
            found |= (above > clear + level) & (other.force_z > carried)
    return found


def _require(robot: RobotModel) -> Imu:
    check_feet(robot)
    if robot.imu is None:
        message = "names no imu: bush angles need the direction of gravity"
        raise RobotError(message, path=robot.path, valid="imu: {name: ..., link: ...}")
    return robot.imu


def _velocities(robot: RobotModel, log: MotionLog, band: float, notes: list[Note]) -> Array:
    """Joint velocities (N, n_joints), differentiated from the positions; 0 for joints off the feet's paths.

    Recorded velocities are used only where there is no position: a controller's own filter makes them late, and that
    goes straight into the damping; coarse steps make small ones vanish.
    """
    velocities = np.zeros((len(log), len(robot.joint_names)))
    missing, whole = [], dict[int, Array]()
    for place, name in enumerate(robot.joint_names):
        if name not in robot.path_joints:
            continue
        position, recorded = log.joint(name, "position"), log.joint(name, "velocity")
        if position is not None and np.isfinite(position.sum()):
            whole[place] = position
            continue
        if position is not None:  # it has its own holes
            velocities[:, place] = differentiate(low_pass(position, log.period, band), log.period)
            continue
        missing.append(name)
        if recorded is not None:
            velocities[:, place] = recorded
    if whole:
        smooth = low_pass(np.column_stack([*whole.values()]), log.period, band)
        velocities[:, [*whole]] = differentiate(smooth, log.period)
    if missing:
        names = ", ".join(missing)
        where = f"{log.name}: between IMU and feet, but not recorded: {names}"
        text = f"{where}; angles are right only if these joints stayed at 0"
        joints = {column[6:].rpartition(".")[0] for column in log.columns if column.startswith("joint.")}
        if strangers := sorted(joints - set(robot.joint_names)):
            text += f". The log has {listing(strangers, 3)}, which the URDF has not: if one is meant, write in the "
            text += "robot file joint_names: {renamed: {URDF's joint: log's joint}}"
        notes.append(Note("path_joint_missing", "warning", text))
    return velocities


def _contacts(
    robot: RobotModel, log: MotionLog, bushes: Mapping[str, BushState], band: float, notes: list[Note]
) -> tuple[dict[str, FootContact], dict[str, Stances | None]]:
    """Phases from the vertical forces, and the stances of feet that step; of those that do not impacts are left out."""
    force = {name: low_pass(state.force_z, log.period, band) for name, state in bushes.items()}
    always = {name: foot.contact == "always" for name, foot in robot.feet.items()}
    carried, model_weight = carried_weight(force), robot.mass * GRAVITY
    if not any(always.values()) and abs(carried - model_weight) > WEIGHT_MISMATCH * model_weight:
        whose = "the URDF weighs" if robot.weighed is None else "the robot was weighed as"
        text = f"{log.name}: the feet carry {carried / GRAVITY:.1f} kg where {whose} {robot.mass:.1f} kg"
        notes.append(Note("weight", "warning", text))
    if (held := held_for_a_while(robot, log)).any():
        notes.append(hoisted_note(log.name, log.time, held, "no delay is looked for there"))
    weight = carried if carried > 0.3 * model_weight else model_weight
    contacts = detect_contact(force, always, weight, log.period)
    stances = {name: stances_of(contacts[name], force[name], weight, log.period) for name in bushes}
    for name, state in bushes.items():
        # Zeroed under load, its force is no share of the weight; a foot that steps strikes the floor by nature.
        found = stances[name]
        if found is not None:
            read = found.readings(log.wrench(robot.feet[name].wrench.name))
            if read < FEWEST_READINGS:
                text = f"{log.name}: {name} foot: its force sensor reads {read:.0f} values in a usual stance"
                valid = f"valid: {FEWEST_READINGS} or more; record faster, or walk slower"
                notes.append(Note("sparse_stances", "warning", f"{text} ({valid})"))
            stances[name] = without_rolling(found, state.cop, robot.feet[name].sole.polygon)
        elif not always[name]:
            impacts = shaken(state.wrench[:, FORCE], weight, log.period)
            contacts[name] = contacts[name].without(impacts, Reason.IMPACT)
    return contacts, stances
