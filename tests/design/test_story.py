"""A design from end to end, short: what it writes, what it promises, what it refuses."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
import yaml
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

import command_line
import design_samples
from plantar.design import story
from plantar.design.story import (
    DesignSettings,
    design_motion,
)
from plantar.design.writing.outputs import content_of, write_design
from plantar.design.writing.sheet import sheet
from plantar.errors import MotionError, SettingsError
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.robot.model import load_robot
from plantar.twin.own_motion import own_plan
from plantar.twin.robots import hrp2

EFFORT = 0.9
FRICTION = 0.3
KEPT = 0.0055


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("design") / "motion.csv"
    write_design(design_samples.designed(), path, 100.0, ("ros", "openhrp", "mcap", "mc_rtc"), approach=True)
    return path


def positions(path: Path) -> np.ndarray:
    return open_log(path).positions(hrp2.robot())


def test_the_table_holds_every_joint_from_rest_to_rest(written: Path) -> None:
    log = open_log(written)
    assert log.time == pytest.approx(np.arange(2001) / 100)
    assert list(log.columns) == [f"joint.{name}.position" for name in hrp2.robot().joint_names]
    q = log.positions(hrp2.robot())
    for rows in (slice(0, 150), slice(-150, None)):
        assert np.ptp(q[rows], axis=0).max() < 1e-6
    assert q[0] == pytest.approx(q[-1], abs=1e-5)
    assert np.ptp(q, axis=0).max() > 0.02
    model = hrp2.robot().model
    assert (q > model.lowerPositionLimit).all()
    assert (q < model.upperPositionLimit).all()
    assert (np.abs(np.diff(q, axis=0)) * 100 < model.velocityLimit).all()


def test_it_says_what_it_promises_and_what_it_kept(written: Path) -> None:
    content = json.loads(written.with_suffix(".json").read_text())
    assert content["schema"] == "plantar.design/1"
    rows = {
        (row["foot"], row["axis"], row["name"]): row["half_width_percent"] for row in content["parameters"]
    }
    assert len(rows) == 8
    assert content["stiffness_range"] == pytest.approx([250.0, 1000.0])
    assert [one["factor"] for one in content["rehearsals"]] == pytest.approx(
        [0.5, 0.5**0.5, 1.0, 2**0.5, 2**0.75, 2.0]
    )
    for one in content["rehearsals"]:
        assert one["sole_margin"] > KEPT
        assert one["friction"] < FRICTION
    assert len(content["sensor_delay"]["at"]) == len(content["vertical_compliance"]["at"]) == 6
    for one in content["sensor_delay"]["at"]:
        assert one["half_width"] is None or abs(one["error"]) < 2 * one["half_width"] < 0.02
    for one in content["vertical_compliance"]["at"]:
        assert one["half_width_percent"] is None or abs(one["error_percent"]) < 5.0
    page = written.with_suffix(".md").read_text()
    assert "Delay of the force sensors: " in page
    assert "The search wanted: stiffness within 0.5 %" in page
    for row in content["parameters"]:
        off = [abs(one["error_percent"]) for one in row["at"] if one["error_percent"] is not None]
        assert row["error95_percent"] is None or row["error95_percent"] > 0.99 * max(off, default=0.0)
    assert "holds from 250 to 1000 N·m/rad" in page
    assert content["right_foot_ahead"] == {"value": 0.0, "unit": "m"}
    assert "placed as in that row, side by side." in page
    stepped = sheet(content | {"right_foot_ahead": {"value": 0.048, "unit": "m"}}, approach=False)
    assert "placed as in that row, the right one 48 mm ahead of the left one." in stepped
    assert "25 % and 50 %" in page
    needed = content["one_foot"]["least_stiffness"]
    assert needed == pytest.approx(2 * content["least_stiffness"])
    assert f"stiffer than {needed:.4g} N·m/rad to hold it alone, and may be as soft as 250" in page
    stiff = sheet(content | {"stiffness_range": [600.0, 2400.0]}, approach=False)
    assert "feet of 600 N·m/rad could hold it, but" in stiff


def test_the_floor_of_rehearsals_gives_way_a_little() -> None:
    """More about the axis along the sole, which is longer than wide."""
    yields = design_samples.designed().nominal.yields
    for foot in ("left", "right"):
        assert 1e-4 < yields[foot, "pitch"] < yields[foot, "roll"] < 0.005


def test_limits_are_told_with_the_worst_of_the_rehearsals(written: Path) -> None:
    found = design_samples.designed()
    unlike = tuple(
        replace(one, sole_margins=(0.01 + 0.001 * k, 0.05), friction=0.1 + 0.01 * k, effort=0.8 - 0.1 * k)
        for k, one in enumerate(found.rehearsals)
    )
    content = content_of(replace(found, rehearsals=unlike), written, 100.0)
    assert content["wanted"] == pytest.approx(
        {
            "stiffness_percent": 0.5,
            "damping_percent": 4.0,
            "sensor_delay": 0.001,
            "vertical_compliance_percent": 30.0,
        }
    )
    way, speed = found.trajectory.limits_used()
    reached = [0.01, 0.1 + 0.01 * (len(unlike) - 1), 0.8, way, speed]
    assert [one["reached"] for one in content["limits"]] == pytest.approx(reached)
    assert [one["kept"] for one in content["limits"]] == [KEPT, FRICTION, EFFORT, 1.0, 1.0]
    assert [one["unit"] for one in content["limits"]] == ["m", "", "", "", ""]
    assert [one["sole_margin"] for one in content["rehearsals"]] == [one.sole_margin for one in unlike]


def test_a_number_that_rehearsals_do_not_find_is_said(written: Path) -> None:
    found = design_samples.designed()
    blind = replace(found, rehearsals=tuple(replace(one, results=(None,)) for one in found.rehearsals))
    content = content_of(blind, written, 100.0)
    said = sorted(note.partition(" will")[0] for note in content["notes"])
    assert said == ["left pitch", "left roll", "right pitch", "right roll"]
    assert all("weak at 0.5, 0.707, 1, 1.41, 1.68, 2 times" in note for note in content["notes"])
    for row in content_of(found, written, 100.0)["parameters"]:
        for one in row["at"]:
            assert (one["half_width_percent"] is None) == (one["error_percent"] is None)


def test_controllers_files_hold_the_same_motion(written: Path) -> None:
    q, joints = positions(written), list(hrp2.robot().joint_names)
    pos = np.loadtxt(written.with_suffix(".pos"))
    assert pos[:, 0] == pytest.approx(np.arange(2001) / 100)
    np.testing.assert_allclose(pos[:, 1:], q, rtol=1e-6, atol=1e-6)
    ros = yaml.load(written.with_suffix(".yaml").read_text(), yaml.CSafeLoader)
    assert ros["joint_names"] == joints
    point = ros["points"][1234]
    assert point["time_from_start"] == {"sec": 12, "nanosec": 340000000}
    assert point["positions"] == pytest.approx(q[1234].tolist(), abs=1e-6)
    assert point["velocities"] == pytest.approx((q[1235] - q[1233]) / 0.02, abs=2e-3)
    store = get_typestore(Stores.ROS2_HUMBLE)
    with AnyReader([written.with_suffix(".mcap")]) as reader:
        ((connection, _, raw),) = list(reader.messages())
        message = store.deserialize_cdr(raw, connection.msgtype)
    assert message.joint_names == joints
    sent = message.points[1234]
    assert (sent.time_from_start.sec, sent.time_from_start.nanosec) == (12, 340000000)
    assert sent.positions == pytest.approx(q[1234])
    assert sent.velocities == pytest.approx(point["velocities"], abs=1e-6)
    assert len(sent.accelerations) == len(sent.effort) == 0


def test_a_gentle_version_is_a_share_of_the_whole(written: Path) -> None:
    whole, quarter = (positions(path) for path in (written, written.with_stem("motion_25")))
    swing, less = whole - whole[0], quarter - quarter[0]
    assert quarter[0] == pytest.approx(whole[0], abs=1e-6)
    assert np.abs(less - 0.25 * swing).max() < 0.1 * np.abs(swing).max()
    assert np.abs(less).max() == pytest.approx(0.25 * np.abs(swing).max(), rel=0.15)


def test_the_same_seed_gives_the_same_table(written: Path, tmp_path: Path) -> None:
    write_design(design_samples.designed_again(), tmp_path / "again.csv", 100.0, targets=(), approach=False)
    assert (tmp_path / "again.csv").read_bytes() == written.read_bytes()


def test_the_twin_plays_a_table_from_where_its_first_row_stands(written: Path) -> None:
    plan = own_plan(written, hrp2.robot())
    own = design_samples.designed().trajectory.plan()
    assert plan.time == pytest.approx(own.time)
    np.testing.assert_allclose(plan.positions, own.positions, rtol=1e-6, atol=1e-4)
    assert plan.base[0][2] == pytest.approx(own.base[0][2], abs=1e-5)
    assert plan.standing == {"left", "right"}


def test_feet_that_are_too_soft_are_refused_with_what_is_needed() -> None:
    with pytest.raises(
        MotionError,
        match=r"^hrp2_like: feet of 150 N·m/rad cannot hold the robot upright \(valid: at least 230\.6 "
        r"N·m/rad each\)$",
    ):
        design_motion(hrp2.robot(), DesignSettings(150.0))


@pytest.mark.parametrize(
    ("settings", "line"),
    [
        (
            {"stiffness": -1.0},
            r"^value -1\.0: stiffness is not valid \(valid: 1 to 1e\+06 N·m/rad, or None: the earlier "
            r"result's\)$",
        ),
        (
            {"stiffness": 500.0, "duration": 3.0},
            r"^value 3\.0: duration is not valid \(valid: 20 to 600 s\)$",
        ),
        (
            {"stiffness": 500.0, "criterion": "E"},
            r"^value 'E': criterion is not a choice \(valid: widest, D, A\)$",
        ),
    ],
)
def test_settings_out_of_range_are_refused(settings: dict[str, float], line: str) -> None:
    with pytest.raises(SettingsError, match=line):
        DesignSettings(**settings)  # type: ignore[arg-type]


def test_the_command_refuses_before_it_works(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    robot = hrp2.write(tmp_path)
    out = tmp_path / "motion.csv"
    line = command_line.refused(capsys, "design", robot, "--stiffness", 500, "--out", tmp_path / "motion.txt")
    assert "has an unknown ending (valid: .csv)" in line
    line = command_line.refused(capsys, "design", robot, "--stiffness", 500, "--rate", 1e6, "--out", out)
    assert "rate is not valid" in line
    line = command_line.refused(capsys, "design", robot, "--stiffness", 500, "--to", "abb", "--out", out)
    assert "valid: ros, mcap, openhrp, mc_rtc" in line
    line = command_line.refused(capsys, "design", robot, "--stiffness", 100, "--out", out)
    assert "feet of 100 N·m/rad cannot hold the robot upright" in line
    assert command_line.run("design", robot, "--out", out) == 2
    assert "--after" in capsys.readouterr().err
    assert not out.exists()


def test_the_command_writes_and_says_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    robot, out = hrp2.write(tmp_path), tmp_path / "motion.csv"
    with patch.object(story, "design_motion", lambda *_: design_samples.designed()):
        assert (
            command_line.run(
                "design", robot, "--stiffness", 500, "--out", out, "--rate", 50, "--to", "openhrp"
            )
            == 0
        )
        said = capsys.readouterr()
        assert "Rehearsed" in said.out
        page = out.with_suffix(".html").read_text()
        assert "hrp2_like on its bushes" in page
        assert "write" in said.err
        assert (
            command_line.run("design", robot, "--stiffness", 500, "--out", out, "--rate", 50, "--json", "-q")
            == 0
        )
    content = capsys.readouterr()
    assert json.loads(content.out) == json.loads(out.with_suffix(".json").read_text())
    assert content.err == ""
    assert len(out.read_text().splitlines()) == 1002
    assert out.with_suffix(".pos").exists()


def test_tables_that_are_no_motion_are_refused(tmp_path: Path) -> None:
    robot = load_robot(hrp2.write(tmp_path))
    time = np.arange(300) / 100
    other = command_line.write_csv(
        MotionLog("other", time, {"joint.knee.position": 0 * time}), tmp_path / "other.csv"
    )
    with pytest.raises(
        Exception,
        match=r"other\.csv: holds no position of a joint of this robot \(valid: columns such as "
        r"'joint\.CHEST_JOINT0\.position'\)$",
    ):
        own_plan(other, robot)
    lifted = {"joint.LLEG_JOINT3.position": 0.3 + 0 * time}
    uneven = command_line.write_csv(MotionLog("uneven", time, lifted), tmp_path / "uneven.csv")
    with pytest.raises(
        MotionError,
        match=r"uneven\.csv: the first row has one foot 18 mm above the other \(valid: level feet, "
        r"within 10 mm\)$",
    ):
        own_plan(uneven, robot)


def test_the_right_foot_stands_ahead_by_a_share_of_their_distance(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the legs reach so far; side by side alone where they do not."""
    asked: list[float] = []
    places = {"left": np.array([0.0, 0.09, 0.0]), "right": np.array([0.0, -0.11, 0.0])}

    def standing(_: object, __: object, ahead: float) -> Any:
        asked.append(ahead)
        if ahead > reach:
            raise MotionError("cannot")
        return Stood(ahead)

    monkeypatch.setattr(story, "Legs", SimpleNamespace(of=standing))
    monkeypatch.setattr(story, "free_swing", lambda robot, rest, arms: 0.5 * arms)
    linear = SimpleNamespace(pendulum=SimpleNamespace(places=places))
    monkeypatch.setattr(story, "LinearRobot", SimpleNamespace(of=lambda _: linear))
    for reach, found in ((1.0, [0.0, 0.05]), (0.01, [0.0])):  # noqa: B007
        stances = [legs for legs, _ in story._stances(hrp2.robot())]
        assert [legs.ahead for legs in stances] == pytest.approx(found)
        assert [legs.arms for legs in stances] == [0.5] * len(found), "as far as nothing touches"
    assert asked == pytest.approx([0.0, 0.05, 0.0, 0.05]), "a quarter of their distance"


@dataclass(frozen=True)
class Stood:
    """Legs that stand with the right foot ahead [m]."""

    ahead: float
    rest: tuple[None] = (None,)
    arms: float = 1.0
