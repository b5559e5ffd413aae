"""A run that is killed goes on: the tables are the same to the bit, and finished groups are not fitted again."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import psutil
import pytest

from command_line import run
from fleet_samples import small_fleet

GROUPS = 8
OWN = ("--workers", "1")
PATIENCE = 60.0  # s

pytestmark = pytest.mark.skipif(not Path("/proc").is_dir(), reason="processes are found in /proc")


def command(folder: Path, out: str, workers: tuple[str, str]) -> list[str]:
    told = ("--out", str(folder / out), "--model", "kelvin_voigt", "--quiet")
    return ["fleet", "run", str(folder / "fleet.csv"), *told, *workers]


@pytest.fixture(scope="module")
def running(client: Any) -> tuple[str, str]:
    """A worker that is there already: to start one takes longer than all that it does here."""
    return "--scheduler", client.scheduler.address


def units(folder: Path) -> dict[Path, int]:
    """The finished units and when they were written."""
    return {path: path.stat().st_mtime_ns for path in (folder / "units").rglob("*.json")}


def children(parent: int) -> list[int]:
    """The processes that a process started, and theirs: the workers and what watches over them."""
    try:
        return [child.pid for child in psutil.Process(parent).children(recursive=True)]
    except psutil.NoSuchProcess:
        return []


def wait_until(ready: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE
    while not ready():
        assert time.monotonic() < end, "nothing happened"
        time.sleep(0.02)


@pytest.fixture(scope="module")
def fleet(tmp_path_factory: pytest.TempPathFactory, running: tuple[str, str]) -> Path:
    """A fleet and its undisturbed result in `undisturbed`."""
    folder = tmp_path_factory.mktemp("fleet")
    small_fleet(folder, GROUPS)
    assert run(*command(folder, "undisturbed", running)) == 0
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("killed", ["driver", "workers"])
def test_what_is_killed_goes_on(fleet: Path, killed: str, running: tuple[str, str]) -> None:
    out = fleet / killed
    started = subprocess.Popen([sys.executable, "-m", "plantar", *command(fleet, killed, OWN)], cwd=fleet)
    try:
        wait_until(lambda: len(units(out)) >= 3)
        finished = units(out)
        if killed == "driver":
            os.kill(started.pid, signal.SIGKILL)
            started.wait()
            finished = units(out)
            assert len(finished) < GROUPS
            assert run(*command(fleet, killed, running)) == 0
        else:
            for process in children(started.pid):
                os.kill(process, signal.SIGKILL)
            assert started.wait(PATIENCE) == 0
    finally:
        started.kill()
    after = units(out)
    assert len(after) == GROUPS
    assert finished.items() <= after.items()
    for name in ("results.parquet", "failures.parquet"):
        assert (out / name).read_bytes() == (fleet / "undisturbed" / name).read_bytes()
