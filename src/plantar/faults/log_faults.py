"""Sensors that read something impossible: units, signs, orders and channels checked before anything is fitted."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from plantar.conventions import GRAVITY
from plantar.errors import DataError, clock
from plantar.faults.air_readings import check_air_readings
from plantar.faults.bush_frames import check_bush_axes, check_bush_link
from plantar.faults.channels import check_channels, named
from plantar.faults.dead_band import DEAD_FORCE, check_dead_bands
from plantar.faults.gaps import check_gaps
from plantar.faults.imu import check_imu
from plantar.faults.joints.closed_chain import check_closed_chain
from plantar.faults.joints.names import check_joint_names, check_path_joints
from plantar.faults.joints.stepping_joints import check_stepping_joints
from plantar.faults.joints.still_joints import check_still_joints
from plantar.faults.load_signs import check_load_signs
from plantar.faults.standing import check_balance
from plantar.faults.torque_unit import LIKE
from plantar.logs.freed_memory import return_freed
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.logs.stretches import PERIODS
from plantar.notes import Finding, Note
from plantar.robot.model import RobotModel
from plantar.signals.held import coarse
from plantar.signals.resampling import sampling
from plantar.signals.thinning import picked

DEGREES = 180 / np.pi
FASTEST, SLOWEST = PERIODS
QUICKEST, USUAL = 5e-5, 0.05  # s between the samples of robots' logs: one unit alone puts them there
UNITS = {"ms": 1e3, "us": 1e6, "ns": 1e9}  # in a second
QUICK, MANY = 0.25, 0.02  # usual step over the mean one, and gaps over rows: fewer are rows that got lost
FORCE_UNITS = {"kgf": GRAVITY, "lbf": 4.4482, "kN": 1e3}  # N
# A robot on a rope, or one that hangs, may load its feet as little: told, not refused.
AS_HELD = ("lbf", "kN")
# Of the weight: a foot that carries so much on average does not stand alone.
LEAST_PART, MOST_PART = 0.2, 0.85
SHORTEST = 0.5  # s of a log from which anything can be said


def check_log(robot: RobotModel, log: MotionLog) -> list[Finding]:
    """Every finding about one log, in the order joint names, time, joints, IMU, wrenches, gaps, stuck channels, chain.

    Of a log whose time cannot be right only that is said: rates and seconds mean nothing.
    """
    names, time = check_joint_names(robot, log), list(_time(log))
    if any(finding.fatal for finding in time):
        return [*names, *time]
    few = picked(log)
    imu = list(check_imu(robot.imu.name, few)) if robot.imu is not None else ()
    return_freed(log.size)
    channels = [
        *check_gaps(robot, log),
        *check_channels(robot, log),
        *check_dead_bands(robot, log),
        *check_still_joints(robot, log),
        *check_stepping_joints(robot, log),
    ]
    chain, wrenches = list(check_closed_chain(robot, few)), list(_wrenches(robot, few))
    missing = check_path_joints(robot, log) if any(one.fatal for one in (*wrenches, *chain)) else ()
    bushes = [*check_bush_link(robot, few), *check_bush_axes(robot, few)]
    return [*names, *time, *_joints(robot, log), *imu, *missing, *bushes, *wrenches, *channels, *chain]


def refuse_impossible(log: MotionLog, findings: Sequence[Finding]) -> None:
    """Raise DataError with the first finding after which nothing can be said of the log."""
    fatal = next((finding for finding in findings if finding.fatal), None)
    if fatal is not None:
        raise DataError(fatal.text, path=log.source)


def finding_notes(log: MotionLog, findings: Sequence[Finding]) -> list[Note]:
    """Findings as notes that name the log."""
    return [Note(found.code, found.severity, f"{log.name}: {found.text}") for found in findings]


def _time(log: MotionLog) -> Iterator[Finding]:
    if not FASTEST < log.period < SLOWEST:
        text = f"column 'time': samples are {log.period:g} s apart; is it in another unit?"
        near = [unit for unit, count in UNITS.items() if QUICKEST <= log.period / count < USUAL]
        mend = [
            f"; `columns: {{time: {{from: time, unit: {unit}}}}}` in the robot file reads it" for unit in near
        ]
        valid = "valid: seconds" + "".join(mend)
        yield Finding("time_unit", f"{text} ({valid})", True)
    elif log.duration < SHORTEST:
        yield Finding(
            "too_short", f"column 'time': lasts {log.duration:g} s (valid: {SHORTEST:g} s or more)", True
        )
    elif log.period < QUICK * (mean := log.duration / len(log)) and len(sampling(log).gaps) > MANY * len(log):
        apart = f"usually {1e3 * log.period:.3g} ms apart, {1e3 * mean:.3g} ms on average"
        text = f"column 'time': rows come in bursts, {apart}"
        valid = "valid: the moment at which each row was measured; these look like moments of arrival"
        yield Finding("time_bursts", f"{text} ({valid})", True)


def _joints(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    model = robot.model
    for joint, name in enumerate(robot.joint_names, start=1):
        values = log.joint(name, "position")
        if values is None or not np.isfinite(values).any():
            continue
        lower, upper = (
            float(limit[model.idx_qs[joint]])
            for limit in (model.lowerPositionLimit, model.upperPositionLimit)
        )
        least, most = float(np.nanmin(values)), float(np.nanmax(values))
        bounded = model.nqs[joint] == 1 and np.isfinite([lower, upper]).all() and upper > lower
        revolute = "P" not in model.joints[joint].shortname().removeprefix("JointModel")[:1]
        if not bounded or not revolute:
            continue
        slack = 0.2 + 0.1 * (upper - lower)
        outside = least < lower - slack or most > upper + slack
        fits = least / DEGREES > lower - slack and most / DEGREES < upper + slack
        worst = most if most - upper > lower - least else least
        at = float(log.time[int(np.nanargmax(values if worst == most else -values))])
        where = f"column 'joint.{name}.position', t = {clock(at)} s, value {worst:.6g}"
        valid = f"valid: {lower:.4g} to {upper:.4g} rad"
        if outside and fits and max(abs(least), abs(most)) > 2 * np.pi:
            yield Finding("degrees", f"{where}: looks like degrees ({valid})", True)
        elif outside:
            yield Finding("joint_limit", f"{where}: beyond the URDF's limits ({valid})")


def _wrenches(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    loads, wrenches = {}, {}
    for foot in robot.feet.values():
        sensor = foot.wrench
        wrench = log.wrench(sensor.name)
        if not np.isfinite(wrench).any():
            yield Finding(
                "dead_channel", f"columns 'wrench.{sensor.name}.*': hold no value; the sensor is dead"
            )
            continue
        # Along the bush's z axis, whatever way the sensor is mounted, in whatever link.
        bush, placed = (robot.frame(each)[1].rotation for each in (foot.bush, sensor.placement))
        load = wrench[:, :3] @ (bush.T @ placed)[2] * sensor.sign
        if not np.isfinite(load).any():
            text = f"columns 'wrench.{sensor.name}.force.*': never hold a value together: the load is unknown"
            yield Finding("dead_channel", text)
            continue
        loads[foot.name], wrenches[foot.name] = load, wrench
        spans = np.array(
            [np.ptp(values[np.isfinite(values)]) if np.isfinite(values).any() else 0.0 for values in wrench.T]
        )
        alive = (
            spans.any() or np.nanmax(np.abs(wrench)) > 0.1 * robot.mass * GRAVITY or foot.contact == "always"
        )
        parts = wrench_columns(sensor.name)
        dead = [part for span, part in zip(spans, parts, strict=True) if alive and span == 0]
        # What hardly loads a coarse sensor stays within one of its steps.
        dead = [
            part for part in dead if not any(coarse(log.column(other)) for other in _of_its_kind(part, parts))
        ]
        if log.vertical_only(sensor.name):
            text = (
                f"columns 'wrench.{sensor.name}.*': vertical force cells, no horizontal force: the bush's torque is "
                "off by that force times the bush's height over the cells"
            )
            yield Finding("vertical_only", text)
        elif dead:
            text = (
                f"{named(dead, f'wrench.{sensor.name}.', len(parts))}: never change{'s' * (len(dead) == 1)}"
            )
            # The bush's torque is off by a force times the bush's height over the sensor.
            code = DEAD_FORCE if any(part != parts[-1] for part in dead) else "dead_channel"
            yield Finding(code, f"{text}; is the {'channel' if len(dead) == 1 else 'sensor'} dead?")
    yield from check_load_signs(robot, loads)
    yield from check_air_readings(robot, log.period, loads, wrenches)
    weight = robot.mass * GRAVITY
    automatic = bool(loads) and all(foot.contact == "auto" for foot in robot.feet.values())
    if automatic and len(loads) == len(robot.feet):
        together = np.sum(list(loads.values()), axis=0)
        together = together[np.isfinite(together)]
        carried = float(np.median(together)) if together.size else 0.0
        unit = _like_unit(carried / weight, len(loads))
        if unit is not None:
            text = f"columns 'wrench.*.force.z': the feet carry {carried:.4g}, which looks like {unit}"
            yield Finding("force_unit", f"{text} (valid: N, about {weight:.0f})", unit not in AS_HELD)
            if unit not in AS_HELD:
                return
        if len(loads) == 1 and LEAST_PART < float(together.mean()) / weight < MOST_PART:
            yield _foot_missing(next(iter(loads)), float(together.mean()) / GRAVITY, robot.mass)
        else:
            yield from check_balance(robot, log)


def _like_unit(share: float, feet: int) -> str | None:
    """The unit in which the feet carry all of the weight; one of two feet may carry as little as pounds look like."""
    near = [unit for unit, size in FORCE_UNITS.items() if 1 / LIKE < share * size < LIKE]
    return next((unit for unit in near if feet > 1 or unit != "lbf"), None)


def _foot_missing(foot: str, carried: float, mass: float) -> Finding:
    text = f"feet: the robot file names '{foot}' alone, which carries {carried:.3g} of {mass:.3g} kg: another"
    advice = "name it as well, if it has a force sensor: together they show delays and gains"
    return Finding("foot_missing", f"{text} foot stands, too; {advice}")


def _of_its_kind(column: str, columns: Sequence[str]) -> list[str]:
    """Which columns of a force sensor are forces, or torques, as this one is."""
    return [other for other in columns if other.rpartition(".")[0] == column.rpartition(".")[0]]
