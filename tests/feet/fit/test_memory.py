"""Models with memory: through the filter as the torque, and not where every stance begins anew too often."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import SLIPPING, record, sway
from biped_robot import FEET
from feet_trials import PUNCTUAL, noisy
from plantar.feet.identify import identify_feet
from plantar.models import MODELS
from plantar.robot.model import RobotModel
from plantar.signals.filters import low_pass

PERIOD, CUTOFF = 0.01, 5.0


def test_predictions_of_a_model_with_memory_are_filtered_as_the_torque_is(robot: RobotModel) -> None:
    """An element that slips at 2 mrad makes corners; behind a filter of 5 Hz there are none."""
    truth = {key: replace(law, angle=0.002) for key, law in SLIPPING.items()}
    log = record(sway("sway", 3, truth=truth))
    found = identify_feet(robot, [log], settings=replace(PUNCTUAL, model="elastoplastic", cutoff=CUTOFF))
    table = found.residuals.to_pydict()
    for foot in FEET:
        mine = (np.array(table["foot"]) == foot) & np.array(table["used"])
        torque, predicted = (np.array(table[f"pitch.{name}"])[mine] for name in ("torque", "predicted"))
        sharp = [np.std((one - low_pass(one, PERIOD, 2 * CUTOFF))[50:-50]) for one in (torque, predicted)]
        assert sharp[1] < 1.5 * sharp[0]
        assert np.std(torque - predicted) < 0.005 * np.std(torque)


@pytest.mark.parametrize(
    ("duration", "every", "tried"), [(24.0, 3.5, False), (9.0, 4.5, False), (24.0, 12.0, True)]
)
def test_memory_is_tried_where_the_usual_stance_is_long(
    robot: RobotModel, duration: float, every: float, tried: bool
) -> None:
    """The left foot is lifted for half a second every so often, the right one never. Where it steps, the simplest
    memory is tried and nothing else; where it is lifted once, models without a memory are."""
    starts = np.arange(every, duration - 1.0, every)
    lifts = tuple(("left", float(start), float(start) + 0.5) for start in starts)
    motion = sway("steps", 4, duration=duration, lifts=lifts, truth=SLIPPING)
    found = identify_feet(robot, [noisy(record(motion), 2)], settings=PUNCTUAL)
    for law in found.to_dict()["laws"]:
        ranked = [MODELS[row["law"]] for row in law["ranking"]]
        if len(lifts) > 1 and law["foot"] == "left":
            assert {model.name for model in ranked} == {"kelvin_voigt", "elastoplastic"}
        else:
            assert any(model.remembers for model in ranked) is (tried or law["foot"] == "right"), law["foot"]
