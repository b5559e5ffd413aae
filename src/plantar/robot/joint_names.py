"""What logs call the joints of a URDF, and how to guess it: prefix, suffix, other letters, another order of words."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

WORD = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|[0-9]+")
MEANT = {"l": "left", "r": "right"}
SILENT = {
    "joint",
    "jnt",
    "j",
    "motor",
    "actuator",
    "link",
    "position",
    "pos",
    "state",
    "q",
}  # say nothing of which
MOST_SHOWN = 3  # pairs of names in a message


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
        pairs = [f"{name}: {other}" for name, other in self.renamed.items()]
        more = ["..."] if len(pairs) > MOST_SHOWN else []
        listed = f"{{{', '.join(pairs[:MOST_SHOWN] + more)}}}"
        parts = {"prefix": self.prefix, "suffix": self.suffix, "renamed": listed if pairs else ""}
        return f"joint_names: {{{', '.join(f'{key}: {part}' for key, part in parts.items() if part)}}}"


def propose_names(joints: Collection[str], recorded: Collection[str]) -> JointNames | None:
    """The naming that gives most of the `joints` that a log lacks under their own name one of its `recorded` names.

    None where no naming gives half of the fewer of both.
    """
    missing = [name for name in joints if name not in set(recorded)]
    free = [name for name in recorded if name not in set(joints)]
    proposals = (_affixes(missing, free), _shorter(missing, free), _bywords_of(missing, free))
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


def _bywords_of(missing: Sequence[str], free: Sequence[str]) -> JointNames:
    """Names of the same words in any letters and any order, where only one on each side has them."""
    ours, theirs = (Counter(words_of(name) for name in names) for names in (missing, free))
    by_words = {words_of(other): other for other in free}
    renamed = {
        name: by_words[words]
        for name in missing
        if (words := words_of(name)) and ours[words] == theirs[words] == 1
    }
    return JointNames(renamed=renamed)


def words_of(name: str) -> tuple[str, ...]:
    """The words of a name in lower case and in one order, l and r written out, without those that tell nothing."""
    words = [word.lower() for word in WORD.findall(name)]
    return tuple(sorted(MEANT.get(word, word) for word in words if word not in SILENT))
