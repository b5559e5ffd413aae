"""Files of every format that are cut, or in which bytes are wrong, read as is kept: what is said, and what is left."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from biped import record, sway, times
from biped_robot import make_robot
from kept_texts import assert_as_kept
from log_formats import WRITERS
from plantar.errors import PlantarError
from plantar.logs.readers import open_log
from plantar.robot.model import RobotModel

KEPT = Path(__file__).parent / "kept"
# Those whose bytes follow from the log alone, and not from the version of a library that writes them.
FORMATS = ("csv", "mapped_csv", "astate", "mcap_plain", "ros1", "mc_rtc", "mc_rtc_1", "hrpsys", "yarp")


def read(path: Path, robot: RobotModel) -> str:
    try:
        log = open_log(path, robot)
    except PlantarError as error:
        return f"{error}"
    values = np.array([log.columns[name] for name in sorted(log.columns)])
    known = np.isfinite(values)
    sums = f"{np.sum(np.abs(values[known])):.6g}, {np.sum(values[known]):.6g}"
    notes = "".join(f"; {note.severity} {note.code}: {note.text}" for note in log.notes)
    return f"{values.shape}, {log.time[0]:.6g} to {log.time[-1]:.6g} s, {known.sum()} known, {sums}{notes}"


@pytest.mark.parametrize("name", FORMATS)
def test_what_is_read_of_a_file_that_is_not_whole_is_as_it_is_kept(name: str, tmp_path: Path) -> None:
    motion = sway("log", 1, 0.6)
    log = record(motion, at=times(motion, 50.0))
    log = log.with_columns({each: np.round(values, 6) for each, values in log.columns.items()})
    path, columns = WRITERS[name](log, tmp_path)
    robot = make_robot(tmp_path / "robot", columns=columns)
    parts = [path] if path.is_file() else [one for one in path.rglob("*") if one.is_file()]
    file = max(parts, key=lambda one: one.stat().st_size)
    whole, random, lines = file.read_bytes(), np.random.default_rng(0), list[str]()
    for share in (1.0, 0.0, 0.02, 0.3, 0.5, 0.8, 0.97):
        file.write_bytes(whole[: round(share * len(whole))])
        lines.append(f"{share:.0%}: {read(path, robot)}")
    file.write_bytes(whole[:-3])
    lines.append(f"three bytes less: {read(path, robot)}")
    file.write_bytes(whole + whole[-40:])
    lines.append(f"40 bytes more: {read(path, robot)}")
    for place in np.sort(random.integers(0, len(whole), 12)).tolist():
        file.write_bytes(whole[:place] + bytes([whole[place] ^ 0x15]) + whole[place + 1 :])
        lines.append(f"byte {place}: {read(path, robot)}")
    text = "".join(f"{line}\n" for line in lines).replace(str(tmp_path), "FOLDER")
    assert_as_kept(text, KEPT / f"{name}.txt", share=1e-5)
