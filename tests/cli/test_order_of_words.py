"""What a user reads first of a log with a fault: the fault, on the terminal and in the report; no advice beside it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from biped import record, sway
from biped_robot import write_robot
from plantar.cli import main
from plantar.logs.motion_log import MotionLog
from plantar.logs.save import save_log


def clipped(log: MotionLog) -> MotionLog:
    """The log with the left foot's torques at their full scale for part of the time."""
    names = ("wrench.left.torque.x", "wrench.left.torque.y")
    reach = {name: 0.3 * float(np.ptp(log.column(name))) for name in names}
    middle = {name: float(np.median(log.column(name))) for name in names}
    return log.with_columns(
        {
            name: np.clip(log.column(name), middle[name] - reach[name], middle[name] + reach[name])
            for name in names
        }
    )


def test_a_fault_stands_above_the_verdicts_and_alone_among_the_advice(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot, log = write_robot(tmp_path), clipped(record(sway("clipped", 3, duration=40.0)))
    save_log(log, tmp_path / "clipped.csv")
    out = tmp_path / "out"
    with pytest.raises(SystemExit) as done:
        main(["identify", "feet", str(robot), str(tmp_path / "clipped.csv"), "--out", str(out)])
    assert done.value.code == 0
    said = " ".join(capsys.readouterr().out.split())
    assert 0 <= said.find("wrench.left.torque") < said.index("Table 1")
    page = (out / "report.html").read_text(encoding="utf-8")
    assert 0 <= page.find("wrench.left.torque") < page.index("<h2>left foot</h2>")
    rows = json.loads((out / "result.json").read_text())["parameters"]
    advice = [row["advice"] for row in rows if row["foot"] == "left" and row["axis"] != "z"]
    assert len(advice) == 4
    assert all(text.startswith("mend what the warning names") for text in advice)
