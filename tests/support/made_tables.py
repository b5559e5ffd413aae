"""Small tables as files, and what comes of reading them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from plantar.errors import LogError
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log

HEADER = "time,joint.a.position,wrench.left.force.z"


def csv_text(rows: int = 5, header: str = HEADER) -> str:
    columns = header.count(",")
    lines = [",".join([f"{0.01 * i:.2f}", *(f"{i + 0.25 * c}" for c in range(columns))]) for i in range(rows)]
    return "\n".join([header, *lines]) + "\n"


def write(folder: Path, content: str | bytes, name: str = "log.csv") -> Path:
    path = folder / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def refusal(folder: Path, content: str | bytes, name: str = "log.csv") -> str:
    """The one line with which a log is refused; it names the file."""
    path = write(folder, content, name)
    with pytest.raises(LogError) as caught:
        open_log(path)
    message = str(caught.value)
    assert "\n" not in message
    assert name in message
    return message


def codes(log: MotionLog) -> list[str]:
    return [note.code for note in log.notes]


def as_csv(log: MotionLog) -> str:
    names = list(log.columns)
    rows = np.column_stack([log.time, *(log.columns[name] for name in names)])
    return (
        "\n".join([",".join(["time", *names]), *(",".join(map(repr, row)) for row in rows.tolist())]) + "\n"
    )
