"""What is said of inertias, joints' terms and wrench sensors: whole lines, and when, by made-up fits."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

from plantar.errors import DataError
from plantar.notes import Note
from plantar.results.dynamics import DynamicsScore
from plantar.whole_body import sensor_calibration
from plantar.whole_body.covariance import Uncertainty
from plantar.whole_body.equations import Calibration
from plantar.whole_body.joints import (
    SENSORS_ERRORS,
    SENSORS_ZERO,
    _above_sensors,
    _judge,
    _measured_joints,
    _parameters,
)
from plantar.whole_body.regularised_fit import HeldOutError
from plantar.whole_body.regularised_result import excitation_of, fit_notes
from plantar.whole_body.scores import worse_notes
from plantar.whole_body.sensor_calibration import _misfit, _reversals, calibrate

IMPOSSIBLE = np.array([-1.0, 0, 0, 0, 1, 0, 1, 0, 0, 1])
SOLID = np.array([2.0, 0, 0, 0, 1, 0, 1, 0, 0, 1])


def fit_of(**changes: Any) -> Any:
    tried = tuple(
        HeldOutError(weight, np.array([error**2] * 3))
        for weight, error in ((30.0, 3.0), (1.0, 4.0), (5.0, 2.0))
    )
    fields = {
        "regularisation": 5.0, "held_out": tried, "equation": SimpleNamespace(links=("trunk", "arm", "hand")),
        "prior": SimpleNamespace(cad=np.concatenate([SOLID, IMPOSSIBLE, IMPOSSIBLE])),
    }  # fmt: skip
    return SimpleNamespace(**(fields | changes))


def test_how_strongly_a_fit_leans_on_the_urdf_in_words() -> None:
    weight = Note(
        "regularisation", "info", "regularised towards the URDF with weight 5: held-out error 2 of the fit's, 4 at the "
        "smallest weight, 3 at the largest"
    )  # fmt: skip
    links = Note("cad_inconsistent", "warning", "inertias in the URDF that no body can have: arm, hand")
    assert fit_notes(fit_of()) == [weight, links]
    assert fit_notes(fit_of(prior=SimpleNamespace(cad=np.tile(SOLID, 3)))) == [weight]
    text = "too few samples for cross-validation: a weak regularisation towards the URDF was assumed"
    assert fit_notes(fit_of(held_out=())) == [Note("regularisation", "warning", text)]


@pytest.mark.parametrize(
    ("lost", "condition", "said"),
    [
        ((), 8.0, None),
        ((1,), 8.0, "the motions excite 4 of 5 directions; from the URDF, not from the data: b"),
        ((0, 1), 3.0, "the motions excite 3 of 5 directions; from the URDF, not from the data: a, b"),
        ((4,), 8.0, "the motions excite 4 of 5 directions; 1 of the joints' terms cannot be told apart"),
        ((1, 3, 4), 8.0, "the motions excite 2 of 5 directions; from the URDF, not from the data: b; 2 of the joints' "
         "terms cannot be told apart"),
    ],
)  # fmt: skip
def test_what_motions_excite_in_words(lost: tuple[int, ...], condition: float, said: str | None) -> None:
    """Three base parameters, two terms of joints: a diagonal regressor, and what is measured in its last column."""
    diagonal = np.array([8.0, 4.0, 1.0, 2.0, 3.0])
    diagonal[[*lost]] = 0.0
    triangle = np.diag([*diagonal, 1.0])
    triangle[:5, 5] = diagonal
    base: Any = type("Base", (), {"names": ("a", "b", "c"), "__len__": lambda _: 3})()
    rank, found, notes = excitation_of(fit_of(triangle=triangle, base=base))
    assert (rank, found) == (5 - len(lost), pytest.approx(condition))
    assert notes == ([Note("unexcited", "warning", said)] if said else [])


def score_of(motion: str, rms: float, kind: Any = "cross", axis: str | None = "force.x") -> DynamicsScore:
    return DynamicsScore(
        kind=kind, motion=motion, unit="N", cad_rms_error=2.0, samples=9, relative_error_percent=1.0, axis=axis,
        joint=None if axis else "knee", mean_abs_error=0.5, rms_error=rms, max_abs=1.0, percent_of_max=1.0,
        zero_mean_abs=7.0,
    )  # fmt: skip


def test_unseen_motions_that_the_urdf_predicts_better_in_words() -> None:
    """From half as much again on; fitted ones are no proof."""
    scores = [
        score_of("a", 3.1234), score_of("b", 2.9), score_of("c", 9.0, "direct"), score_of("d", 4.0, axis=None)
    ]  # fmt: skip
    text = (
        "the URDF alone predicts unseen motions better: use its inertias, or record larger and quicker motions (a: "
        "force.x: 3.12 against 2 N rms, d: knee: 4 against 2 N rms)"
    )
    assert worse_notes(scores) == [Note("worse_than_urdf", "warning", text)]
    assert worse_notes(scores[1:3]) == []


@pytest.mark.parametrize(
    ("term", "value", "interval", "still", "verdict"),
    [
        ("viscous", 2.0, (1.61, 2.39), False, ("usable", "the interval is narrow")),
        ("viscous", 2.0, (1.5, 2.5), True, ("unidentifiable", "the joint hardly moves")),
        ("offset", 2.0, (1.61, 2.39), True, ("usable", "the interval is narrow")),
        ("offset", -2.0, (-2.39, -1.61), False, ("usable", "the interval is narrow")),
        ("offset", 2.0, (1.46, 2.54), False, ("weak", "the interval is 27 % of the value to each side")),
        ("offset", 2.0, (1.51, 2.49), False, ("usable", "the interval is narrow beside the joint's torque")),
        ("coulomb", -1.0, (-3.0, 1.0), False, ("unidentifiable", "zero lies in the interval")),
        ("coulomb", -1.0, (-1.1, -0.9), False, ("unidentifiable", "negative, which is impossible")),
        ("inertia", 1.0, (0.0, 2.0), False, ("unidentifiable", "zero lies in the interval")),
        ("stiffness", 1.0, (0.1, 1.9), False, ("weak", "the interval is 90 % of the value to each side")),
    ],
)
def test_a_joints_term_in_words(
    term: str, value: float, interval: tuple[float, float], still: bool, verdict: tuple[str, str]
) -> None:
    """Beside a torque of 10, of which an offset may be unsure by a twentieth."""
    assert _judge(term, value, interval, 10.0, still) == verdict


def robot_of(base: str = "floating", described: tuple[str, ...] = (), passive: tuple[str, ...] = ()) -> Any:
    """Joints 1 to 3 called hip, knee and neck; the left sensor stands on the knee's link."""
    joints = {name: SimpleNamespace(passive=name in passive) for name in (*described, *passive)}
    foot = SimpleNamespace(wrench=SimpleNamespace(placement="sensor"))
    return SimpleNamespace(
        base=base, joints=joints, feet={"left": foot}, frame=lambda _: (2, None),
        model=SimpleNamespace(names=["universe", "hip", "knee", "neck"], supports=[[0], [0, 1], [0, 1, 2], [0, 3]]),
    )  # fmt: skip


def test_joints_above_a_force_sensor() -> None:
    assert _above_sensors(robot_of()) == {"universe", "hip", "knee"}
    assert _above_sensors(robot_of("fixed")) == frozenset()


@pytest.mark.parametrize(
    ("robot", "verdicts"),
    [
        (robot_of(), ["usable", "weak zero", "usable", "usable", "weak errors"]),
        (robot_of(described=("neck",)), ["usable", "weak zero", "usable", "usable", "usable"]),
        (robot_of("fixed"), ["usable"] * 5),
    ],
)
def test_terms_of_a_floating_robots_joints_are_no_surer_than_its_sensors(
    robot: Any, verdicts: list[str]
) -> None:
    """The knee's offset holds a zero of the sensor below it; a spring that nobody told of may be a delay."""
    terms = {"knee": ("viscous", "offset"), "neck": ("viscous", "offset", "stiffness")}
    tree = SimpleNamespace(names=("hip", "knee", "neck"), slides=np.array([False, True, False]))
    fit: Any = SimpleNamespace(
        equation=SimpleNamespace(tree=tree, first_joint_row=6),
        extras={7: np.array([2.0, 3.0]), 8: np.array([4.0, 5.0, 6.0])},
    )
    trust = Uncertainty(np.zeros(0), {7: np.array([0.02, 0.03]), 8: np.array([0.04, 0.05, 0.06])}, np.inf)  # type: ignore[arg-type]
    one: Any = SimpleNamespace(
        measured={7: np.array([3.0, 4.0]), 8: np.array([1.0, 1.0])},
        motion=SimpleNamespace(positions=np.array([[0.0, 0.0, 0.0], [0.0, 0.1, 0.2]])),
    )
    rows = _parameters(fit, trust, terms, [one], robot)
    assert [(row.joint, row.name, row.unit, row.value, row.std) for row in rows] == [
        ("knee", "viscous", "N.s/m", 2.0, 0.02), ("knee", "offset", "N", 3.0, 0.03),
        ("neck", "viscous", "N.m.s/rad", 4.0, 0.04), ("neck", "offset", "N.m", 5.0, 0.05),
        ("neck", "stiffness", "N.m/rad", 6.0, 0.06),
    ]  # fmt: skip
    short = {SENSORS_ZERO: " zero", SENSORS_ERRORS: " errors"}
    assert [row.verdict + short.get(row.reason, "") for row in rows] == verdicts
    assert rows[4].interval95 == pytest.approx((6 - 1.96 * 0.06, 6 + 1.96 * 0.06), abs=1e-4)
    still: Any = SimpleNamespace(measured=one.measured, motion=SimpleNamespace(positions=np.zeros((2, 3))))
    hardly = [row.reason for row in _parameters(fit, trust, terms, [still], robot) if row.name == "viscous"]
    assert hardly == ["the joint hardly moves"] * 2
    assert {row.verdict for row in _parameters(fit, trust, terms, [still, one], robot)} <= {"usable", "weak"}


def logs_of(robot: Any, fitted: list[set[str]], unseen: list[set[str]]) -> Any:
    def whole(name: str, efforts: set[str]) -> Any:
        return SimpleNamespace(efforts=dict.fromkeys(efforts), log=SimpleNamespace(source=name))

    tree = SimpleNamespace(names=("hip", "knee", "neck"))
    return SimpleNamespace(
        body=SimpleNamespace(robot=robot, equation=SimpleNamespace(tree=tree)),
        fitted=[whole(f"fit{place}", efforts) for place, efforts in enumerate(fitted)],
        unseen=[whole(f"unseen{place}", efforts) for place, efforts in enumerate(unseen)],
    )


def test_joints_are_fitted_whose_effort_every_log_has_and_those_without_a_motor() -> None:
    passive = robot_of(passive=("neck",))
    assert _measured_joints(logs_of(robot_of(), [{"knee", "hip"}, {"knee"}], [{"knee"}])) == ("knee",)
    assert _measured_joints(logs_of(passive, [{"hip"}], [{"hip", "knee"}])) == ("hip", "neck")
    with pytest.raises(DataError, match=r"^unseen1, column 'joint\.knee\.effort': is missing$"):
        _measured_joints(logs_of(passive, [{"knee"}], [{"knee"}, {"hip"}]))
    message = r"^fit0: holds no joint torques \(valid: joint\.<joint>\.effort, or passive: true in the robot file\)$"
    with pytest.raises(DataError, match=message):
        _measured_joints(logs_of(robot_of(), [{"knee"}, {"hip"}], []))


def test_a_misfit_is_about_the_mean_and_of_each_half() -> None:
    error = np.zeros((6, 4))
    error[0] = [10.0, 12.0, 10.0, 12.0]
    error[3] = [-1.0, -1.0, -3.0, 5.0]
    whole, halves = _misfit(error)
    assert whole == pytest.approx([1.0, 1e-6, 1e-6, 3.0, 1e-6, 1e-6])
    assert halves[:, 3] == pytest.approx([1.0, np.sqrt(17.0)])
    assert halves[:, 1] == pytest.approx([1e-6, 1e-6])


def test_each_torque_may_be_reversed_beside_what_is_mended_already() -> None:
    mended = np.arange(36.0).reshape(6, 6)
    body: Any = SimpleNamespace(robot=SimpleNamespace(feet=("left", "right")))
    found = list(_reversals(body, Calibration(np.eye(3), {"right": mended})))
    assert [(channel, shares) for channel, _, _, shares in found] == [(3, False), (4, False), (5, False)]
    for channel, text, sensors, _ in found:
        assert text == "with the sign reversed; check the sensors' axes"
        change = np.diag([-1.0 if place == channel else 1.0 for place in range(6)])
        np.testing.assert_array_equal(sensors["left"], change)
        np.testing.assert_array_equal(sensors["right"], change @ mended)


@pytest.mark.parametrize("as_recorded", [False, True])
def test_faults_of_channels_are_mended_one_after_the_other(
    monkeypatch: pytest.MonkeyPatch, as_recorded: bool
) -> None:
    """Or only told of; no more than three."""
    faults: Iterator[Any] = iter(
        [
            SimpleNamespace(code=f"code{k}", text=f"fault {k}", sensors={"left": k * np.eye(6)})
            for k in range(9)
        ]
    )
    turn = pin.exp3(np.radians([2.0, 0.25, -1.5]))
    monkeypatch.setattr(sensor_calibration, "_levelled", lambda _, __, sensors: Calibration(turn, sensors))
    monkeypatch.setattr(sensor_calibration, "_worst_fault", lambda *_: next(faults))
    nothing: Any = None
    found, notes = calibrate(nothing, [], as_recorded=as_recorded)
    said = "left as recorded" if as_recorded else "corrected here, and scored so"
    tilt = (
        "the ground's mean force is not along the IMU's mean acceleration: taken as a tilt of the IMU's mount by "
        "(2.00, 0.25, -1.50) deg about the root link's x, y, z; correct the robot file's imu.rpy or the force "
        "sensors' zeros"
    )
    assert notes == [
        *(Note(f"code{k}", "warning", f"fault {k}; {said}") for k in range(3)), Note("imu_tilt", "warning", tilt)
    ]  # fmt: skip
    assert found.sensor("left")[0, 0] == (1.0 if as_recorded else 2.0)
    monkeypatch.setattr(sensor_calibration, "_worst_fault", lambda *_: None)
    turn = pin.exp3(np.radians([0.7, 0.7, 0.0]))
    assert calibrate(nothing, [], as_recorded=as_recorded)[1] == []
