"""`plantar` as a user calls it, in this process, and the text files that it is given."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from plantar.cli import main
from plantar.logs.motion_log import MotionLog


def write_csv(log: MotionLog, path: Path) -> Path:
    header = ",".join(["time", *log.columns])
    np.savetxt(
        path,
        np.column_stack([log.time, *log.columns.values()]),
        delimiter=",",
        header=header,
        comments="",
        fmt="%.10g",
    )
    return path


def run(*arguments: object) -> int:
    """The exit code of `plantar ARGUMENTS`."""
    try:
        main([str(argument) for argument in arguments])
    except SystemExit as done:
        return 0 if done.code is None else int(done.code)
    return 0


def refused(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    """The one line on stderr with which a command fails."""
    assert run(*arguments) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    lines = [line for line in captured.err.splitlines() if not line.startswith("  ")]
    assert len(lines) == 1, captured.err
    assert lines[0].startswith("plantar: ")
    return lines[0]


def identifying_first(campaign: Path, out: Path) -> list[object]:
    """The words that identify the feet from a campaign's first log."""
    return ["identify", "feet", campaign / "robot.yaml", campaign / "first.csv", "--out", out]
