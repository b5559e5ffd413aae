"""Scores of eq. 2 and 3, from numbers small enough to check by hand."""

from __future__ import annotations

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from plantar.results.dynamics import DynamicsScore
from plantar.whole_body.folds import Samples
from plantar.whole_body.scores import Place, scored, worse_notes

PREDICTED = np.array([[1.0, 2.0, 3.0, 4.0], [10.0, 10.0, 10.0, 10.0]])
CAD = np.zeros((2, 4))
FIT = SimpleNamespace(
    predict=lambda samples: PREDICTED,
    equation=SimpleNamespace(inverse_dynamics=lambda motion, parameters: CAD),
    prior=SimpleNamespace(cad=np.zeros(10)),
)


def samples(name: str, first: list[float], second: list[float]) -> Samples:
    time = np.arange(len(first)) * 0.01
    return Samples(name, time, None, {0: np.array(first), 1: np.array(second)}, {}, 0.01)  # type: ignore[arg-type]


SEEN = samples("seen", [1.0, 2.0, 3.0, 8.0], [10.0, 12.0, 8.0, 10.0])
ALSO = samples("also", [0.0, 0.0, 0.0, 0.0], [10.0, 10.0, 10.0, 10.0])
UNSEEN = samples("unseen", [-4.0, 2.0, 3.0, 4.0], [10.0, 10.0, 10.0, 14.0])


def rows(places: tuple[Place, ...]) -> dict[tuple[str, str], DynamicsScore]:
    found, _ = scored(FIT, [SEEN, ALSO], [UNSEEN], places)  # type: ignore[arg-type]
    return {(row.motion, row.axis or row.joint or ""): row for row in found}


def test_errors_of_an_axis() -> None:
    found = rows((Place(0, "N", axis="force.x"), Place(1, "N.m", axis="torque.y")))
    assert set(found) == {
        (name, axis) for name in ("seen", "also", "unseen") for axis in ("force.x", "torque.y")
    }
    force, torque = found["seen", "force.x"], found["seen", "torque.y"]
    assert (force.kind, force.unit, force.samples) == ("direct", "N", 4)
    assert force.mean_abs_error == pytest.approx(1.0)
    assert force.rms_error == pytest.approx(2.0)
    assert (force.max_abs, force.percent_of_max) == (8.0, pytest.approx(12.5))
    assert force.cad_rms_error == pytest.approx(np.sqrt(78 / 4))
    assert force.relative_error_percent == pytest.approx(100 * 4 / np.sqrt(78))
    # The trivial predictor: the mean of the fitted motions' means, (3.5 + 0) / 2, for seen and unseen motions alike.
    assert force.zero_mean_abs == pytest.approx(np.mean(np.abs(np.array([1, 2, 3, 8]) - 1.75)))
    assert torque.mean_abs_error == pytest.approx(1.0)
    cross = found["unseen", "force.x"]
    assert cross.kind == "cross"
    assert cross.mean_abs_error == pytest.approx(5 / 4)
    assert cross.zero_mean_abs == pytest.approx(np.mean(np.abs(np.array([-4, 2, 3, 4]) - 1.75)))


def test_residuals_are_named_by_axis_or_joint() -> None:
    for places in (
        (Place(0, "N", axis="force.x"), Place(1, "N.m", axis="torque.y")),
        (Place(0, "N.m", joint="knee"), Place(1, "N.m", joint="hip")),
    ):
        table = scored(FIT, [SEEN], [UNSEEN], places)[1]  # type: ignore[arg-type]
        names = [place.axis or place.joint for place in places]
        assert table.column_names[3:] == [
            f"{name}.{kind}" for name in names for kind in ("measured", "predicted")
        ]
        assert table[f"{names[1]}.measured"].to_pylist() == [10.0, 12.0, 8.0, 10.0, 10.0, 10.0, 10.0, 14.0]
        assert table["role"].to_pylist() == ["fit"] * 4 + ["validate"] * 4


def test_joints_are_scored_also_all_together() -> None:
    found = rows((Place(0, "N.m", joint="knee"), Place(1, "N.m", joint="hip")))
    whole = found["seen", "all"]
    assert whole.mean_abs_error == pytest.approx(1.0)
    assert whole.rms_error == pytest.approx(np.sqrt((16 + 8) / 8))
    assert whole.relative_error_percent == pytest.approx(100 * np.sqrt(24 / (78 + 408)))
    assert ("seen", "all") not in rows((Place(0, "N", axis="force.x"),))


def test_an_axis_that_is_zero_has_no_share_of_it() -> None:
    still = rows((Place(0, "N", axis="force.x"),))["also", "force.x"]
    assert (still.percent_of_max, still.relative_error_percent) == (None, None)


def test_residuals_hold_every_sample_of_every_motion() -> None:
    _, table = scored(FIT, [SEEN], [UNSEEN], (Place(0, "N", axis="force.x"),))  # type: ignore[arg-type]
    columns = table.to_pydict()
    assert columns["motion"] == ["seen"] * 4 + ["unseen"] * 4
    assert columns["role"] == ["fit"] * 4 + ["validate"] * 4
    assert columns["force.x.measured"] == [1.0, 2.0, 3.0, 8.0, -4.0, 2.0, 3.0, 4.0]
    assert columns["force.x.predicted"] == [1.0, 2.0, 3.0, 4.0] * 2


def test_unseen_motions_that_the_urdf_predicts_better_are_told() -> None:
    """The URDF predicts nothing at all, the fit 1 to 4: of a motion that is next to nothing the URDF knows more."""
    places = (Place(0, "N", axis="force.x"), Place(1, "N.m", axis="torque.y"))
    still = samples("still", [1.0, -1.0, 1.0, -1.0], [9.0, 9.0, 9.0, 9.0])
    for fitted, unseen, told in (([SEEN], [still], 1), ([still], [SEEN], 0), ([SEEN], [UNSEEN], 0)):
        found, _ = scored(FIT, fitted, unseen, places)  # type: ignore[arg-type]
        notes = worse_notes(found)
        assert [note.code for note in notes] == told * ["worse_than_urdf"]
        assert all("still: force.x: 3.08 against 1 N rms" in note.text for note in notes)
        assert all("torque.y" not in note.text for note in notes)


def test_of_many_rows_that_are_worse_eight_are_named() -> None:
    still = samples("still", [1.0, -1.0, 1.0, -1.0], [9.0, 9.0, 9.0, 9.0])
    row = next(
        one
        for one in scored(FIT, [SEEN], [still], (Place(0, "N", axis="force.x"),))[0]
        if one.kind == "cross"
    )  # type: ignore[arg-type]
    (note,) = worse_notes([replace(row, motion=f"m{place}") for place in range(11)])
    assert re.findall(r"m\d+", note.text) == [f"m{place}" for place in range(8)]
    assert "3 more" in note.text
