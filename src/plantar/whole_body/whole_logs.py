"""All logs of one identification by eq. 2 or 3, ready: what they have in common is found here."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plantar.errors import DataError
from plantar.logs.inputs import LogInputs, check_names, logs_of
from plantar.notes import Note
from plantar.results.feet import Input
from plantar.robot.guesses import guess_notes
from plantar.robot.model import RobotModel
from plantar.whole_body.dataset import Body, Whole, prepare_whole
from plantar.whole_body.equations import Calibration
from plantar.whole_body.sensor_calibration import calibrate
from plantar.whole_body.settings import DynamicsSettings

Progress = Callable[[str], None]


@dataclass(frozen=True)
class WholeLogs:
    """The robot, its logs to fit and those to score, and what its sensors need."""

    body: Body
    fitted: tuple[Whole, ...]
    unseen: tuple[Whole, ...]
    calibration: Calibration
    inputs: tuple[Input, ...]
    notes: tuple[Note, ...]


def prepare_logs(
    robot: RobotModel,
    fit: LogInputs,
    score: LogInputs,
    settings: DynamicsSettings,
    progress: Progress,
) -> WholeLogs:
    """Every log prepared, the sensors calibrated on those to fit.

    Raises RobotError, LogError or DataError where a log cannot be used, there is none to fit or two share a name.
    """
    logs, validate = tuple(logs_of(fit, robot)), tuple(logs_of(score, robot))
    if not logs:
        raise DataError("no logs to fit (valid: at least one)")
    check_names((*logs, *validate))
    body = Body.of(robot, floating=robot.base == "floating")
    progress("prepare the logs")
    fitted = tuple(prepare_whole(body, log, settings) for log in logs)
    unseen = tuple(prepare_whole(body, log, settings) for log in validate)
    calibration, notes = Calibration(np.eye(3)), list[Note]()
    if body.equation.floating:
        calibration, notes = calibrate(body, fitted, as_recorded=settings.as_recorded)
    inputs = (*(Input.of(log, "fit") for log in logs), *(Input.of(log, "validate") for log in validate))
    guessed = [*guess_notes(robot.path.name, robot.guesses), *robot.weight_notes]
    said = (*guessed, *(note for whole in fitted + unseen for note in whole.notes), *notes)
    return WholeLogs(body, fitted, unseen, calibration, inputs, said)
