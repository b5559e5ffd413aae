"""Logs for the commands to work on."""

from __future__ import annotations

from pathlib import Path

import pytest

from biped import record, sway
from biped_robot import write_robot
from command_line import write_csv


@pytest.fixture(scope="session")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the biped's robot file and three logs."""
    folder = tmp_path_factory.mktemp("campaign")
    write_robot(folder)
    for seed, name in enumerate(("first", "second", "third")):
        write_csv(record(sway(name, seed, duration=12.0)), folder / f"{name}.csv")
    return folder
