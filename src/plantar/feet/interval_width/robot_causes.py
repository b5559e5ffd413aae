"""What is uncertain about the robot and differs from recording to recording, as far as it moves one axis' fit."""

from __future__ import annotations

import numpy as np

from plantar.feet.interval_width.between_recordings import Apart, between_recordings
from plantar.feet.interval_width.between_walks import between_walks
from plantar.feet.interval_width.cause import Cause
from plantar.feet.regression.tangent import Tangent


def robot_causes(tangent: Tangent, wrench_gain: float, apart: Apart) -> list[Cause]:
    """The force sensors' gain, a turned sensor, and recordings that differ: `apart`, as all axes show it."""
    # A torque that reads too large by a share makes every number of the bush too large by it. A sensor turned by ψ
    # reads cos ψ of the torque; where it is the IMU that is turned, all of it, and only moving joints tell them apart.
    turned = 1 - float(np.cos(tangent.fit.turned))
    gain = float(np.hypot(wrench_gain, turned))
    causes = [Cause("sensor gain", tangent.fit.values, gain)] if gain else []
    return causes + (between_walks if tangent.steps else between_recordings)(tangent, apart)
