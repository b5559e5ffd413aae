"""A map of the logs' columns in a file of its own, as `plantar init --columns` takes it."""

from __future__ import annotations

from pathlib import Path

import yaml

from plantar.errors import RobotError
from plantar.robot.schema import read_yaml

KEY = "columns"
OWN_DOCUMENT = ("---", "...", "%")  # lines that begin so cannot stand within a file


def read_column_map(path: Path) -> str:
    """The file's text, to stand at the end of a robot file. RobotError: it is no YAML with the key `columns` alone.

    What the map says is checked where a log is read by it.
    """
    data, content = read_yaml(path)
    if not isinstance(data, dict) or set(data) != {KEY} or not isinstance(data[KEY], dict):
        raise RobotError("is no map of columns", path=path, valid=f"one key, {KEY}:, and the map below it")
    written_anew = yaml.safe_dump(data, sort_keys=False, allow_unicode=True)
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:  # YAML in another encoding than the robot file's
        return written_anew
    if any(line.startswith(OWN_DOCUMENT) for line in text.splitlines()):
        return written_anew
    return text if text.endswith("\n") else f"{text}\n"
