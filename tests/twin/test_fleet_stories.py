"""What happens to a made fleet's robots, and what its logs hold of it, without a rollout."""

from __future__ import annotations

import csv
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from plantar.errors import PlantarError
from plantar.logs.motion_log import MotionLog
from plantar.twin import fleet
from plantar.twin.bush import PAPER
from plantar.twin.fleet import stories, write_fleet


def test_rubber_differs_by_three_per_cent_between_robots_and_by_half_a_per_cent_between_days() -> None:
    told = stories(400, 60, 1, 0.02)[3:]
    shares = np.array([story.shares["left"] for story in told])
    assert shares.mean() == pytest.approx(1.0, abs=0.006)
    assert shares.mean(axis=1).std() == pytest.approx(0.03, rel=0.12)
    assert (shares / shares.mean(axis=1, keepdims=True)).std() == pytest.approx(0.005, rel=0.05)
    other = np.array([story.shares["right"] for story in told])
    assert abs(np.corrcoef(shares.mean(axis=1), other.mean(axis=1))[0, 1]) < 0.15, "each foot by itself"
    assert [story.unit for story in told[:2]] == ["robot_04", "robot_05"]


def test_a_new_sole_is_eight_per_cent_stiffer_on_one_foot_and_months_are_a_twelfth_of_a_year() -> None:
    _, new, _ = stories(3, 5, 2, 0.02)
    assert new.shares["left"][2] / new.shares["left"][1] == pytest.approx(1.08, abs=0.03), (
        "from day 2 of 5 on"
    )
    assert new.shares["right"][2] / new.shares["right"][1] == pytest.approx(1.0, abs=0.03)
    assert new.shares["left"][0] != new.shares["right"][0], "each foot has rubber of its own"
    ageing, sole, drift = stories(3, 400, 2, 0.02)
    left, right = sole.shares["left"], sole.shares["right"]
    assert left[200:].mean() / left[:200].mean() == pytest.approx(1.08, abs=0.002)
    assert right[200:].mean() / right[:200].mean() == pytest.approx(1.0, abs=0.002)
    assert drift.gain[:2] == pytest.approx([1.0, 1.02 ** (12 / 365.25)], rel=1e-12)
    assert [(story.gain == 1).all() for story in (ageing, sole)] == [True, True]
    for foot, own in ageing.shares.items():
        assert own[-30:].mean() / own[:30].mean() == pytest.approx(1.02 ** (370 * 12 / 365.25), rel=0.005), (
            foot
        )


def test_logs_have_every_second_sample_no_efforts_and_the_gain_of_the_right_sensor(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    time = np.arange(6) / 200.0
    names = (
        "wrench.right.force.z",
        "wrench.right.torque.x",
        "wrench.left.force.z",
        "joint.a.position",
        "joint.a.effort",
    )
    columns = dict.fromkeys(names, 1.0 + time)
    softened: list[dict[str, float]] = []
    asked: list[float] = []
    saved: dict[str, MotionLog] = {}

    def on_other_rubber(rollout: Any, robot: Any, shares: dict[str, float]) -> Any:
        softened.append(shares)
        return rollout

    def own_stories(robots: int, days: int, seed: int, ageing: float) -> Any:
        asked.append(ageing)
        return stories(robots, days, seed, ageing)

    monkeypatch.setattr(fleet, "stories", own_stories)
    monkeypatch.setattr(fleet, "planned", lambda motion, robot: motion)
    monkeypatch.setattr(fleet, "rolled", lambda *_: None)
    monkeypatch.setattr(fleet, "replace", lambda rollout, name: name)
    monkeypatch.setattr(fleet, "on_other_rubber", on_other_rubber)
    monkeypatch.setattr(fleet, "record", lambda name, *_: SimpleNamespace(log=MotionLog(name, time, columns)))
    monkeypatch.setattr(
        fleet, "save_log", lambda log, path: saved.update({path.relative_to(tmp_path).as_posix(): log})
    )
    said: list[str] = []
    manifest = write_fleet(tmp_path, 3, 2, motion="Tilt3", preset="sensors", seed=3, progress=said.append)
    assert manifest == tmp_path / "fleet.csv"
    assert b"\r" not in manifest.read_bytes() + (tmp_path / "truth.csv").read_bytes()
    rows = list(csv.DictReader(manifest.open()))
    assert (
        said
        == [row["group"] for row in rows]
        == [f"robot_{n:02d}_2026-01-{d:02d}" for n in (1, 2, 3) for d in (1, 2)]
    )
    assert rows[3] == {"group": "robot_02_2026-01-02", "robot": "robot.yaml",
                       "log": "robot_02/robot_02_2026-01-02.parquet",
                       "role": "fit", "time": "2026-01-02T09:00:00Z", "unit": "robot_02"}  # fmt: skip
    assert list(saved) == [row["log"] for row in rows]
    assert asked == [0.015]
    told = stories(3, 2, 3, 0.015)
    for n, log in enumerate(saved.values()):
        np.testing.assert_array_equal(log.time, time[::2])
        gain = told[n // 2].gain[n % 2]
        np.testing.assert_allclose(log.columns["wrench.right.force.z"], gain * (1 + time[::2]))
        np.testing.assert_allclose(log.columns["wrench.right.torque.x"], gain * (1 + time[::2]))
        np.testing.assert_array_equal(log.columns["wrench.left.force.z"], 1 + time[::2])
        assert list(log.columns) == list(columns)[:4]
        assert softened[n] == {foot: own[n % 2] for foot, own in told[n // 2].shares.items()}
    truth = list(csv.DictReader((tmp_path / "truth.csv").open()))
    assert len(truth) == 6 * 4
    for row in truth[4:8]:
        stiffness = getattr(PAPER[row["foot"]], f"{row['axis']}_stiffness")
        assert float(row["stiffness"]) == pytest.approx(stiffness * told[0].shares[row["foot"]][1], rel=1e-5)
        assert (row["group"], row["event"]) == ("robot_01_2026-01-02", "ageing")


def test_more_logs_than_a_disk_should_hold_are_refused(tmp_path: Path) -> None:
    with pytest.raises(PlantarError, match=r"^value 100001: are too many logs \(valid: at most 100000\)$"):
        write_fleet(tmp_path, 1, 100_001, motion="Tilt3", preset="sensors", seed=0, progress=lambda _: None)
    with pytest.raises(
        PlantarError,
        match=r"^value 'imperfect': has robots or logs of its own \(valid: sensors, realistic\)$",
    ):
        write_fleet(tmp_path, 1, 1, motion="Tilt3", preset="imperfect", seed=0, progress=lambda _: None)
