"""Which numbers of a robot file are still guesses: those on lines that a comment marks with GUESS.

`plantar init` writes such marks; whoever has measured a number deletes its mark. YAML drops comments, so the marks are
read from the text. A mark at the end of a line belongs to the key that starts on this line, a mark on a line of its own
to the next key. `± 20 mm` or `± 2 deg` after the word says by how much the guess may be off.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import yaml

from plantar.notes import Note, listed

MARK = re.compile(
    r"(?:^|\s)#\s*GUESS\b(?:\s*±\s*(?P<spread>[0-9.]*[0-9])\s*(?P<unit>mm|deg))?[\s:]*(?P<reason>.*)"
)
UTF_16 = (b"\xff\xfe", b"\xfe\xff")  # how YAML in UTF-16 begins
UNITS = {"mm": 1e-3, "deg": math.pi / 180}


@dataclass(frozen=True)
class Guess:
    """One key whose value is a guess, such as `feet.left.bush`.

    spread: by how much it may be off [m, or rad for a direction], None where the mark does not say;
    reason: what the guess rests on.
    """

    key: str
    reason: str
    spread: float | None = None


def read_guesses(content: bytes) -> tuple[Guess, ...]:
    """The marked keys of a robot file, in its order; it must be readable YAML without aliases."""
    text = content.decode("utf-16" if content[:2] in UTF_16 else "utf-8-sig")
    if "GUESS" not in text:
        return ()
    root = yaml.compose(text, Loader=yaml.SafeLoader)
    keys: dict[int, str] = {}
    quoted: list[range] = []
    for name, node in _keys(root, ()):
        keys.setdefault(node.start_mark.line, ".".join(name))  # the outermost key comes first
    for scalar in _scalars(root):
        if scalar.style in ("'", '"', "|", ">"):
            quoted.append(range(scalar.start_mark.index, scalar.end_mark.index))
    found, at = [], 0
    for number, line in enumerate(text.splitlines(keepends=True)):
        mark = MARK.search(line.rstrip("\r\n"))
        if mark is not None and not any(at + line.index("#", mark.start()) in span for span in quoted):
            place = next((row for row in sorted(keys) if row >= number), None)
            if place is not None:
                unit, size = mark["unit"], mark["spread"]
                spread = float(size) * UNITS[unit] if unit else None
                found.append(Guess(keys[place], mark["reason"].strip(), spread))
        at += len(line)
    return tuple(found)


def guess_notes(file: str, guesses: Sequence[Guess]) -> list[Note]:
    """One warning that lists what is still a guess in a robot file, foot by foot; none where nothing is."""
    if not guesses:
        return []
    feet: dict[str, list[str]] = {}
    others: list[str] = []
    for guess in guesses:
        head, *rest = guess.key.split(".")
        part = ".".join(rest[1:] if head == "feet" else [head, *rest])
        spread = f" (± {1e3 * guess.spread:.0f} mm)" if guess.spread and guess.key.endswith("bush") else ""
        if head == "feet" and len(rest) > 1:
            feet.setdefault(rest[0], []).append(part + spread)
        else:
            others.append(guess.key)
    parts = [f"the {foot} foot's numbers depend on {listed(names)}" for foot, names in feet.items()]
    if others:
        parts.append(f"all numbers depend on {listed(others)}")
    text = (
        f"{file}: marked GUESS and not measured: {'; '.join(parts)}. {_first(guesses)}, then delete the mark"
    )
    return [Note("guessed_geometry", "warning", text)]


def _first(guesses: Sequence[Guess]) -> str:
    """What to measure first: the intervals allow for what may be wrong about bush, wrench and IMU, and for no sole."""
    if any(guess.key.split(".")[-1] in ("sole", "polygon") for guess in guesses):
        return "Measure the soles first, for which the intervals do not allow"
    return "The intervals allow for that; measure it for narrower ones"


def naming_notes(file: str, guesses: Sequence[Guess]) -> list[Note]:
    """A warning where it is a guess which joint of the logs is which; no number may rest on that."""
    if not any(guess.key.partition(".")[0] == "joint_names" for guess in guesses):
        return []
    text = f"{file}: joint_names is marked GUESS: which joint of the logs is which must be looked up, not guessed"
    return [Note("guessed_joint_names", "warning", text)]


def _keys(node: yaml.Node | None, above: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], yaml.Node]]:
    """Every key with its path, outer ones before those inside."""
    if isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            path = (*above, str(key.value))
            yield path, key
            yield from _keys(value, path)


def _scalars(node: yaml.Node | None) -> Iterator[yaml.ScalarNode]:
    if isinstance(node, yaml.ScalarNode):
        yield node
    elif isinstance(node, yaml.MappingNode):
        for pair in node.value:
            for part in pair:
                yield from _scalars(part)
    elif isinstance(node, yaml.SequenceNode):
        for part in node.value:
            yield from _scalars(part)
