"""Advice that fits these logs: nothing is asked for that they have already or that their sensors could not show."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from plantar.feet.assess.diagnosis import REMEDY
from plantar.feet.recording import Recording
from plantar.feet.settings import AUTOMATIC, FeetSettings
from plantar.results.feet import Diagnosis, Parameter
from plantar.robot.model import RobotModel
from plantar.sensors.delays.sensor_delay import SensorDelay, on_force_cells

SHOWS_DELAY: Final = {"linear_acceleration": "accelerometer", "angular_velocity": "gyroscope"}
LEAST_TOGETHER: Final = 30.0  # s, as long as the shift of the weight that is advised
NO_BETTER_MODEL: Final = (
    "more logs like these will not help, nor does any other model of the rubber that was tried: record other motions: "
    "slower or larger ones for the stiffness, faster ones for the damping"
)


def remedies(
    settings: FeetSettings, delay: SensorDelay, robot: RobotModel, recordings: Sequence[Recording]
) -> dict[str, str]:
    """By limit, the advice that takes the place of the general one: what these sensors can show, and what was tried."""
    found = {}
    if settings.model == AUTOMATIC:
        found["model"] = NO_BETTER_MODEL
    if robot.weighed is not None:
        found["force gain"] = "calibrate the force sensors, which the number follows: the robot was weighed"
    missing = _missing(robot, recordings)
    if on_force_cells(robot, [each.log for each in recordings]):
        found["delay"] = "measure how late the force cells are, and give it with --wrench-delay"
    elif missing:
        known = "or give a delay that is known with --wrench-delay"
        found["delay"] = (
            f"record the {missing} of the IMU: without it no log shows the force sensors' delay; {known}"
        )
    elif delay.measured and not delay.doubtful:
        better = "record arm sweeps at 0.3 to 1 Hz for longer"
        if any(guess.key == "imu" for guess in robot.guesses):  # the delay is found from what the IMU feels
            better = "measure where the IMU sits, which is marked GUESS"
        found["delay"] = f"{better}: these logs show the force sensors' delay, but not well"
    return found


def with_remedies(
    rows: Sequence[Parameter], diagnosis: Sequence[Diagnosis], found: Mapping[str, str]
) -> tuple[list[Parameter], list[Diagnosis]]:
    """Rows and diagnosis with the general advice replaced by the one in `found`."""
    instead = {REMEDY[limit]: advice for limit, advice in found.items()}
    return (
        [replace(row, advice=instead.get(row.advice or "", row.advice)) for row in rows],
        [
            replace(
                each, advice=instead[each.advice], text=each.text.replace(each.advice, instead[each.advice])
            )
            if each.advice in instead
            else each
            for each in diagnosis
        ],
    )


def hardly_standing(rows: Sequence[Parameter], recordings: Sequence[Recording]) -> list[Parameter]:
    """The rows of the vertical stiffness, those without a value with the reason that both feet hardly stand together.

    Where a sole lands, lifts or tips, its height does not follow its load.
    """
    steps, short = [], []
    seconds = 0.0
    for each in recordings:
        if any(stance is not None for stance in each.stances.values()):
            steps.append(each.name)
            continue
        both = np.logical_and.reduce([each.used(foot) for foot in each.contacts])
        seconds += float(both.sum()) * each.period
        short.append(each.name)
    if seconds >= LEAST_TOGETHER:
        return list(rows)
    told = [f"feet leave the floor in {_listed(steps)}"] if steps else []
    told += [f"both soles stand flat together for only {seconds:.1f} s of {_listed(short)}"] if short else []
    advice = (
        "stand on both feet and shift the weight slowly from foot to foot for 30 s or more, lifting neither"
    )
    return [
        replace(row, reason="; ".join(told), advice=advice) if row.axis == "z" and row.value is None else row
        for row in rows
    ]


def _missing(robot: RobotModel, recordings: Sequence[Recording]) -> str:
    """The sensors of the IMU that no log has and that the delay cannot be seen without."""
    if robot.imu is None:
        return ""
    name = robot.imu.name
    absent = [
        sensor for column, sensor in SHOWS_DELAY.items()
        if not any(recording.log.has_imu(name, column) for recording in recordings)
    ]  # fmt: skip
    return " and the ".join(absent)


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names) if len(names) <= 3 else f"all {len(names)} logs"
