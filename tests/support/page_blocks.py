"""The fenced blocks of a page: what a reader is told to type, and what is shown as its output."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FENCE = re.compile(
    r"^(?P<fence>`{3,})(?P<kind>[^\n`]*)\n(?P<text>.*?)^(?P=fence)[ ]*$", re.MULTILINE | re.DOTALL
)
RUN = ("sh", "console", "python")  # what a reader types: commands; commands with their output; Python
PRINTED = "output"  # what the Python above prints


@dataclass(frozen=True)
class Block:
    """One fenced block: its kind (the word behind the fence), its text, and where that text stands in the page; `most`
    is how many lines of an output it shows, all where None (`console` and `lines=8` behind the fence)."""

    page: Path
    kind: str
    text: str
    start: int
    line: int
    most: int | None = None

    @property
    def where(self) -> str:
        return f"{self.page.parent.name}/{self.page.name}:{self.line}"

    def commands(self) -> list[str]:
        """The commands of an `sh` or `console` block, continued lines joined, comments left out."""
        joined = re.sub(r"\\\n\s*", "", self.text)
        lines = joined.splitlines()
        if self.kind == "console":
            lines = [line[2:] for line in lines if line.startswith("$ ")]
        lines = [re.sub(r"\s+# .*$", "", line).strip() for line in lines]
        return [line for line in lines if line and not line.startswith("#")]


@dataclass(frozen=True)
class Shown:
    """One command of a `console` block with the output shown below it."""

    command: str
    output: str


def blocks(page: Path) -> list[Block]:
    """Every fenced block of a page, in order."""
    text = page.read_text()
    made = []
    for found in FENCE.finditer(text):
        kind, _, most = found["kind"].strip().partition(" lines=")
        line = text.count("\n", 0, found.start()) + 1
        made.append(Block(page, kind, found["text"], found.start("text"), line, int(most) if most else None))
    return made


def shown(block: Block) -> list[Shown]:
    """The commands of a `console` block, each with its output; an `output` block has no command."""
    if block.kind == PRINTED:
        return [Shown("", block.text)]
    parts = re.split(r"^\$ ", block.text, flags=re.MULTILINE)[1:]
    pairs = [re.match(r"((?:[^\n]*\\\n)*[^\n]*)\n?(.*)", part, re.DOTALL) for part in parts]
    return [Shown(pair[1], pair[2]) for pair in pairs if pair]


def with_outputs(block: Block, outputs: list[str]) -> str:
    """The text of a `console` block with other outputs below its commands, cut where the block says so."""
    heads = (f"$ {one.command}\n" if one.command else "" for one in shown(block))
    return "".join(head + cut(output, block.most) for head, output in zip(heads, outputs, strict=True))


def cut(output: str, most: int | None) -> str:
    """The first `most` lines of an output, without spaces at their ends; `...` stands for the rest."""
    lines = [line.rstrip() for line in output.strip("\n").splitlines()]
    if most is not None and len(lines) > most:
        lines = [*lines[:most], "..."]
    return "".join(f"{line}\n" for line in lines)
