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


@dataclass(frozen=True)
class Block:
    """One fenced block: its kind (the word behind the fence), its text, and where that text stands in the page."""

    page: Path
    kind: str
    text: str
    start: int
    line: int

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
    return [
        Block(
            page,
            found["kind"].strip(),
            found["text"],
            found.start("text"),
            text.count("\n", 0, found.start()) + 1,
        )
        for found in FENCE.finditer(text)
    ]


def shown(block: Block) -> list[Shown]:
    """The commands of a `console` block, each with its output."""
    parts = re.split(r"^\$ ", block.text, flags=re.MULTILINE)[1:]
    pairs = [re.match(r"((?:[^\n]*\\\n)*[^\n]*)\n?(.*)", part, re.DOTALL) for part in parts]
    return [Shown(pair[1], pair[2]) for pair in pairs if pair]


def with_outputs(block: Block, outputs: list[str]) -> str:
    """The text of a `console` block with other outputs below its commands."""
    return "".join(f"$ {one.command}\n{output}" for one, output in zip(shown(block), outputs, strict=True))
