"""Feet as the exporters write them, in MuJoCo beside a recording of the twin, whose feet are known."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import plantar
from command_line import run
from kept_texts import assert_as_kept, described
from plantar.comparison import compare as comparison
from plantar.comparison import scenes as scene_module
from plantar.comparison.compare import KindScore, compare
from plantar.comparison.scenes import AS_IT_WAS, CONTACT, JOINTS, RIGID, WITH_LOOP, scenes
from plantar.contact.balance import soles_in_root
from plantar.conventions import Array, rotation_from_rpy
from plantar.errors import DataError, RobotError
from plantar.exporters.bush import FootBush
from plantar.exporters.job import USUAL, Stance
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.logs.save import save_log
from plantar.motions.plan import Plan
from plantar.report.figures.plots import save
from plantar.report.figures.simulation import replays
from plantar.results.feet import FeetResult, Offset, Parameter
from plantar.robot.model import RobotModel, load_robot
from plantar.twin.bush import PAPER, Feet
from plantar.twin.play import rolled
from plantar.twin.replay import Replayed, plan_of, record_of
from plantar.twin.robots import hrp2
from plantar.twin.robots.foot import cut_feet
from plantar.twin.robots.from_robot import describe
from plantar.twin.sensing.exact import exact_columns
from plantar.twin.simulation.physics import Physics
from twin_samples import plan, short

pytestmark = pytest.mark.usefixtures("contact_at_one_step")
KINDS = (AS_IT_WAS, JOINTS, CONTACT)
SLIPPING = dict.fromkeys(PAPER, replace(PAPER["right"], pitch_slip_torque=5.0, pitch_slip_angle=0.01))


@pytest.fixture(scope="module", autouse=True)
def half_a_second_to_settle() -> Iterator[None]:
    """Instead of three, which steps that Python takes part in make long."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(comparison, "RIGID", replace(RIGID, settle=0.5))
        yield


def played(bushes: Feet, seconds: float = 4.0) -> MotionLog:
    """From where the robot stands, for a second: it leans forward."""
    robot = hrp2.robot()
    rollout = rolled(short(plan("Tilt3"), 1.0, 1.0 + seconds), robot, Physics(bushes=bushes, settle=0.5))
    return MotionLog("Tilt3", rollout.time, exact_columns(rollout, robot, cut_feet(describe(robot), robot)))


@pytest.fixture(scope="module")
def log() -> MotionLog:
    return played(PAPER)


def first(log: MotionLog, seconds: float) -> MotionLog:
    rows = log.time < seconds
    return MotionLog(log.name, log.time[rows], {name: values[rows] for name, values in log.columns.items()})


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> FeetResult:
    """What an identification without any error finds; the twin's robot file stands beside it."""
    return identified(PAPER, tmp_path_factory.mktemp("result"))


def identified(bushes: Feet, folder: Path) -> FeetResult:
    robot = load_robot(hrp2.write(folder))
    rows = tuple(
        Parameter(foot, axis, name, "", getattr(bush, f"{axis}_{name}"), 1.0, None, None, "usable", "")  # type: ignore[arg-type]
        for foot, bush in bushes.items()
        for axis in ("pitch", "roll", "z")
        for name in ("stiffness", "damping", "slip_torque", "slip_angle")
        if getattr(bush, f"{axis}_{name}", 0.0) and (bush.pitch_slip_torque or "slip" not in name)
    )
    feet = {
        name: {
            "ankle": foot.ankle,
            "bush": {"link": foot.ankle, "xyz": [0, 0, -0.085]},
            "sole": {"link": foot.ankle, "xyz": [0, 0, -0.105], "polygon": foot.sole.polygon.tolist()},
        }
        for name, foot in robot.feet.items()
    }
    made = FeetResult(
        robot="hrp2_like", inputs=(), settings={}, model="kelvin_voigt", parameters=rows, offsets=(), phases=(),
        validation=(), notes=(), robot_model={"urdf": str(folder / "hrp2.urdf"), "feet": feet},
    )  # fmt: skip
    made.save(folder)
    return made


def log_positions(robot: RobotModel, log: MotionLog, like: Plan) -> Array:
    """The recorded joint positions at a plan's times, (n, joints)."""
    return np.column_stack(
        [np.interp(like.time, log.time - log.time[0], row) for row in log.positions(robot).T]
    )


@pytest.fixture(scope="module")
def compared(result: FeetResult, log: MotionLog) -> tuple[tuple[KindScore, ...], tuple[Replayed, ...]]:
    return compare(result, hrp2.robot(), [first(log, 2.1)])


@pytest.mark.slow
def test_exported_feet_move_as_the_robot_did_and_rigid_ones_do_not(
    compared: tuple[tuple[KindScore, ...], tuple[Replayed, ...]],
) -> None:
    scores = {one.feet: one for one in compared[0]}
    assert tuple(scores) == KINDS
    assert {one.tips for one in compared[0]} == {None}, "it leans well inside its soles"
    assert all(one.flat_chest == one.chest for one in compared[0])
    rigid, joints, contact = (scores[kind].chest for kind in KINDS)
    assert rigid is not None
    assert joints is not None
    assert contact is not None
    assert contact < 0.3 * rigid
    assert joints < 0.1 * rigid
    torques = [scores[kind].torque for kind in KINDS]
    assert torques[1] < 0.2 * torques[0]  # type: ignore[operator]
    assert torques[2] < 0.5 * torques[0]  # type: ignore[operator]


@pytest.mark.slow
def test_scores_are_as_they_are_kept(compared: tuple[tuple[KindScore, ...], tuple[Replayed, ...]]) -> None:
    """And the root mean squares of what is simulated."""
    scores, replayed = compared
    sizes = [[np.sqrt(np.mean(part**2)) for part in (*one.chest.T, *one.torque.values())] for one in replayed]
    told = described({"scores": scores, "sizes": sizes})
    assert_as_kept(told, Path(__file__).parent / "kept" / "scores.txt", share=0.01, least=1e-6)


@pytest.mark.slow
def test_the_picture_and_the_numbers_go_to_a_folder(
    compared: tuple[tuple[KindScore, ...], tuple[Replayed, ...]], tmp_path: Path
) -> None:
    pytest.importorskip("matplotlib")
    (path,) = save(replays(compared[1], CONTACT), tmp_path, "comparison", ["svg"])
    text = path.read_text()
    for words in (*KINDS, "recorded", "chest pitch", "Tilt3"):
        assert words in text


def test_the_scenes_are_what_the_exporters_write(result: FeetResult, log: MotionLog) -> None:
    made = scenes(result, hrp2.robot(), plan_of(hrp2.robot(), log), swing=None, stance=USUAL, tips=False)
    assert tuple(made) == KINDS
    names = {kind: {e.get("name", "") for e in ET.fromstring(one.xml).iter()} for kind, one in made.items()}
    assert "LLEG_BUSH_PITCH" in names[JOINTS]
    assert "left_contact_0" in names[CONTACT]
    assert not {"LLEG_BUSH_PITCH", "left_contact_0"} & names[AS_IT_WAS]
    assert "LLEG_BUSH_PITCH" not in names[CONTACT]
    tipping = scenes(result, hrp2.robot(), plan_of(hrp2.robot(), log), tips=True, swing=None, stance=USUAL)
    assert tuple(tipping) == (*KINDS, WITH_LOOP), "a sole that tips asks for the loop, whatever the rubber"
    assert tipping[WITH_LOOP].force is plantar.FootHysteresis


@pytest.mark.slow
def test_a_contact_whose_slip_the_loop_applies_moves_as_the_joints_do(tmp_path: Path) -> None:
    """Rubber that slips at half of the torque of this lean: spring and damper alone are far off."""
    log = played(SLIPPING, 2.5)
    scores, _ = compare(identified(SLIPPING, tmp_path), hrp2.robot(), [log], stance=Stance("bush"))
    chest = {one.feet: one.chest for one in scores}
    assert tuple(chest) == (*KINDS, WITH_LOOP)
    assert chest[WITH_LOOP] < 1.5 * chest[JOINTS] + 2e-5  # type: ignore[operator]
    assert chest[WITH_LOOP] < 0.1 * chest[AS_IT_WAS]  # type: ignore[operator]
    assert chest[CONTACT] > 3 * chest[WITH_LOOP]  # type: ignore[operator]


def test_feet_that_turn_about_the_bush_stand_lower(
    result: FeetResult, log: MotionLog, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = scenes(
        result, hrp2.robot(), plan_of(hrp2.robot(), log), stance=Stance("bush"), swing=None, tips=False
    )
    assert {kind: one.lower for kind, one in made.items()} == pytest.approx(
        {AS_IT_WAS: 0.0, JOINTS: 0.0, CONTACT: 0.02}
    )
    assert all(one.force is None for one in made.values())
    on_twin = scene_module._on_twin

    def uneven(foot: FootBush, robot: RobotModel) -> FootBush:
        placed = on_twin(foot, robot)
        return placed if foot.name == "left" else replace(placed, sole=placed.sole - [0.0, 0.0, 0.004])

    monkeypatch.setattr(scene_module, "_on_twin", uneven)
    made = scenes(result, hrp2.robot(), plan_of(hrp2.robot(), log), None, Stance("bush"), tips=False)
    assert made[CONTACT].lower == pytest.approx(0.02), "by the foot whose bush is nearer to the floor"


@pytest.mark.slow
def test_a_robot_that_falls_is_scored_up_to_there(result: FeetResult, log: MotionLog) -> None:
    """After 2.8 s its hips bend until it lies."""
    robot = hrp2.robot()
    bent = {
        f"joint.{side}_JOINT2.position": log.columns[f"joint.{side}_JOINT2.position"]
        - 0.8 * np.clip(log.time - 2.8, 0.0, None)
        for side in ("LLEG", "RLEG")
    }
    scores, replayed = compare(result, robot, [MotionLog("bent", log.time, dict(log.columns) | bent)])
    assert [one.feet for one in scores] == list(KINDS)
    falls = [one.fell for one in scores if one.fell is not None]
    assert falls
    assert min(falls) > 2.8
    for one in scores:
        assert one.until == pytest.approx(min(falls) - 1.0, abs=0.01), "all over the same time"
        assert one.chest is not None
    assert all(one.time[-1] == scores[0].until for one in replayed)


def test_a_robot_starts_with_no_sole_in_the_ground(log: MotionLog) -> None:
    """A knee that reads 0.02 rad wrong puts one sole 3 mm deeper than the other: stiff ground would throw it over."""
    robot = hrp2.robot()
    for side in ("LLEG", "RLEG"):
        name = f"joint.{side}_JOINT3.position"
        wrong = MotionLog("wrong", log.time, dict(log.columns) | {name: log.columns[name] - 0.02})
        plan = plan_of(robot, wrong)
        lowest = [
            (plan.base[0] @ pose @ np.array([*corner, 0.0, 1.0]))[2]
            for foot, pose in soles_in_root(robot, wrong.positions(robot)[0]).items()
            for corner in robot.feet[foot].sole.polygon
        ]
        assert min(lowest) == pytest.approx(0.0, abs=1e-9), side
        assert max(lowest) > 1e-3, "the other sole is above the ground"


def test_servos_give_as_much_where_no_efforts_were_recorded(log: MotionLog) -> None:
    """A servo gives by 10 mrad at full torque: what holds the robot has to be known to some per cent of that."""
    robot, columns = hrp2.robot(), {name: v for name, v in log.columns.items() if not name.endswith("effort")}
    recorded, computed = plan_of(robot, log), plan_of(robot, replace(log, columns=columns))
    given = np.abs(recorded.positions - log_positions(robot, log, recorded)).max()
    assert given > 1e-3
    np.testing.assert_allclose(computed.positions, recorded.positions, atol=0.1 * given)


def test_sensors_with_axes_of_their_own_carry_the_robot_too(log: MotionLog) -> None:
    """The same forces read in axes whose x points up: the same feet stand, and the same torques are recorded."""
    robot, turn = hrp2.robot(), np.array([0.4, -np.pi / 2, 0.0])
    feet, columns = {}, {}
    for name, foot in robot.feet.items():
        place = foot.wrench.placement
        assert not place.rpy.any()
        feet[name] = replace(foot, wrench=replace(foot.wrench, placement=replace(place, rpy=turn)))
        read = log.wrench(foot.wrench.name).reshape(-1, 2, 3) @ rotation_from_rpy(turn)
        columns |= dict(zip(wrench_columns(foot.wrench.name), read.reshape(-1, 6).T, strict=True))
    turned, told = replace(robot, feet=feet), log.with_columns(columns)
    plain, again = plan_of(robot, log), plan_of(turned, told)
    assert again.standing == plain.standing == frozenset(robot.feet)
    expected = record_of(robot, log, plain).torque
    for key, torque in record_of(turned, told, again).torque.items():
        np.testing.assert_allclose(torque, expected[key], atol=1e-9)


def test_the_command_says_what_it_cannot_do(
    result: FeetResult, log: MotionLog, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    result.save(tmp_path / "feet")
    robot = hrp2.write(tmp_path)
    bare = log.time, {name: values for name, values in log.columns.items() if "orientation" not in name}
    file = tmp_path / "bare.parquet"
    save_log(MotionLog("bare", *bare), file, hrp2.robot())
    found = tmp_path / "feet" / "result.json"
    assert run("compare", found, robot, file, "--simulator", "chrono") == 1
    assert "valid: mujoco" in capsys.readouterr().err
    assert run("compare", found, robot, file, "-q") == 1
    assert "no attitude" in capsys.readouterr().err


def test_robots_that_cannot_stand_and_move_are_refused(result: FeetResult, log: MotionLog) -> None:
    """A foot alone on a bench, a bolted arm, another robot: one line each, nothing is played."""
    robot = hrp2.robot()
    for change in ({"base": "fixed"}, {"feet": {}}):
        with pytest.raises(
            RobotError,
            match=r"robot\.yaml: what is played is a standing robot whose joints move \(valid: a floating "
            r"base, joints and feet\)$",
        ):
            compare(result, replace(robot, **change), [log])
    with pytest.raises(
        RobotError,
        match=r"robot\.yaml, value 'left': the result is of feet called left, right \(valid: l, right\)$",
    ):
        compare(result, replace(robot, feet={"l": robot.feet["left"], "right": robot.feet["right"]}), [log])


def test_logs_that_cannot_be_played_are_refused(result: FeetResult, log: MotionLog) -> None:
    """In one line each, before anything is simulated."""
    robot = hrp2.robot()
    unmoved = {name: values for name, values in log.columns.items() if not name.startswith("joint.")}
    gone = np.abs(log.time - log.time[0] - 2.0) < 0.2
    gap = {name: np.where(gone, np.nan, values) for name, values in log.columns.items()}
    for columns, message in (
        (unmoved, r"^Tilt3: holds no joints to play$"),
        (
            gap,
            r"^Tilt3, t = 1\.8 s: the joints have a gap: what is played must be recorded throughout "
            r"\(valid: gaps of 0\.2 s or less\)$",
        ),
    ):
        with pytest.raises(DataError, match=message):
            compare(result, robot, [replace(log, columns=columns)])
    with pytest.raises(
        DataError, match=r"^Tilt3, value 1\.495: is too short to compare \(valid: 2 s or more\)$"
    ):
        compare(result, robot, [first(log, 1.5)])


@pytest.mark.slow
def test_the_command_prints_its_scores(
    result: FeetResult, log: MotionLog, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    result.save(tmp_path / "feet")
    robot, file = hrp2.write(tmp_path), tmp_path / "short.parquet"
    save_log(first(log, 2.1), file, hrp2.robot())
    arguments = ("compare", tmp_path / "feet" / "result.json", robot, file, "--out", tmp_path / "out")
    assert run(*arguments) == 0
    assert "exported contact" in capsys.readouterr().out
    stored = json.loads((tmp_path / "out" / "comparison.json").read_text())
    assert [row["feet"] for row in stored["scores"]] == list(KINDS)
    assert (tmp_path / "out" / "comparison.svg").is_file()


def test_zeros_of_the_sensors_are_no_rest_angles_of_what_is_played(
    result: FeetResult, log: MotionLog
) -> None:
    robot, offset = hrp2.robot(), Offset("left", "pitch", "Tilt3", "N.m", 5.0, 0.1)
    like = plan_of(robot, log)
    found, without = (
        scenes(replace(result, offsets=offsets), robot, like, swing=None, stance=USUAL, tips=False)
        for offsets in ((offset,), ())
    )
    for kind in KINDS:
        places = [
            {(e.get("name"), e.get("pos"), e.get("springref")) for e in ET.fromstring(made[kind].xml).iter()}
            for made in (found, without)
        ]
        assert places[0] == places[1]
