"""Whether the stances of a walk turn an element of the rubber's memory round: only then is its slip torque seen.

An element that slips one way has to be bent back by two slip angles before it slips the other way. A path that spans
less shows at most one side of the loop, and how much of the torque is the spring's and how much the element's is a
guess that the smallest error of sensors or mounts decides.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.model_columns import path_of

ROUND = 2.0  # slip angles from one end of a path to the other
HARDLY_TURNED = (
    "stances bend the foot by {:.1f} slip angles from end to end, and only two turn the element round: stiffness and "
    "slip torque take from each other (record longer steps, or stand and sway)"
)


def slip_angles_spanned(fit: AxisFit, recordings: Sequence[Recording]) -> float | None:
    """How many slip angles the path of a usual stance spans; None of a foot that stands and a model without one."""
    walks = [each for each in recordings if each.stances[fit.foot] is not None and each.name in fit.offsets]
    if not walks or fit.slip_angle is None:
        return None
    paths = [path_of(each, fit.foot, fit.axis, fit.imu_turned) for each in walks]
    spans = [float(np.ptp(path.deflection[run])) for path in paths for run in path.runs]
    return float(np.median(spans)) / fit.slip_angle if spans else None


def cautioned_if_hardly_turned(fit: AxisFit, recordings: Sequence[Recording]) -> AxisFit:
    """The fit, with a caution where the stances of a walk do not turn its element round."""
    spanned = slip_angles_spanned(fit, recordings)
    if fit.choice is None or fit.choice.caution is not None or spanned is None or spanned >= ROUND:
        return fit
    return replace(fit, choice=replace(fit.choice, caution=HARDLY_TURNED.format(spanned)))
