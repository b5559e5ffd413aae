"""What a fault came to: caught, warned, harmless, or the one thing that must never be, a wrong number called usable.

Stiffness and damping of pitch and roll are scored; the vertical stiffness is `coverage.py`'s.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from fault_case import Fault
from fault_twins import Truth
from plantar.errors import PlantarError
from plantar.results.feet import FeetResult, Parameter

SILENT, TRACEBACK, UNNAMED, CAUGHT, WARNED, HARMLESS, ALARM, QUIET = (
    "SILENT WRONG", "TRACEBACK", "unnamed", "caught", "warned", "harmless", "FALSE ALARM", "healthy",
)  # fmt: skip
HARMFUL = (SILENT, TRACEBACK, UNNAMED, CAUGHT)
OFF = {"stiffness": 0.02, "damping": 0.10}  # beyond it a number is wrong, unless its interval holds the truth
RECORDING_ADVICE = frozenset({"delay_unknown", "delay_poorly_known", "noisy_regressors", "model_caution"})
"""Warnings that ask for other motions: right also of healthy logs."""

FOLDERS = r"/\S*/"  # of files that are gone when the table is read

Answer = FeetResult | Exception


@dataclass(frozen=True)
class Score:
    """One fault's outcome. `named`: the right reason was given; `wrong`: numbers that are off, usable ones first;
    `said`: what the user reads first of it."""

    outcome: str
    named: bool
    wrong: tuple[str, ...]
    said: str


def score(fault: Fault, answer: Answer, truth: Truth, healthy: FeetResult) -> Score:
    """The outcome of one fault, beside the result on the same logs without it."""
    if isinstance(answer, Exception):
        said = f"{type(answer).__name__}: {re.sub(FOLDERS, '', str(answer))}"
        if not isinstance(answer, PlantarError):
            return Score(TRACEBACK, False, (), said)
        named = _names(fault, [said])
        return Score(ALARM if fault.kind == "healthy" else CAUGHT if named else UNNAMED, named, (), said)
    said_now = list(_said(answer, healthy, every=fault.kind == "healthy"))
    named = _names(fault, said_now)
    first = next((text for text in said_now if named and _names(fault, [text])), next(iter(said_now), ""))
    if any(note.code == "internal_error" for note in answer.notes):
        return Score(TRACEBACK, named, (), first)
    before = {(row.foot, row.axis, row.name): row.verdict for row in healthy.parameters}
    silent, weak, lost = [], [], []
    for row in _rotational(answer):
        error = _error(row, truth)
        if error is not None and _wrong(row, error):
            (silent if row.verdict == "usable" else weak).append(f"{_short(row)} {100 * error:+.1f} %")
        elif row.verdict != "usable" and before.get((row.foot, row.axis, row.name)) == "usable":
            lost.append(f"{_short(row)} lost")
    wrong = (*sorted(silent, key=_size, reverse=True), *sorted(weak, key=_size, reverse=True), *lost)
    if fault.kind == "healthy":
        # A number that was weak before may be so for one more reason: one that is lost is among the wrong ones.
        odd = {note.code for note in answer.notes if note.severity == "warning"} - RECORDING_ADVICE
        return Score(SILENT if silent else ALARM if odd or wrong else QUIET, False, wrong, first)
    if silent:
        outcome = SILENT
    elif wrong:
        outcome = CAUGHT if named else UNNAMED
    else:
        outcome = WARNED if named else HARMLESS
    return Score(outcome, named, wrong, first)


def _said(answer: FeetResult, healthy: FeetResult, every: bool) -> Iterator[str]:
    """Warnings, and reasons of verdicts, that the healthy logs do not have; `every`: these warnings too."""
    usual = {note.code for note in healthy.notes if note.severity == "warning" and not every}
    for note in answer.notes:
        if note.severity == "warning" and note.code not in usual:
            yield f"{note.code}: {note.text}"
    old = {_without_numbers(row.reason) for row in healthy.parameters}
    for row in _rotational(answer):
        if row.verdict != "usable" and _without_numbers(row.reason) not in old:
            yield f"{_short(row)}: {row.reason}"


def _without_numbers(reason: str) -> str:
    """A reason that is the same but for an interval of 51 % instead of 49 % tells of no fault."""
    return re.sub(r"\d[\d.]*", "", reason)


def _rotational(answer: FeetResult) -> Iterator[Parameter]:
    return (row for row in answer.parameters if row.axis != "z")


def _names(fault: Fault, texts: Sequence[str]) -> bool:
    return any(re.search(word, text, re.IGNORECASE) for word in fault.words for text in texts)


def _error(row: Parameter, truth: Truth) -> float | None:
    """How far a number is off, as a share; None where there is none, or no truth for it."""
    if row.value is None or row.name not in OFF:
        return None
    return row.value / truth[row.foot][f"{row.axis}_{row.name}"] - 1


def _wrong(row: Parameter, error: float) -> bool:
    assert row.value is not None
    low, high = row.interval95 or (row.value, row.value)
    known = row.value / (1 + error) if error != -1 else 0.0
    return abs(error) > OFF[row.name] and not low <= known <= high


def _short(row: Parameter) -> str:
    """A number's name: `left pitch K`."""
    return f"{row.foot} {row.axis} {'K' if row.name == 'stiffness' else 'C' if row.name == 'damping' else row.name}"


def _size(text: str) -> float:
    return abs(float(text.split()[-2]))


def totals(scores: Sequence[tuple[Fault, Score]]) -> list[str]:
    """The matrix in some lines: outcomes, silent wrong ones, harmful faults named, false alarms."""
    counts = Counter(score.outcome for _, score in scores)
    faults = [each for fault, each in scores if fault.kind != "healthy"]
    harmful = [each for each in faults if each.outcome in HARMFUL]
    named = sum(each.named for each in harmful)
    well = [each for fault, each in scores if fault.kind == "healthy"]
    share = f"{100 * named / len(harmful):.0f} %" if harmful else "-"
    return [
        f"{len(faults)} faults: "
        + ", ".join(f"{count} {outcome}" for outcome, count in counts.most_common()),
        f"silent wrong: {counts[SILENT]}; tracebacks: {counts[TRACEBACK]}",
        f"harmful faults named with the right reason: {named} of {len(harmful)} ({share})",
        f"false alarms on healthy logs: {sum(each.outcome != QUIET for each in well)} of {len(well)}",
    ]
