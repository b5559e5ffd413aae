"""A page's commands and snippets, run in their order in one folder, as a reader would."""

from __future__ import annotations

import contextlib
import doctest
import io
import json
import os
import shlex
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from command_line import run
from page_blocks import Block, blocks, cut

# Commands that set a machine up; a test of the documents does not.
SET_UP = ("pip", "git", "make", "python3", "cd")
ELLIPSIS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
StandIns = Mapping[str, Callable[[list[str]], None]]


@dataclass
class Reader:
    """Somebody who types what a page says, in `folder`.

    `instead`: by command, what takes the words behind it where the twin shall not play; `names` is what the page's
    Python snippets have defined so far; `outputs` is what was printed that the page shows, by block.
    """

    folder: Path
    instead: StandIns = field(default_factory=dict)
    names: dict[str, Any] = field(default_factory=dict)
    outputs: dict[Block, list[str]] = field(default_factory=dict)

    def read(self, page: Path) -> None:
        """Run every block of the page that is meant to be typed."""
        printed = ""
        with inside(self.folder):
            for block in blocks(page):
                if block.kind == "python":
                    printed = self._python(block.text, block.where)
                elif block.kind == "output":
                    self.outputs[block] = [printed]
                elif block.kind == "sh":
                    for command in block.commands():
                        self.type(command, block.where)
                elif block.kind == "console":
                    self.outputs[block] = [self.type(command, block.where) for command in block.commands()]

    def run_notebook(self, notebook: Path) -> None:
        """Run every code cell of an `.ipynb`; a cell whose lines begin with `!` holds commands."""
        cells = json.loads(notebook.read_text())["cells"]
        with inside(self.folder):
            for number, cell in enumerate(cells):
                text, where = "".join(cell["source"]), f"{notebook.name}, cell {number}"
                if cell["cell_type"] == "code" and text.startswith("!"):
                    for line in text.splitlines():
                        self.type(line.removeprefix("!"), where)
                elif cell["cell_type"] == "code":
                    self._python(text, where)

    def _python(self, text: str, where: str) -> str:
        """What a snippet prints."""
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(text, where, "exec"), self.names)
        return printed.getvalue()

    def type(self, command: str, where: str) -> str:
        """What one command prints on stdout; AssertionError with its stderr where it fails."""
        line, _, target = command.partition(" > ")
        quoted = {word[1:-1] for word in shlex.split(line, posix=False) if word[0] in "'\""}
        words = [
            match for word in shlex.split(line) for match in ([word] if word in quoted else globbed(word))
        ]
        if words[0] in SET_UP:
            return ""
        printed, complained = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(complained):
            code = self._done(words, line, complained)
        assert code == 0, f"{where}: {command}\n{complained.getvalue()}"
        if target:
            Path(target.strip()).write_text(printed.getvalue())
            return ""
        return printed.getvalue()

    def _done(self, words: list[str], line: str, complained: io.StringIO) -> int:
        if words[0] == "plantar" and words[1] in self.instead:
            self.instead[words[1]](words[2:])
            return 0
        if words[0] == "plantar":
            return run(*words[1:])
        path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])
        done = subprocess.run(
            line, shell=True, capture_output=True, text=True, check=False, env={**os.environ, "PATH": path}
        )
        print(done.stdout, end="")
        print(done.stderr, end="", file=complained)
        return done.returncode


def globbed(word: str) -> list[str]:
    """The files that a word with `*` names, as a shell gives them; else the word."""
    if "*" not in word:
        return [word]
    found = sorted(str(path) for path in Path().glob(word) if ".truth" not in path.name)
    assert found, f"{word}: no such file"
    return found


def same(expected: str, printed: str) -> bool:
    """Whether an output is the one shown; `...` stands for anything, spaces count as one."""
    return doctest.OutputChecker().check_output(cut(expected, None), cut(printed, None), ELLIPSIS)


@contextlib.contextmanager
def inside(folder: Path) -> Iterator[None]:
    """`folder` as the working directory, and pictures that need no screen."""
    before, backend = Path.cwd(), os.environ.get("MPLBACKEND")
    os.chdir(folder)
    os.environ["MPLBACKEND"] = "agg"
    try:
        yield
    finally:
        os.chdir(before)
        if backend is None:
            del os.environ["MPLBACKEND"]
        else:
            os.environ["MPLBACKEND"] = backend
