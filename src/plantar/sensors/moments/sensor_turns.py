"""Force sensors whose axes are not where the robot file has them: a little of one torque then shows in the other."""

from __future__ import annotations

import numpy as np

from plantar.conventions import NORMAL95
from plantar.estimation.quantiles import MOST_FREEDOM
from plantar.notes import Note
from plantar.robot.model import RobotModel
from plantar.sensors.load_errors import TURN
from plantar.sensors.moments.moment_fit import MomentFit, Part, is_wrong
from plantar.sensors.moments.sensor_errors import turn_columns

TURNED = "wrench_turned"
LEAST = 0.05  # rad: damping is off by some percent; one that is known less well may be chance


def sensor_turn_notes(robot: RobotModel, fit: MomentFit | None) -> dict[str, Note]:
    """By foot, a warning where the moments of the robot's motion ask for a force sensor that is turned."""
    notes: dict[str, Note] = {}
    if fit is None:
        return notes
    parts = [*fit.parts, Part(TURN**2 * np.eye(len(fit.values)), MOST_FREEDOM)]
    deviations = np.sqrt(np.sum([np.diag(part.covariance) for part in fit.parts], axis=0))
    for foot, columns in turn_columns(robot).items():
        turn, std = fit.values[columns], deviations[columns]
        worst = int(np.argmax(np.abs(turn)))
        known = NORMAL95 * std[worst] < LEAST
        if known and abs(turn[worst]) > LEAST and is_wrong(fit.values, parts, [columns.start + worst]):
            size, reach = np.degrees([turn[worst], NORMAL95 * std[worst]])
            text = (
                f"{foot}: forces and torques give the moments of the robot's motion with the force sensor's frame "
                f"turned by {size:+.0f} ± {reach:.0f} deg about its {'xyz'[worst]} axis (95 %). Check "
                f"'feet.{foot}.wrench' in the robot file, and the zeros of this leg's encoders, which turn it alike"
            )
            notes[foot] = Note(TURNED, "warning", text)
    return notes
