"""A verdict in words: what several numbers need is said with the first of them, and named by the others."""

from __future__ import annotations

from dataclasses import replace

import pytest

from plantar.report.verdict import BEYOND, first_given, foot_verdicts, limits, reach, symbol, trust
from plantar.results.feet import Diagnosis, FeetResult, Parameter, ValidationRow
from plantar.results.feet_rows import Verdict
from report_walks import standing_result

ADVICE = "weigh the robot"
FASTER = "sway faster"


def row(foot: str, axis: str, name: str, reason: str, advice: str | None) -> Parameter:
    verdict = "weak" if advice else "usable"
    return Parameter(foot, axis, name, "", 100.0, 5.0, (90.0, 110.0), 1.0, verdict, reason, advice)  # type: ignore[arg-type]


ROWS = (
    row("left", "pitch", "stiffness", "too wide", ADVICE),
    row("left", "pitch", "damping", "noisy", ADVICE),
    row("left", "roll", "stiffness", "too wide", FASTER),
    row("left", "roll", "damping", "too wide", FASTER),
    row("right", "pitch", "stiffness", "too wide", ADVICE),
    row("right", "pitch", "damping", "fine", None),
)


def test_advice_stands_with_the_first_number_that_it_is_given_to() -> None:
    reasons = [statement.reasons for foot in foot_verdicts(ROWS) for statement in foot.statements]
    assert reasons == [
        (f"K: too wide. Next: {ADVICE}", "C: noisy. Next: as for left pitch K"),
        (f"K and C: too wide. Next: {FASTER}",),
        ("K: too wide. Next: as for left pitch K", "C: fine"),
    ]


def test_what_limits_a_number_does_not_say_again_what_its_verdict_says() -> None:
    def diagnosis(name: str, percent: float, limit: str, advice: str) -> Diagnosis:
        text = f"left pitch {name}: ±{percent} %. To tighten: {advice}"
        return Diagnosis("left", "pitch", name, limit, {limit: 1.0}, percent, text, advice)

    known = diagnosis("stiffness", 20.0, "force gain", ADVICE)
    fresh = diagnosis("damping", 10.0, "noise", "record for longer")
    said = limits(replace(standing_result(), parameters=ROWS, diagnosis=(known, fresh)))
    assert said.widest == "left pitch stiffness: ±20.0 %."
    assert said.each == ("left pitch stiffness: ±20.0 %.", "left pitch damping: ±10.0 %.")
    assert said.remedies == ("Against noise: record for longer.",)
    other = limits(replace(standing_result(), parameters=ROWS, diagnosis=(fresh,)))
    assert other.widest == fresh.text
    assert other.remedies == ()
    lost = [replace(row, verdict="unidentifiable") for row in ROWS]
    none = limits(replace(standing_result(), parameters=lost, diagnosis=(known, fresh)))
    assert (none.widest, none.remedies) == ("", said.remedies)
    assert (other.each, other.remedies) == ((), ())


@pytest.mark.parametrize(
    ("verdicts", "mark", "said"),
    [
        (("usable", "usable"), "good", "K = 400 ± 8 N·m/rad, C = 400 ± 8 N·m/rad — usable"),
        (("usable", "weak"), "weak", "K = 400 ± 8 N·m/rad (usable), C = 400 ± 8 N·m/rad (weak)"),
        (("weak", "weak"), "weak", "K = 400 ± 8 N·m/rad, C = 400 ± 8 N·m/rad — weak"),
        (
            ("usable", "unidentifiable"),
            "weak",
            "K = 400 ± 8 N·m/rad (usable), C cannot be told from these logs",
        ),
        (("unidentifiable", "unidentifiable"), "bad", "K and C cannot be told from these logs"),
    ],
)
def test_an_axis_is_marked_by_its_worst_number_and_says_no_number_that_nobody_may_use(
    verdicts: tuple[Verdict, Verdict], mark: str, said: str
) -> None:
    rows = [
        Parameter("left", "pitch", name, "N.m/rad", 400.0, 4.0, (392.0, 408.0), 0.1, verdict, "")
        for name, verdict in zip(("stiffness", "damping"), verdicts, strict=True)
    ]
    ((found,),) = (one.statements for one in foot_verdicts(rows))
    assert (found.mark, found.text, found.reasons) == (mark, said, ())


def test_motions_that_teach_nothing_are_named_and_many_are_counted() -> None:
    def row(motion: str, error: float) -> ValidationRow:
        return ValidationRow("cross", motion, "left", "pitch", error, error, 9.0, 1.0, 1.0, 10)

    result = FeetResult("b", (), {}, "kelvin_voigt", (), (), (), (row("a", 0.5), row("b", 2.0)), ())
    assert trust(result) == ()
    assert reach(result) == (
        "On motions it has not seen, the model beats predicting the offset alone in 1 of 2 cases; not for b "
        "left pitch (2.0 against 1.0 N·m).",
    )
    lost = tuple(row(f"m{place}", 2.0) for place in range(8))
    (text,) = reach(replace(result, validation=lost))
    assert text.endswith("m4 left pitch (2.0 against 1.0 N·m) and 3 more (marked in the table).")
    assert "in 0 of 8 cases" in text
    (text,) = reach(replace(result, validation=lost[:6]))
    assert text.endswith("m4 left pitch (2.0 against 1.0 N·m) and m5 left pitch (2.0 against 1.0 N·m).")


@pytest.mark.parametrize(("verdict", "told"), [("usable", True), ("weak", True), ("unidentifiable", False)])
def test_any_number_that_is_known_has_a_limit_beyond_which_it_is_not(verdict: Verdict, told: bool) -> None:
    parameters = [replace(one, verdict=verdict) for one in ROWS]
    assert (BEYOND in reach(replace(standing_result(), parameters=parameters))) == told


def test_terms_of_richer_models_are_told_by_their_names_and_numbers_without_advice_give_none() -> None:
    assert [symbol(name) for name in ("stiffness", "damping", "slip_torque")] == ["K", "C", "slip torque"]
    assert first_given(ROWS) == {ADVICE: "left pitch K", FASTER: "left roll K"}
