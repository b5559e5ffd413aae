"""The same result, to the last bit, on any number of cores, from files and from logs in memory."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any

import pytest

from biped import record, sway
from plantar import cores
from plantar.feet.first_look import looked_at
from plantar.feet.identify import identify_feet
from plantar.logs.inputs import WaitingLogs, logs_of
from plantar.logs.save import save_log
from plantar.robot.model import RobotModel

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="processes are copied on Linux")


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    folder = tmp_path_factory.mktemp("logs")
    motions = [sway(name, seed, duration=14.0) for seed, name in enumerate(("first", "second"))]
    paths = [folder / f"{motion.name}.csv" for motion in motions]
    for motion, path in zip(motions, paths, strict=True):
        save_log(record(motion), path)
    return paths


def found_on(
    count: int, robot: RobotModel, files: list[Path], folder: Path, monkeypatch: pytest.MonkeyPatch
) -> tuple[dict[str, Any], bytes, int]:
    """result.json and the residuals on so many cores, and in how many copies of the process work was done."""
    forked, handed = [], []
    fork, taken = os.fork, cores.taken
    monkeypatch.setattr(cores, "usable_cores", lambda: count)
    monkeypatch.setattr(os, "fork", lambda: forked.append(1) or fork())
    monkeypatch.setattr(cores, "taken", lambda *told: handed.append(1) or taken(*told))
    path = identify_feet(robot, files[:2]).save(folder / str(count))
    monkeypatch.undo()
    assert len(handed) == len(forked), "what every copy found is used"
    written = json.loads(path.read_text())
    assert written.pop("created")
    return written, (path.parent / "residuals.parquet").read_bytes(), len(forked)


def test_any_number_of_cores_finds_the_same(
    robot: RobotModel, files: list[Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    alone, *shared = (found_on(count, robot, files, tmp_path, monkeypatch) for count in (1, 2, 3))
    assert alone[2] == 0
    for one in shared:
        assert one[:2] == alone[:2]
        assert one[2] >= 5, "reading, preparation, slip, fits and verdicts"


def test_a_look_is_the_same_at_files_and_at_logs_in_turn(robot: RobotModel, files: list[Path]) -> None:
    waiting = logs_of([str(path) for path in files], robot)
    assert isinstance(waiting, WaitingLogs)
    assert waiting.bounded
    together = looked_at(robot, waiting, True)
    done = list[str]()
    in_turn = looked_at(robot, iter(waiting), True, lambda: done.append("meanwhile"))
    assert done == ["meanwhile"]
    for one, other in zip(together, in_turn, strict=True):
        assert one.log.name == other.log.name
        assert one.log.time.tobytes() == other.log.time.tobytes()
        assert one.tilt == other.tilt
        assert one.accelerometer.products.tobytes() == other.accelerometer.products.tobytes()


def test_packed_files_and_large_ones_wait_for_their_turns(
    robot: RobotModel, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A text says how much its numbers take at most; what is packed does not."""
    text, packed = tmp_path / "log.csv", tmp_path / "log.csv.gz"
    text.write_bytes(b"0" * 100)
    packed.write_bytes(b"0" * 100)
    for files, bounded in (([text], True), ([text, packed], False), ([tmp_path / "none.csv"], False)):
        found = logs_of(files, robot)
        assert isinstance(found, WaitingLogs)
        assert found.bounded is bounded
    for memory, bounded in ((1600, True), (1599, False)):
        monkeypatch.setattr("plantar.logs.inputs.usual_memory", lambda memory=memory: memory)
        found = logs_of([text, text], robot)
        assert isinstance(found, WaitingLogs)
        assert found.bounded is bounded
