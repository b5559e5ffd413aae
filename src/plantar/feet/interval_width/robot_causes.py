"""What is uncertain about the robot and differs from recording to recording, as far as it moves one axis' fit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.estimation import Block
from plantar.feet.interval_width.between_recordings import Apart, between_recordings
from plantar.feet.interval_width.between_walks import between_walks
from plantar.feet.interval_width.cause import Cause
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit


def robot_causes(
    fit: AxisFit,
    blocks: Sequence[Block],
    recordings: Sequence[Recording],
    wrench_gain: float,
    apart: Apart,
    shared: bool,
) -> list[Cause]:
    """The force sensors' gain, a turned sensor, and recordings, their `tangent_blocks`, that differ: `apart`, as all
    axes show it."""
    # A torque that reads too large by a share makes every number of the bush too large by it. A sensor turned by ψ
    # reads cos ψ of the torque; where it is the IMU that is turned, all of it, and only moving joints tell them apart.
    turned = 1 - float(np.cos(fit.turned))
    gain = float(np.hypot(wrench_gain, turned))
    causes = [Cause("sensor gain", fit.values, gain)] if gain else []
    if blocks[0].stances is not None:
        return [*causes, *between_walks(fit, blocks, apart)]
    return [*causes, *between_recordings(fit, blocks, recordings, apart, shared)]
