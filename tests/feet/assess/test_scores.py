"""A model against a motion that it has not seen: honest about the offset, and about the trivial predictor."""

from __future__ import annotations

import numpy as np
import pytest

from biped import record, sway
from feet_trials import LINEAR
from made_recording import FOOT, made_recording, swayed
from plantar.feet.assess.scores import score_axis
from plantar.feet.identify import identify_feet
from plantar.feet.regression.axis import FittedModel
from plantar.logs.motion_log import MotionLog
from plantar.models import KelvinVoigt
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel

STEP, AT = 3.0, 2.0  # N·m, s


def stepped(log: MotionLog) -> MotionLog:
    """The left foot's pitch torque jumps by STEP at AT and stays there, as when a sensor's zero is set anew."""
    column = log.columns["wrench.left.torque.y"]
    return log.with_columns({"wrench.left.torque.y": column + STEP * (log.time > AT)})


@pytest.fixture(scope="module")
def found(robot: RobotModel) -> FeetResult:
    unseen = stepped(record(sway("unseen", 2)))
    return identify_feet(robot, [record(sway("seen", 1))], [unseen], settings=LINEAR)


def test_a_step_after_the_first_second_is_an_error_in_full(found: FeetResult) -> None:
    rows = {(row.foot, row.axis): row for row in found.validation if row.kind == "cross"}
    assert len(rows) == 4
    wrong = rows.pop(("left", "pitch"))
    assert wrong.mean_abs_error == pytest.approx(STEP, rel=0.08)  # but for the second before the step
    assert wrong.rms_error == pytest.approx(STEP, rel=0.08)
    assert all(row.mean_abs_error < 0.05 for row in rows.values())


def test_the_trivial_predictor_knows_the_first_second_alone(found: FeetResult) -> None:
    """Its constant is the torque's mean there; it is scored on what comes after."""
    table = found.residuals.filter(
        (found.residuals["motion"].cast("string").to_numpy(zero_copy_only=False) == "unseen").tolist()
    ).to_pydict()
    foot, used = np.array(table["foot"]), np.array(table["used"])
    mine = (foot == "left") & used
    time, torque = np.array(table["time"])[mine], np.array(table["pitch.torque"])[mine]
    first = time < time[0] + 1.0
    row = next(r for r in found.validation if (r.kind, r.foot, r.axis) == ("cross", "left", "pitch"))
    assert row.zero_mean_abs == pytest.approx(
        np.mean(np.abs(torque[~first] - torque[first].mean())), rel=1e-6
    )
    assert row.zero_mean_abs > 1.02 * np.mean(np.abs(torque[~first] - torque[~first].mean()))


def test_a_recording_of_few_samples_is_not_scored_and_an_unseen_one_is_cross_validation() -> None:
    angle = swayed(1000)
    model = FittedModel(
        foot=FOOT, axis="pitch", model=KelvinVoigt(), values=np.array([400.0, 0.0]), shape=np.zeros(0),
        offsets={"seen": 0.5, "short": 0.0},
    )  # fmt: skip
    seen = made_recording("seen", angle, 400 * angle)
    short = made_recording("short", angle[:40], 400 * angle[:40])
    unseen = made_recording("unseen", angle, 410 * angle + 7.0, role="validate")
    rows, predictions = score_axis([seen, short, unseen], model)
    assert [(row.motion, row.kind) for row in rows] == [("seen", "direct"), ("unseen", "cross")]
    assert rows[0].mean_abs_error == pytest.approx(0.5)
    first = angle[:100].mean()
    assert rows[1].mean_abs_error == pytest.approx(np.mean(np.abs(10 * (angle[100:] - first))))
    assert set(predictions) == {("seen", FOOT, "pitch"), ("unseen", FOOT, "pitch")}
