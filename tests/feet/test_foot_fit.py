"""A fault of plantar in one axis: that axis is given up with the reason, everything else stays."""

from __future__ import annotations

import re
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from biped import record, sway
from biped_robot import FEET
from feet_trials import PUNCTUAL
from plantar import cores
from plantar.errors import DataError
from plantar.estimation.random_effects import Differences
from plantar.estimation.residual_covariance import relative_std_percent
from plantar.feet import foot_assessment, foot_fit
from plantar.feet.assess.left_out import ON_AN_EDGE
from plantar.feet.foot_fit import FittedFoot, between_all
from plantar.feet.identify import fit_prepared
from plantar.feet.internal_error import described
from plantar.feet.interval_width.between_recordings import AxisDifferences
from plantar.feet.place.spread import PlaceSpread
from plantar.feet.prepare import PreparedLogs, prepare_all
from plantar.feet.settings import FeetSettings
from plantar.notes import Note
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import EXACT, Uncertainty

BROKEN = ("left", "roll")
STEPS = ["fit_axis", "outlier_masks", "systematic_causes", "score_axis", "axis_rows", "diagnose_axis"]


def breaking(step: Callable[..., Any], error: Exception) -> Callable[..., Any]:
    """The step, which raises where it is about the broken axis."""

    def broken(*given: Any) -> Any:
        fits = [getattr(one, "fit", one) for one in given]
        about = [(fit.foot, fit.axis) for fit in fits if hasattr(fit, "axis")]
        if BROKEN in about or given[1:3] == BROKEN:
            raise error
        return step(*given)

    return broken


@pytest.fixture(scope="module")
def ready(robot: RobotModel) -> PreparedLogs:
    return prepare_all(robot, [record(sway())], (), PUNCTUAL, lambda _: None)


@pytest.fixture(scope="module")
def whole(robot: RobotModel, ready: PreparedLogs) -> FeetResult:
    return fit_prepared(robot, ready)


@pytest.mark.parametrize("step", STEPS)
def test_an_unexpected_error_gives_up_its_axis_alone(
    robot: RobotModel, ready: PreparedLogs, whole: FeetResult, monkeypatch: pytest.MonkeyPatch, step: str
) -> None:
    fault = np.linalg.LinAlgError("Eigenvalues did\nnot converge")
    for place in (foot_fit, foot_assessment):
        if hasattr(place, step):
            monkeypatch.setattr(place, step, breaking(getattr(place, step), fault))
    found = fit_prepared(robot, ready)
    lost = [row for row in found.parameters if (row.foot, row.axis) == BROKEN]
    assert {row.name for row in lost} == {"stiffness", "damping"}
    assert {(row.verdict, row.value) for row in lost} == {("unidentifiable", None)}
    assert re.fullmatch(
        r"an error inside plantar, please report: LinAlgError in feet/foot_(fit|assessment).py, line \d+: "
        "Eigenvalues did not converge",
        lost[0].reason,
    )
    notes = [note for note in found.notes if note.code == "internal_error"]
    assert [(note.severity, note.text) for note in notes] == [("warning", f"left roll: {lost[0].reason}")]
    assert rest_of(found.parameters) == rest_of(whole.parameters)
    assert rest_of(found.validation) == rest_of(whole.validation)
    assert not [row for row in (*found.validation, *found.offsets) if (row.foot, row.axis) == BROKEN]


@pytest.mark.parametrize("error", [DataError("a line"), MemoryError(), RuntimeWarning("overflow")])
def test_what_is_no_fault_of_plantar_is_raised_on(
    robot: RobotModel, ready: PreparedLogs, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    monkeypatch.setattr(foot_assessment, "score_axis", breaking(foot_assessment.score_axis, error))
    with pytest.raises(type(error)):
        fit_prepared(robot, ready)


def rest_of(rows: Any) -> list[Any]:
    return [row for row in rows if (row.foot, row.axis) != BROKEN]


def test_an_error_is_described_by_its_innermost_place_in_plantar() -> None:
    with pytest.raises(TypeError) as caught:
        relative_std_percent("none", 1.0)  # type: ignore[arg-type]
    assert described(caught.value).startswith("TypeError in estimation/residual_covariance.py, line ")
    assert described(ValueError("two\nlines")) == "ValueError outside plantar: two lines"


@pytest.mark.parametrize(
    ("differ", "share"), [((0.03, 0.03, 0.03, 0.03), True), ((0.03, 0.0, 0.0, 0.0), False)]
)
def test_one_axis_that_differs_alone_says_nothing_of_the_others(
    monkeypatch: pytest.MonkeyPatch, differ: tuple[float, ...], share: bool
) -> None:
    """Rubber warms up in all axes; two recordings, known to 0.1 %, where the robot file allows 0.2 %."""
    told = iter(
        AxisDifferences(Differences(np.array([own]), np.array([[1e-6]])), 1e-3, frozenset("ab"))
        for own in differ
    )
    monkeypatch.setattr(foot_fit, "axis_differences", lambda *_: next(told))
    monkeypatch.setattr(foot_fit, "Tangent", SimpleNamespace(of=lambda *_: None))
    robot = SimpleNamespace(uncertainty=Uncertainty(between_recordings=0.002))
    ready = SimpleNamespace(robot=robot, settings=FeetSettings(), fitted=())
    feet = [
        FittedFoot(foot, None, {"pitch": None, "roll": None}, {}, ready, ready, (), elsewhere=None)
        for foot in FEET
    ]  # type: ignore[arg-type, dict-item]
    found = between_all(feet)
    assert found.others == 1
    assert (found.shown is not None) == share
    assert found.share > 0.01 if share else found.share == 0.002


@pytest.mark.parametrize("exact", [False, True])
def test_differences_that_hardly_show_are_none_of_a_robot_that_is_what_its_file_says(
    monkeypatch: pytest.MonkeyPatch, exact: bool
) -> None:
    """Two recordings that are alike to 1 %, and a stiffness known to 0.01 %."""
    alike = AxisDifferences(Differences(np.zeros(1), np.array([[1e-4]])), 1e-4, frozenset("ab"))
    monkeypatch.setattr(foot_fit, "axis_differences", lambda *_: alike)
    monkeypatch.setattr(foot_fit, "Tangent", SimpleNamespace(of=lambda *_: None))
    robot = SimpleNamespace(uncertainty=EXACT if exact else Uncertainty())
    ready = SimpleNamespace(robot=robot, settings=FeetSettings(), fitted=())
    feet = [
        FittedFoot(foot, None, {"pitch": None, "roll": None}, {}, ready, ready, (), elsewhere=None)
        for foot in FEET
    ]  # type: ignore[arg-type, dict-item]
    found = between_all(feet)
    assert found.shown is None
    assert found.share < 0.001 if exact else found.share > 0.003


@pytest.mark.parametrize("steps", [False, True])
def test_the_height_that_one_axis_shows_far_off_is_expected_of_the_other(
    monkeypatch: pytest.MonkeyPatch, steps: bool
) -> None:
    """Of a standing foot; one that steps has its place from its stances. Pitch shows 30 mm, roll nothing."""
    asked: list[tuple[str, float]] = []

    def fitted(
        recordings: Any,
        foot: str,
        axis: str,
        settings: Any,
        model: Any,
        place: PlaceSpread,
        timed: bool,
        before: Any,
    ) -> Any:
        asked.append((axis, place.height))
        return SimpleNamespace(moment_arms=(0.0, 0.03 if axis == "pitch" else 0.0))

    monkeypatch.setattr(
        cores, "usable_cores", lambda: 1
    )  # else what is asked is asked in a copy of the process
    monkeypatch.setattr(foot_fit, "fit_axis", fitted)
    recording = SimpleNamespace(stances={"left": object() if steps else None})
    ready: Any = SimpleNamespace(
        fitted=[recording], settings=FeetSettings(), sensor_delay=SimpleNamespace(doubtful=False)
    )
    foot_fit._fits(ready, "left", PlaceSpread(0.004, 0.004, 0.01), {}, {})
    assert asked == [("pitch", 0.0), ("roll", 0.0), *([] if steps else [("roll", 0.03)])]


def test_without_its_outliers_a_foot_is_fitted_once_more_with_its_models_chosen_anew(
    ready: PreparedLogs, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two rounds of outliers: three fits of both axes, none of a model that is asked for."""
    judged: list[str] = []
    rounds: list[PreparedLogs] = []
    fit_both = foot_fit._fits

    def masks(recordings: Any, fit: Any) -> dict[str, Any]:
        judged.append(fit.reason)
        off = np.zeros(len(recordings[0].used("left")), dtype=bool)
        off[300 + len(judged)] = len(judged) <= 4
        return {recordings[0].name: off} if off.any() else {}

    def fits(thin: PreparedLogs, *given: Any) -> Any:
        rounds.append(thin)
        return fit_both(thin, *given)

    monkeypatch.setattr(foot_fit, "outlier_masks", masks)
    monkeypatch.setattr(foot_fit, "_fits", fits)
    foot_fit.fit_foot(ready, "left", PlaceSpread(0.0, 0.0, 0.0))
    assert len(judged) == 6
    assert "asked for" not in judged
    assert len(rounds) == 3


def test_an_edge_that_takes_most_of_a_foot_comes_first_of_what_to_mend(
    robot: RobotModel, ready: PreparedLogs, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In both axes of that foot, and of no other; no number is doubted for it."""
    edge = Note(ON_AN_EDGE, "warning", "left foot: on its edge")
    asked: list[tuple[str, str, list[str]]] = []

    def mended(rows: Any, faults: Any) -> Any:
        asked.append((rows[0].foot, rows[0].axis, [note.code for note in faults]))
        return rows

    monkeypatch.setattr(
        cores, "usable_cores", lambda: 1
    )  # what is asked in a copy of the process is not seen
    monkeypatch.setattr(foot_assessment, "mend_first", mended)
    monkeypatch.setattr(
        foot_assessment, "mostly_on_an_edge", lambda foot, *_: [edge] if foot == "left" else []
    )
    found = fit_prepared(robot, ready)
    first = {(foot, axis): codes[:1] == [ON_AN_EDGE] for foot, axis, codes in asked}
    assert first == {(foot, axis): foot == "left" for foot in FEET for axis in ("pitch", "roll")}
    assert edge in found.notes
    assert {row.verdict for row in found.parameters if row.axis != "z"} == {"usable"}
