"""What is uncertain about the robot and differs from recording to recording, as far as it moves one axis' fit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plantar.estimation import fit_blocks
from plantar.estimation.stance_least_squares import FEWEST_RECORDINGS, jackknife
from plantar.feet.fit.axis import AxisFit
from plantar.feet.fit.regression_data import blocks_of
from plantar.feet.fit.systematic import Cause, share_of_both
from plantar.feet.recording import Recording
from plantar.robot.uncertainty import Uncertainty


def robot_causes(
    fit: AxisFit, recordings: Sequence[Recording], uncertainty: Uncertainty, shared: bool
) -> list[Cause]:
    """The force sensors' gain, a turned sensor, and recordings that differ."""
    # A torque that reads too large by a share makes every number of the bush too large by it. A sensor turned by ψ
    # reads cos ψ of the torque; where it is the IMU that is turned, all of it: no log says which.
    turned = 1 - float(np.cos(fit.turned))
    gain = float(np.hypot(uncertainty.wrench_gain, turned))
    causes = [Cause("sensor gain", fit.values, gain)] if gain else []
    return [*causes, *_between_recordings(fit, recordings, uncertainty.between_recordings, shared)]


def _between_recordings(
    fit: AxisFit, recordings: Sequence[Recording], prior: float, shared: bool
) -> list[Cause]:
    """What recordings differ by beyond what each shows of itself: refits without one of them each (jackknife).

    Fewer than FEWEST_RECORDINGS say too little: of these only the robot file's `prior` share of K and C counts. Walks
    have their own (`systematic`).
    """
    blocks = blocks_of(recordings, fit.foot, fit.axis, drift=not shared, fit=fit)
    if blocks[0].stances is not None or shared:
        return []
    if len(blocks) < FEWEST_RECORDINGS:
        return [share_of_both("between recordings", fit, prior / np.sqrt(len(blocks)))] if prior else []
    refits = np.array(
        [fit_blocks([*blocks[:place], *blocks[place + 1 :]]).values for place in range(len(blocks))]
    )
    covariance, freedom = jackknife(refits)
    beyond = np.diag(covariance) - fit_blocks(blocks).std ** 2
    return [Cause("between recordings", np.sqrt(np.maximum(beyond, 0.0)), 1.0, float(freedom[0]))]
