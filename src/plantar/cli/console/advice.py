"""What is not usable, why, and what to record next, as lines for a terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from plantar.results.feet import Parameter, Verdict


def advised(parameters: Sequence[Parameter]) -> Iterator[tuple[Verdict, str, str]]:
    """Verdict, names and the rest of the line for numbers that are not usable; those with the same reason share a line,
    and advice that was given is not repeated but named by whom it was given to."""
    alike: dict[tuple[Verdict, str, str], list[str]] = {}
    for row in parameters:
        if row.verdict != "usable":
            name = f"{row.foot} {row.axis} {row.name}"
            alike.setdefault((row.verdict, row.reason, row.advice or ""), []).append(name)
    given: dict[str, str] = {}
    for (verdict, reason, advice), names in alike.items():
        said = f"as for {given[advice]}" if advice in given else advice
        given.setdefault(advice, names[0])
        yield verdict, ", ".join(names), f"{reason}. Next: {said}." if advice else f"{reason}."
