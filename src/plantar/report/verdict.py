"""The verdict in plain words: what to trust, what not, and why."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from plantar.notes import listed
from plantar.report.content import Mark
from plantar.results.feet import Diagnosis, FeetResult, Parameter, ValidationRow
from plantar.results.feet_text import SYMBOLS
from plantar.results.numbers import number, unit, with_uncertainty

MARKS: Final[dict[str, Mark]] = {"usable": "good", "weak": "weak", "unidentifiable": "bad"}
LEADS: Final = {"usable": "Trust", "weak": "Use with care", "unidentifiable": "Do not use"}
BEYOND: Final = (
    "No interval holds for what these logs do not show: larger angles, another floor, colder or warmer rubber, a sole "
    "whose outline in the robot file is wrong."
)
_ORDER: Final[dict[Mark, int]] = {"good": 0, "": 1, "weak": 2, "bad": 3}


@dataclass(frozen=True)
class Statement:
    """One axis of one foot: a sentence, how it is marked, and what lies behind it."""

    subject: str
    axis: str
    text: str
    mark: Mark
    reasons: tuple[str, ...]


@dataclass(frozen=True)
class FootVerdict:
    foot: str
    statements: tuple[Statement, ...]


def foot_verdicts(parameters: Sequence[Parameter]) -> tuple[FootVerdict, ...]:
    """For each foot a statement per axis, in the result's order."""
    feet = dict.fromkeys(parameter.foot for parameter in parameters)
    given = first_given(parameters)
    return tuple(FootVerdict(foot, tuple(_statements(foot, parameters, given))) for foot in feet)


def first_given(parameters: Sequence[Parameter]) -> dict[str, str]:
    """Each advice, and the number that it is given to first."""
    given: dict[str, str] = {}
    for row in parameters:
        if row.advice:
            given.setdefault(row.advice, f"{row.foot} {row.axis} {symbol(row.name)}")
    return given


def _statements(foot: str, parameters: Sequence[Parameter], given: Mapping[str, str]) -> Iterable[Statement]:
    rows = [parameter for parameter in parameters if parameter.foot == foot]
    for axis in dict.fromkeys(row.axis for row in rows):
        yield statement(f"{foot} {axis}", axis, [row for row in rows if row.axis == axis], given)


def statement(subject: str, axis: str, rows: Sequence[Parameter], given: Mapping[str, str]) -> Statement:
    """`left pitch: K = 480 ± 1 N·m/rad, C = ... — usable`; a number that cannot be trusted is not given.

    An advice stands with the first number that it is `given` to; others name that number.
    """
    marks = [MARKS.get(row.verdict, "") for row in rows]
    worst = max(marks, key=lambda mark: _ORDER[mark])
    if worst == "bad" and set(marks) != {"bad"}:
        worst = "weak"  # one number cannot be told, the other stands there
    verdicts = list(dict.fromkeys(row.verdict for row in rows if row.verdict))
    alone = len(verdicts) == 1
    phrases = [_phrase(row, alone) for row in rows if row.verdict != "unidentifiable"]
    unknown = [symbol(row.name) for row in rows if row.verdict == "unidentifiable"]
    if unknown:
        phrases.append(f"{listed(unknown)} cannot be told from these logs")
    text = ", ".join(phrases)
    if alone and not unknown:
        text += f" — {verdicts[0]}"
    behind: dict[tuple[str, str], list[str]] = {}
    for row in rows:
        if row.reason:
            behind.setdefault((row.reason, row.advice or ""), []).append(symbol(row.name))
    reasons = tuple(
        f"{listed(names)}: {why}{_next(advice, f'{subject} {names[0]}', given)}"
        for (why, advice), names in behind.items()
    )
    return Statement(subject, axis, text, worst, reasons)


def symbol(name: str) -> str:
    """K and C for stiffness and damping; a richer model's term by its name."""
    return SYMBOLS.get(name, name.replace("_", " "))


def _phrase(row: Parameter, alone: bool) -> str:
    text = f"{symbol(row.name)} = {with_uncertainty(row.value, row.half_width)} {unit(row.unit)}".rstrip()
    return text if alone or not row.verdict else f"{text} ({row.verdict})"


def _next(advice: str, name: str, given: Mapping[str, str]) -> str:
    """What to record next for the number of that name."""
    first = given.get(advice, name)
    return f". Next: {advice if first == name else f'as for {first}'}" if advice else ""


@dataclass(frozen=True)
class Limits:
    """What limits each number, and what helps against each of these causes that no number's verdict says."""

    widest: str
    each: tuple[str, ...]
    remedies: tuple[str, ...]


def limits(result: FeetResult) -> Limits:
    """What limits the widest interval among the numbers that may be used, and each number; no advice twice."""
    given = first_given(result.parameters)
    found = widest(result)
    against = {row.limit: row.advice for row in result.diagnosis if row.advice and row.advice not in given}
    return Limits(
        "" if found is None else found.text if found.advice not in given else _cause(found),
        tuple(_cause(row) for row in result.diagnosis) if len(result.diagnosis) > 1 else (),
        tuple(
            f"Against {limit}: {advice}."
            for limit, advice in against.items()
            if found is None or advice != found.advice
        ),
    )


def _cause(row: Diagnosis) -> str:
    """What limits a number, without the advice."""
    return row.text.removesuffix(f" To tighten: {row.advice}") if row.advice else row.text


def widest(result: FeetResult) -> Diagnosis | None:
    """What limits the widest interval among the numbers that may be used; None where none is known."""
    given = {(row.foot, row.axis, row.name) for row in result.parameters if row.verdict != "unidentifiable"}
    known = [row for row in result.diagnosis if (row.foot, row.axis, row.name) in given]
    return max(known, key=lambda row: row.half_width_percent, default=None)


def trust(result: FeetResult) -> tuple[str, ...]:
    """Sentences on what may be used, what only with care, and what not."""
    sentences = []
    for verdict, lead in LEADS.items():
        subjects: dict[str, list[str]] = {}
        for row in result.parameters:
            if row.verdict == verdict:
                subjects.setdefault(f"{row.foot} {row.axis}", []).append(symbol(row.name))
        if subjects:
            sentences.append(
                f"{lead}: {'; '.join(f'{name} {listed(terms)}' for name, terms in subjects.items())}."
            )
    return tuple(sentences)


def reach(result: FeetResult) -> tuple[str, ...]:
    """Sentences on how far the model predicts, and where no interval holds."""
    sentences = [text for kind in ("cross", "direct") for text in _skill(result.validation, kind)]
    if any(row.verdict != "unidentifiable" for row in result.parameters):
        sentences.append(BEYOND)
    return tuple(sentences)


def _skill(validation: Sequence[ValidationRow], kind: str) -> list[str]:
    rows = [row for row in validation if row.kind == kind]
    if not rows:
        return ["No unseen motion was given, so nothing here is cross-validated."] if kind == "cross" else []
    what = "On motions it has not seen" if kind == "cross" else "On the motions that it was fitted to"
    failed = [_not_beaten(row) for row in rows if not row.has_skill]
    beaten = f"{len(rows) - len(failed)} of {len(rows)}"
    text = f"{what}, the model beats predicting the offset alone in {beaten} cases"
    if not failed:
        return [text + "."]
    shown = failed if len(failed) <= 6 else [*failed[:5], f"{len(failed) - 5} more (marked in the table)"]
    return [f"{text}; not for {listed(shown)}."]


def _not_beaten(row: ValidationRow) -> str:
    """Which row, and both errors: where the foot hardly moves they are small, and there is nothing to predict."""
    errors = f"{number(row.mean_abs_error, 2)} against {number(row.zero_mean_abs, 2)}"
    return f"{row.motion} {row.foot} {row.axis} ({errors} {'N' if row.axis == 'z' else 'N·m'})"
