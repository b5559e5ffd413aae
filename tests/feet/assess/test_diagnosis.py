"""What limits a number is the largest share of its variance, and the advice is the one against that."""

from __future__ import annotations

import ast
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from plantar.feet.assess.data_faults import ADVICE
from plantar.feet.assess.diagnosis import REMEDY, advised, diagnose_axis, mend_first
from plantar.feet.interval_width import systematic
from plantar.feet.interval_width.cause import Cause
from plantar.feet.regression.axis import AxisFit
from plantar.models import KelvinVoigt
from plantar.notes import Note
from plantar.results.feet import Parameter


def axis_fit(std: tuple[float, float], white: float = 1.0) -> AxisFit:
    return AxisFit(
        foot="left", axis="pitch", model=KelvinVoigt(), values=np.array([400.0, 20.0]), shape=np.zeros(0),
        covariance=np.diag(np.square(std)), freedom=np.full(2, 30.0), white_std=np.array(std) * white,
        offset_std={}, equivalent=(400.0, 20.0), choice=None, reason="",
    )  # fmt: skip


def rows(verdict: str = "weak") -> list[Parameter]:
    return [
        Parameter("left", "pitch", name, "", value, 1.0, (0.0, 1.0), 1.0, verdict, "wide", "sway")  # type: ignore[arg-type]
        for name, value in (("stiffness", 400.0), ("damping", 20.0))
    ]


def test_shares_are_of_variances_and_the_largest_limits() -> None:
    narrow, wide = axis_fit((3.0, 0.1)), axis_fit((5.0, 0.5))
    delay = Cause("delay", np.array([4.0, np.sqrt(0.24)]), 1.0)
    stiffness, damping = diagnose_axis(narrow, wide, [delay], rows())
    assert stiffness.variance_shares == pytest.approx({"delay": 0.64, "noise": 0.36})
    assert damping.variance_shares == pytest.approx({"delay": 0.96, "noise": 0.04})
    assert stiffness.limit == "delay"
    assert stiffness.half_width_percent == rows()[0].half_width_percent, "one number has one width"
    unbounded = [replace(row, interval95=None) for row in rows()]
    alone, _ = diagnose_axis(narrow, wide, [delay], unbounded)
    assert alone.half_width_percent == pytest.approx(196 * 5.0 / 400.0)
    # Without it the root of what is left of the variance.
    assert stiffness.text == (
        "left pitch stiffness: ±0.12 %, 64 % of its variance from delay; without it ±0.075 %. To tighten: "
        f"{REMEDY['delay']}"
    )
    slip = diagnose_axis(narrow, wide, [delay], [replace(row, name="slip_torque") for row in rows()])[0]
    assert slip.text.startswith("left pitch slip torque: ")
    nothing = [replace(rows()[0], value=None), rows()[1]]
    assert [row.name for row in diagnose_axis(narrow, wide, [delay], nothing)] == ["damping"]
    assert "nearly all of it from delay" in damping.text
    assert stiffness.advice == REMEDY["delay"]
    assert stiffness.advice in stiffness.text


def test_coloured_residuals_are_the_models_and_an_interval_over_zero_is_the_motions() -> None:
    """From ten times the white deviation on."""
    coloured = axis_fit((3.0, 0.1), white=1 / 10.5)
    assert {row.limit for row in diagnose_axis(coloured, coloured, [], rows())} == {"model"}
    hardly = axis_fit((3.0, 0.1), white=1 / 9.5)  # filtered noise is nearly as coloured
    assert {row.limit for row in diagnose_axis(hardly, hardly, [], rows())} == {"noise"}
    assert {row.limit for row in diagnose_axis(coloured, coloured, [], rows("unidentifiable"))} == {
        "excitation"
    }


def test_against_a_delay_another_motion_is_advised_but_not_against_noise() -> None:
    narrow, wide = axis_fit((3.0, 0.1)), axis_fit((5.0, 0.5))
    limits = diagnose_axis(narrow, wide, [Cause("delay", np.array([4.0, 0.49]), 1.0)], rows())
    assert {row.advice for row in advised(rows(), limits)} == {REMEDY["delay"]}
    assert "delay" in advised(rows(), limits)[0].reason
    noise = [replace(row, limit="noise", advice=REMEDY["noise"]) for row in limits]
    assert advised(rows(), noise) == rows()
    assert advised(rows("usable"), limits) == rows("usable")


def test_beside_a_fault_of_the_data_nothing_else_is_advised() -> None:
    fault = Note("sign", "warning", "sway: torque.y is reversed")
    usable, weak = replace(rows("usable")[0], advice=None), rows("weak")[1]
    first, second = mend_first([usable, weak], [fault])
    assert first == usable
    assert second.reason == weak.reason
    assert second.advice == f"{ADVICE}: {fault.text}"
    assert mend_first([weak], []) == [weak]


def test_a_wrong_gain_scales_a_number_and_hides_none() -> None:
    """Beside it a number keeps the advice against its own limit; what hangs on the gain alone gets that against it."""
    fault = Note("force_gain", "warning", "forces do not add up to 68.6 kg: +14 %. Weigh the robot")
    weak = rows("weak")[1]
    doubted = replace(weak, advice=ADVICE)
    assert mend_first([weak, doubted], [fault]) == [weak, replace(weak, advice=REMEDY["force gain"])]
    other = Note("sign", "warning", "sway: torque.y is reversed. Check the sign")
    assert mend_first([weak], [fault, other])[0].advice == f"{ADVICE}: forces do not add up to 68.6 kg: +14 %"


def test_a_number_without_a_width_is_not_diagnosed() -> None:
    nothing = axis_fit((0.0, 0.0))
    assert diagnose_axis(nothing, nothing, [], rows()) == []


def test_every_cause_of_a_width_has_its_remedy() -> None:
    """A cause is the largest in some log: one without a remedy would end that axis in an error of plantar's own."""
    named = set[str]()
    for path in Path(systematic.__file__).parent.glob("*.py"):
        tree = ast.parse(path.read_text())
        constants = {
            node.targets[0].id: node.value.value
            for node in tree.body
            if isinstance(node, ast.Assign)
            and isinstance(node.targets[0], ast.Name)
            and isinstance(node.value, ast.Constant)
        }
        for call in ast.walk(tree):
            if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id == "Cause":
                name = call.args[0]
                named.add(name.value if isinstance(name, ast.Constant) else constants[name.id])  # type: ignore[attr-defined]
    assert {"delay", "imu turn", "between recordings"} <= named
    assert named <= set(REMEDY)
