"""A verdict in words: what several numbers need is said with the first of them, and named by the others."""

from __future__ import annotations

from dataclasses import replace

from plantar.report.verdict import foot_verdicts, limits
from plantar.results.feet import Diagnosis, Parameter
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
    assert (other.each, other.remedies) == ((), ())
