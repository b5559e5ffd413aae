"""One recording, every format: the same columns, and the same numbers of an identification."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest

import plantar
from biped import record, sway
from biped_robot import make_robot
from log_formats import WRITERS
from plantar.feet.settings import FeetSettings
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.robot.model import RobotModel


@pytest.fixture(scope="module")
def original() -> MotionLog:
    return record(sway("log", duration=8.0))


def written(name: str, log: MotionLog, folder: Path) -> tuple[Path, RobotModel]:
    folder.mkdir(exist_ok=True)
    path, columns = WRITERS[name](log, folder)
    return path, make_robot(folder / "robot", columns=columns)


@pytest.mark.parametrize("name", WRITERS)
def test_every_format_gives_the_same_columns(name: str, original: MotionLog, tmp_path: Path) -> None:
    path, robot = written(name, original, tmp_path)
    log = open_log(path, robot)
    assert set(log.columns) == set(original.columns)
    np.testing.assert_allclose(log.time - log.time[0], original.time - original.time[0], rtol=0, atol=2e-9)
    attitude, seen = (source.orientation("chest") for source in (original, log))
    assert attitude is not None
    assert seen is not None
    np.testing.assert_allclose(np.abs(np.sum(attitude * seen, axis=1)), 1, rtol=0, atol=1e-13)
    for column, values in original.columns.items():
        if ".orientation." not in column:
            np.testing.assert_allclose(log.columns[column], values, rtol=1e-12, atol=1e-12, err_msg=column)
    assert not [note for note in log.notes if note.severity == "warning"], log.notes
    assert log.sha256 is not None


@pytest.mark.slow
def test_every_format_gives_the_same_result(original: MotionLog, tmp_path: Path) -> None:
    settings = FeetSettings(model="kelvin_voigt", wrench_delay=0.0, window=0.2)  # one law, no searches
    results = {}
    for name in WRITERS:
        path, robot = written(name, original, tmp_path / name)
        result = plantar.identify_feet(robot, [open_log(path, robot)], settings=settings)
        results[name] = {(p.foot, p.axis, p.name): p.value for p in result.parameters}
    for name, values in results.items():
        assert values.keys() == results["csv"].keys()
        for key, value in values.items():
            assert value == pytest.approx(results["csv"][key], rel=1e-6), (name, key)


@pytest.mark.parametrize(
    "name", [name for name in WRITERS if name not in ("hrpsys", "yarp", "astate", "sqlite3")]
)
def test_an_ending_may_be_written_in_capitals(name: str, tmp_path: Path) -> None:
    path, robot = written(name, record(sway("log", duration=2.0)), tmp_path)
    large = path.rename(path.with_name(path.name.upper()))
    assert len(open_log(large, robot).columns) > 20


def test_a_packed_table_may_end_in_capitals(original: MotionLog, tmp_path: Path) -> None:
    path, robot = written("csv", original, tmp_path)
    large = tmp_path / "LOG.CSV.GZ"
    large.write_bytes(gzip.compress(path.read_bytes()))
    assert len(open_log(large, robot)) == len(original)
