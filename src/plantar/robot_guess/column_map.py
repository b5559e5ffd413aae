"""A map of the logs' columns in a file of its own, as `plantar init --columns` takes it."""

from __future__ import annotations

from pathlib import Path

import yaml

from plantar.errors import RobotError, located
from plantar.files import read_bounded
from plantar.robot.schema import refuse_bombs

KEY = "columns"
LIMIT = 2**20  # bytes, as of a robot file
OWN_DOCUMENT = ("---", "...", "%")  # lines that begin so cannot stand within a file


def read_column_map(path: Path) -> str:
    """The file's text, to stand at the end of a robot file. RobotError: it is no YAML with the key `columns` alone.

    What the map says is checked where a log is read by it.
    """
    content = read_bounded(path, LIMIT, RobotError)
    try:
        refuse_bombs(content, path)
        data = yaml.safe_load(content)
        text = content.decode("utf-8-sig")
    except (yaml.YAMLError, ValueError) as error:
        reason = " ".join(str(getattr(error, "problem", None) or error).split())
        raise RobotError(located(f"is not readable YAML: {reason}", path=path)) from error
    if not isinstance(data, dict) or set(data) != {KEY} or not isinstance(data[KEY], dict):
        raise RobotError(
            located("is no map of columns", path=path, valid=f"one key, {KEY}:, and the map below it")
        )
    if any(line.startswith(OWN_DOCUMENT) for line in text.splitlines()):
        return yaml.safe_dump(data, sort_keys=False, allow_unicode=True)
    return text if text.endswith("\n") else f"{text}\n"
