"""Feet whose force sensors pull them down: a reversed sign, or sensors that were zeroed while the feet carried load."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from plantar.conventions import GRAVITY, Array
from plantar.notes import Finding
from plantar.robot.model import RobotModel

PULLS = 0.2  # of the weight: a standing foot's sensor that reads so much downward has no mere zero
KEEPS = 0.5  # share of the change of a difference of loads below which their sum, the weight, keeps


def check_load_signs(robot: RobotModel, loads: Mapping[str, Array]) -> Iterator[Finding]:
    """A fatal finding for each foot whose load (N,) [N] is usually negative.

    What one foot carries more the other carries less. Loads that do so have the right signs: then the sensors were
    zeroed under load, and another sign would only move the fault to the other foot.
    """
    weight = robot.mass * GRAVITY
    zeroed = len(loads) == len(robot.feet) > 1 and _exchange(list(loads.values()), weight)
    for name, load in loads.items():
        foot, usual = robot.feet[name], float(np.nanmedian(load))
        if foot.contact == "always" or usual >= -PULLS * weight:
            continue
        text = f"column 'wrench.{foot.wrench.name}.force.z', value {usual:.4g}: pulls the standing foot down"
        if zeroed:
            text += "; the feet exchange load as they should, so the sensors were zeroed under load"
            valid = "valid: zeroed in the air, or 'contact: always' for feet that stand throughout"
            yield Finding("zeroed_under_load", f"{text} ({valid})", True)
        elif _others_carry_all(loads, name, weight):
            text = f"column 'wrench.{foot.wrench.name}.force.z', value {usual:.4g}: reads this while the other foot"
            text += " carries the whole weight, so its zero is off"
            yield Finding("zeroed_under_load", f"{text} (valid: 0; zero the sensor in the air)", True)
        else:
            valid = f"valid: > 0; set 'sign: {-int(foot.wrench.sign)}' in feet.{name}.wrench"
            valid += ", or turn its rpy if it sits upside down"
            yield Finding("sign", f"{text} ({valid})", True)


def _others_carry_all(loads: Mapping[str, Array], name: str, weight: float) -> bool:
    """Whether the weight is whole without this foot rather than with its load reversed."""
    others = sum(float(np.nanmedian(load)) for other, load in loads.items() if other != name)
    return abs(others - weight) < abs(others - float(np.nanmedian(loads[name])) - weight)


def _exchange(loads: list[Array], weight: float) -> bool:
    """Whether one foot carries more as the other carries less; not where all are reversed, so that the sum is."""
    both = np.asarray(loads)[:, np.isfinite(loads).all(axis=0)]
    if both.shape[1] < 2:
        return False
    total = both.sum(axis=0)
    return bool(np.median(total) > -weight / 2) and float(np.std(total)) < KEEPS * max(
        float(np.std(both[0] - other)) for other in both[1:]
    )
