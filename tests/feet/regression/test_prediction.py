"""Predicted torques: a seen motion by its own offset, an unseen one by its first second's, a walk stance by stance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from biped import TRUTH, record, sway
from plantar.contact.stances import Stances
from plantar.feet.prepare_log import checked, prepare
from plantar.feet.recording import Recording, Role, filtered_recording
from plantar.feet.regression.axis import FittedModel
from plantar.feet.regression.prediction import Prediction, predict
from plantar.models import KelvinVoigt
from plantar.robot.model import RobotModel

LAW = TRUTH["left", "pitch"]
CLOSE = 0.2  # N·m: the bush's centre moves with the load, which is left out here
MODEL = FittedModel(
    foot="left",
    axis="pitch",
    model=KelvinVoigt(),
    values=np.array([LAW.stiffness, LAW.damping]),
    shape=np.zeros(0),
    offsets={"sway": LAW.offset},
)


def swayed(robot: RobotModel, role: Role) -> Recording:
    return filtered_recording(prepare(robot, checked(robot, record(sway(duration=8.0))), role), 5.0)


def worst(recording: Recording, predicted: Prediction) -> float:
    """Largest error over the scored samples [N·m]."""
    error = predicted.torque - recording.bushes["left"].torque[:, 0]
    return float(np.abs(error[predicted.scored]).max())


def test_a_seen_motion_takes_its_own_offset(robot: RobotModel) -> None:
    recording = swayed(robot, "fit")
    predicted = predict(recording, MODEL)
    assert predicted is not None
    assert worst(recording, predicted) < CLOSE
    torque = recording.bushes["left"].torque[recording.used("left"), 0]
    assert predicted.trivial == pytest.approx(np.full(len(recording.time), torque.mean()))
    assert predict(recording, replace(MODEL, offsets={})) is None, "not fitted"


def test_an_unseen_motion_takes_its_first_seconds_offset_which_is_not_scored(robot: RobotModel) -> None:
    recording = swayed(robot, "validate")
    predicted = predict(recording, replace(MODEL, offsets={"sway": 100.0}))
    assert predicted is not None
    assert worst(recording, predicted) < CLOSE
    used = recording.time[recording.used("left")]
    assert recording.time[predicted.scored][0] >= used[0] + 1.0
    first = recording.used("left") & (recording.time < used[0] + 1.0)
    torque = recording.bushes["left"].torque[:, 0]
    assert np.unique(predicted.trivial) == pytest.approx([torque[first].mean()]), "it knows no more either"
    assert abs(torque[first].mean() - torque[recording.used("left")].mean()) > CLOSE


def test_each_stance_of_a_walk_has_its_offset(robot: RobotModel) -> None:
    recording = swayed(robot, "validate")
    number = (recording.time > 4.0).astype(np.intp)
    jump = 7.0 * number  # N·m
    bush = recording.bushes["left"]
    stepped = replace(
        recording,
        bushes={**recording.bushes, "left": replace(bush, torque=bush.torque + jump[:, None])},
        stances={**recording.stances, "left": Stances(number, np.ones(len(number)))},
    )
    predicted = predict(stepped, MODEL)
    assert predicted is not None
    assert worst(stepped, predicted) < CLOSE
    offset = (predicted.torque - predicted.bush)[predicted.scored]
    assert np.unique(offset.round(9)).size == 2, "what is not the bush's is the stance's offset"
    assert np.ptp(offset) == pytest.approx(7.0, abs=CLOSE)
    scored = predicted.trivial[predicted.scored & (number == 1)]
    assert np.ptp(scored) == 0, "one trivial offset a stance"
    torque, used = stepped.bushes["left"].torque[:, 0], stepped.used("left")
    for stance in (0, 1):
        own = used & (number == stance)
        assert predicted.trivial[own] == pytest.approx(np.full(own.sum(), torque[own].mean())), "its own"
