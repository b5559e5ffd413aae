"""What logs call the joints of a URDF, and how to guess it: prefix, suffix, other letters, another order of words."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Collection, Hashable, Mapping, Sequence
from dataclasses import dataclass, field

from plantar.notes import NAMED

WORD = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|[0-9]+")
MEANT = {"l": "left", "r": "right"}
# Words that say nothing of which joint it is.
SILENT = {"joint", "jnt", "j", "motor", "actuator", "link", "position", "pos", "state", "q"}
SIDES = re.compile(r"left|right")
_NOTHING = "|".join(sorted(word for word in SILENT if len(word) > 1))
AT_ENDS = re.compile(rf"^({_NOTHING})|({_NOTHING})$")
NUMBERED = re.compile(r"(\D*?)0*([0-9]+)(\D*)")


@dataclass(frozen=True)
class JointNames:
    """What logs call the URDF's joints: prefix + name + suffix, but for those in `renamed` (URDF's name -> log's)."""

    prefix: str = ""
    suffix: str = ""
    renamed: Mapping[str, str] = field(default_factory=dict)

    def in_log(self, joint: str) -> str:
        """The log's name of a joint of the URDF."""
        return self.renamed.get(joint, f"{self.prefix}{joint}{self.suffix}")

    def entry(self) -> dict[str, object]:
        """The same as the robot file's key `joint_names` holds it."""
        parts = {"prefix": self.prefix, "suffix": self.suffix, "renamed": dict(self.renamed)}
        return {key: value for key, value in parts.items() if value}

    def __str__(self) -> str:
        """The robot file's line, long lists cut."""
        quoted = {name: f"'{other}'" if other.isdigit() else other for name, other in self.renamed.items()}
        pairs = [f"{name}: {other}" for name, other in quoted.items()]
        more = ["..."] if len(pairs) > NAMED else []
        listed = f"{{{', '.join(pairs[:NAMED] + more)}}}"
        parts = {"prefix": self.prefix, "suffix": self.suffix, "renamed": listed if pairs else ""}
        return f"joint_names: {{{', '.join(f'{key}: {part}' for key, part in parts.items() if part)}}}"


def propose_names(joints: Collection[str], recorded: Collection[str]) -> JointNames | None:
    """The naming that gives most of the `joints` that a log lacks under their own name one of its `recorded` names.

    Tried are a prefix and suffix, other letters, another order of words, and words or marks that say nothing. None
    where no naming gives half of the fewer of both.
    """
    missing, free = _apart(joints, recorded)
    proposals = (
        _affixes(missing, free),
        _shorter(missing, free),
        _alike(missing, free, words_of),
        _alike(missing, free, _distinct_words(missing, free)),
        _alike(missing, free, _letters_of(free)),
    )
    reached = [sum(one.in_log(name) in set(free) for name in missing) for one in proposals]
    best = max(range(len(proposals)), key=reached.__getitem__)
    enough = bool(free and missing) and 2 * reached[best] >= min(len(free), len(missing))
    return proposals[best] if enough else None


def _affixes(missing: Sequence[str], free: Sequence[str]) -> JointNames:
    """The commonest text before and after the URDF's names."""
    around = Counter(
        (other[:at], other[at + len(name) :])
        for name in missing
        for other in free
        if (at := other.find(name)) >= 0
    )
    return JointNames(*around.most_common(1)[0][0]) if around else JointNames()


def _shorter(missing: Sequence[str], free: Sequence[str]) -> JointNames:
    """The URDF's names without what is commonest before and after them."""
    turned = _affixes(free, missing)
    whole = {f"{turned.prefix}{other}{turned.suffix}": other for other in free}
    return JointNames(renamed={name: whole[name] for name in missing if name in whole})


def propose_order(joints: Sequence[str], recorded: Collection[str]) -> JointNames | None:
    """The naming by the URDF's order of joints, where a log only numbers as many as it has; None for other logs.

    Nothing says that the log has the URDF's order: whoever takes this must say so.
    """
    missing, free = _apart(joints, recorded)
    parts = [NUMBERED.fullmatch(name) for name in free]
    if not free or len(free) != len(joints) or len(missing) != len(joints):
        return None
    if len({part and (part[1], part[3]) for part in parts}) != 1 or parts[0] is None:
        return None
    by_number = {int(part[2]): name for part, name in zip(parts, free, strict=True) if part}
    first = min(by_number)
    if first > 1 or sorted(by_number) != list(range(first, first + len(joints))):
        return None
    return JointNames(renamed={joint: by_number[first + place] for place, joint in enumerate(joints)})


def _apart(joints: Collection[str], recorded: Collection[str]) -> tuple[list[str], list[str]]:
    """The URDF's names that a log lacks, and the log's that the URDF lacks."""
    missing = [name for name in joints if name not in set(recorded)]
    return missing, [name for name in recorded if name not in set(joints)]


def _alike(missing: Sequence[str], free: Sequence[str], key: Callable[[str], Hashable]) -> JointNames:
    """Names with the same key, where only one on each side has it."""
    ours, theirs = (Counter(map(key, names)) for names in (missing, free))
    by_key = {key(other): other for other in free}
    renamed = {name: by_key[own] for name in missing if (own := key(name)) and ours[own] == theirs[own] == 1}
    return JointNames(renamed=renamed)


def _distinct_words(ours: Sequence[str], theirs: Sequence[str]) -> Callable[[str], Hashable]:
    """A key of the words of a name without those that every name of its side has, such as the robot's."""
    shared = {
        name: set.intersection(*(set(words_of(other)) for other in names)) if len(names) > 1 else set[str]()
        for names in (ours, theirs)
        for name in names
    }
    return lambda name: tuple(word for word in words_of(name) if word not in shared[name])


def _letters_of(names: Sequence[str]) -> Callable[[str], str]:
    """A key of the letters and digits of a name, left and right by their initials, without what says nothing; names of
    the log also without the text that all of them begin with, if a mark such as a slash ends it."""
    ends = min(names, default=""), max(names, default="")  # what these two begin with, all do
    same = next((k for k, (a, b) in enumerate(zip(*ends, strict=False)) if a != b), 0)
    prefix = re.sub(r"[A-Za-z0-9]*$", "", ends[0][:same])

    def letters(name: str) -> str:
        own = name.removeprefix(prefix) if name in set(names) else name
        plain = re.sub(r"[^a-z0-9]", "", own.lower())
        return SIDES.sub(lambda side: side[0][0], AT_ENDS.sub("", plain))

    return letters


def words_of(name: str) -> tuple[str, ...]:
    """The words of a name in lower case and in one order, l and r written out, without those that tell nothing."""
    words = [word.lower() for word in WORD.findall(name)]
    return tuple(sorted(MEANT.get(word, word) for word in words if word not in SILENT))
