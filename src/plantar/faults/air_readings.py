"""What a force sensor reads while its foot hangs in the air: its zero, and what hangs below it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from plantar.conventions import GRAVITY, Array
from plantar.notes import Finding
from plantar.robot.model import RobotModel
from plantar.signals.segments import complete, longest_run

STANDS = 0.8  # of the weight, that the other feet carry
HANGS = 0.15  # of the weight, that a foot in the air may read
LONG = 3.0  # s: what a foot reads in a step is taken off as its zero
FORCE_OFF = 0.03  # of the weight
TORQUE_OFF = 0.006  # m, times the weight: a point of load that is beside its place by so much


def check_air_readings(
    robot: RobotModel, period: float, loads: Mapping[str, Array], wrenches: Mapping[str, Array]
) -> Iterator[Finding]:
    """A finding for each foot that reads a load while the others carry the robot.

    loads: vertical (N,) [N]; wrenches: as recorded (N, 6); by foot, sampled each `period` [s].
    """
    weight = robot.mass * GRAVITY
    limits = weight * np.repeat([FORCE_OFF, TORQUE_OFF], 3)
    for name, load in loads.items():
        others = sum((load for other, load in loads.items() if other != name), np.zeros(len(load)))
        hanging = (others > STANDS * weight) & (np.abs(load) < HANGS * weight)
        run = longest_run(hanging & complete(wrenches[name]))
        if (run.stop - run.start) * period < LONG or robot.feet[name].contact == "always":
            continue
        usual = np.median(wrenches[name][run], axis=0)
        worst = int(np.argmax(np.abs(usual) / limits))
        if abs(usual[worst]) > limits[worst]:
            kind, axis = ("force", "torque")[worst // 3], "xyz"[worst % 3]
            text = (
                f"column 'wrench.{robot.feet[name].wrench.name}.{kind}.{axis}', value {usual[worst]:.4g}: reads this "
                f"while {name} hangs in the air, so its zero is off (valid: below {limits[worst]:.2g}; zero "
                "the sensor in the air)"
            )
            yield Finding("air_reading", text)
