"""The campaign end to end through the command line, and the parts that set results beside the paper and the truth."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest
from scipy.spatial.transform import Rotation

from plantar.campaign.choice import COMPOSED, TOGETHER, choice_rows, choice_table, explained
from plantar.campaign.compared import cross_beside, direct_beside, parameters_beside
from plantar.campaign.paper import TABLE_1, TABLE_2, TABLE_3
from plantar.campaign.pictures import boxes, look_of
from plantar.campaign.replay import IDENTIFIED, RECORD, RIGID, ReplayRow, best_guess, replay_rows, scores
from plantar.campaign.tables import simulator_table, table_1, table_3
from plantar.cli import main
from plantar.feet.select_motions import Choice, Selection
from plantar.files import sha256
from plantar.results.feet import FeetResult, Parameter, ValidationRow
from plantar.twin import PAPER
from plantar.twin.play import planned
from plantar.twin.replay import Replayed, moved_onto, pitch_and_roll
from plantar.twin.robots import hrp2
from report_visit import Visit, launched

BARS = {"stiffness": 1.0, "damping": 3.0}  # percent


def run(*arguments: object) -> tuple[int, str, str]:
    """Exit code, stdout and stderr of `plantar ARGUMENTS`."""
    out, error = io.StringIO(), io.StringIO()
    code = 0
    with redirect_stdout(out), redirect_stderr(error):
        try:
            main([str(argument) for argument in arguments])
        except SystemExit as done:
            code = 0 if done.code is None else int(done.code)
    return code, out.getvalue(), error.getvalue()


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str, str]:
    """Folder, stdout and stderr of a quick demo."""
    folder = tmp_path_factory.mktemp("demo")
    code, out, error = run("demo", "--quick", "--out", folder / "out", "--preset", "sensors", "--seed", 1)
    assert code == 0, error
    return folder / "out", out, error


@pytest.fixture(scope="module")
def content(demo: tuple[Path, str, str]) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((demo[0] / "result.json").read_text())
    return found


def test_the_demo_writes_what_it_says(demo: tuple[Path, str, str]) -> None:
    folder, out, error = demo
    for name in (
        "logs/robot.yaml",
        "logs/Tilt3.parquet",
        "logs/Squat.truth.json",
        "residuals.parquet",
        "robot.html",
    ):
        assert (folder / name).is_file(), name
    figures = {path.name for path in (folder / "figures").iterdir()}
    wanted = ("figure03_postures", "figure04b_zmp_Tilt3", "figure07_angles_Tilt3", "figure09_direct",
              "figure11_cross_Squat", "simulator")  # fmt: skip
    assert figures == {f"{name}.{kind}" for name in wanted for kind in ("svg", "pdf")}
    for heading in ("Table 1", "Table 2", "Table 3", "Which motions are most informative", "In a simulator"):
        assert heading in out
    assert str(folder / "report.html") in "".join(out.split("\n"))
    assert "play 2 motions on the twin: 100 %" in error


def test_the_result_is_near_the_truth_and_says_how_near(
    content: dict[str, Any], demo: tuple[Path, str, str]
) -> None:
    truth = json.loads((demo[0] / "logs" / "Tilt3.truth.json").read_text())["bushes"]
    values = {(row["foot"], row["axis"], row["name"]): row["value"] for row in content["parameters"]}
    rows = content["campaign"]["table_1"]
    assert {(row["foot"], row["axis"], row["name"]) for row in rows} >= {
        (foot, axis, name) for foot in ("left", "right") for axis in ("pitch", "roll") for name in BARS
    }
    for row in (row for row in rows if row["name"] in BARS):
        true = truth[row["foot"]][f"{row['axis']}_{row['name']}"]
        error = 100 * (values[row["foot"], row["axis"], row["name"]] - true) / true
        assert row["error_percent"] == pytest.approx(error)
        assert abs(error) < BARS[row["name"]]


def test_the_paper_way_is_a_comparison_on_the_same_logs(content: dict[str, Any]) -> None:
    (other,) = content["comparisons"]
    assert other["settings"]["offset"] == "shared"
    assert content["settings"]["offset"] == "per-motion"
    assert other["settings"]["model"] == "kelvin_voigt"
    theirs = {(row["foot"], row["axis"], row["name"]): row["value"] for row in other["parameters"]}
    for row in content["campaign"]["table_1"]:
        assert row["paper_way"] == theirs.get((row["foot"], row["axis"], row["name"]))


def test_logs_are_read_back_from_their_files(content: dict[str, Any], demo: tuple[Path, str, str]) -> None:
    logs = demo[0] / "logs"
    assert {row["role"]: row["sha256"] for row in content["inputs"]} == {
        "fit": sha256(logs / "Tilt3.parquet"),
        "validate": sha256(logs / "Squat.parquet"),
    }


def test_the_simulated_chest_follows_the_recorded_one(content: dict[str, Any]) -> None:
    errors = {
        row["feet"]: row["error"] for row in content["campaign"]["replay"] if row["quantity"] == "chest pitch"
    }
    assert errors[IDENTIFIED] < errors[RIGID] / 5
    assert errors[RECORD] == pytest.approx(
        np.radians(0.005), rel=0.2
    )  # white noise: bias and drift are a line
    assert errors[IDENTIFIED] < 1.5 * errors[RECORD]


def test_the_report_holds_tables_and_figures(demo: tuple[Path, str, str]) -> None:
    page = (demo[0] / "report.html").read_text()
    for text in (
        "Beside the paper",
        "one shared offset, spring and damper",
        "Figure 3.",
        "Figure 9.",
        "Figure 11.",
        "In a simulator",
    ):
        assert text in page, text
    assert len(page) < 5_000_000
    assert not re.search(r'(src|href)="http', page)


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    yield from launched()


def test_the_scene_puts_the_robot_where_it_was(demo: tuple[Path, str, str], browser: Any) -> None:
    visit = Visit(browser, demo[0] / "robot.html")
    truth = pq.read_table(demo[0] / "logs" / "Tilt3.truth.parquet")
    moments, root, rate = (50, 120, 300), [], 10
    for frame in moments:
        pose = visit.page.evaluate(
            """frame => {
              const scene = JSON.parse(document.getElementById("scene").textContent);
              const motion = scene.motions[0], codes = robot.decode(motion);
              const width = codes.length / motion.frames;
              const values = Array.from(codes.subarray(frame * width, (frame + 1) * width), (c) => c * scene.step);
              return robot.placed(scene, motion, values, 1).bodies[0];
            }""",
            frame,
        )
        root.append([pose[3], pose[7], pose[11]])
    rows = np.array(moments) * 200 // rate
    true = np.column_stack([truth.column(f"base.{axis}").to_numpy()[rows] for axis in "xyz"])
    assert np.ptp(true[:, 0]) > 0.01  # the robot sways
    np.testing.assert_allclose(root, true, atol=0.004)
    drawn = (
        "stage => stage.getContext('2d').getImageData(0, 0, stage.width, stage.height).data.some((p) => p)"
    )
    assert visit.page.locator("#stage").evaluate(drawn)
    before = visit.page.locator("#stage").evaluate("stage => stage.toDataURL()")
    visit.page.locator("#play").click()
    visit.page.locator("#times").fill("10")
    assert visit.page.locator("#factor").text_content() == "10 times as far"
    assert visit.page.locator("#stage").evaluate("stage => stage.toDataURL()") != before
    assert visit.complaints == []
    assert visit.requests == [(demo[0] / "robot.html").as_uri()]


def test_a_file_for_the_folder_is_refused(tmp_path: Path) -> None:
    place = tmp_path / "taken"
    place.write_text("")
    code, out, error = run("demo", "--quick", "--out", place)
    assert (code, out) == (1, "")
    assert error.splitlines() == [f"plantar: {place}: is a file (valid: a folder for the results)"]


def test_an_unknown_preset_is_refused_before_anything_is_played(tmp_path: Path) -> None:
    code, out, error = run("demo", "--preset", "rosy", "--out", tmp_path / "out")
    assert (code, out) == (1, "")
    assert error.splitlines()[0].startswith("plantar: unknown preset 'rosy' (valid: ideal, ")
    assert not (tmp_path / "out").exists()


def test_the_paper_tables_agree_with_themselves() -> None:
    assert len(TABLE_1) == 12
    for row in TABLE_2.values():
        assert 100 * row.mean_abs_error / row.max_abs == pytest.approx(row.percent_of_max, abs=0.06)
    assert sum(len(cells) for cells in TABLE_3.values()) == 16
    for foot, bush in PAPER.items():
        for axis in ("pitch", "roll"):
            assert TABLE_1[foot, axis, "stiffness"].value == getattr(bush, f"{axis}_stiffness")
            assert TABLE_1[foot, axis, "damping"].value == getattr(bush, f"{axis}_damping")


def parameter(name: str, value: float, half: float) -> Parameter:
    interval = (value - half, value + half)
    return Parameter("right", "pitch", name, "N.m/rad", value, half / 2, interval, 0.1, "usable", "because")


def validation(kind: Any, motion: str, error: float, largest: float, samples: int) -> ValidationRow:
    return ValidationRow(kind, motion, "right", "pitch", error, error, largest, 1.0, 9.0, samples)


def result(*rows: ValidationRow, stiffness: float = 440.0) -> FeetResult:
    parameters = (parameter("stiffness", stiffness, 5.0), parameter("damping", 15.89, 1.0))
    return FeetResult("twin", (), {}, "kelvin_voigt", parameters, (), (), rows, ())


def test_errors_are_signed_and_in_percent_of_the_truth() -> None:
    stiffness, damping = parameters_beside(result(), result(stiffness=430.0), PAPER)
    assert stiffness.error_percent == pytest.approx(100 * 6 / 434)
    assert stiffness.paper_way_error_percent == pytest.approx(-100 * 4 / 434)
    assert (stiffness.covered, damping.covered) == (False, True)
    table = table_1([stiffness, damping])
    assert [cell.mark for cell in (table.rows[0][5], table.rows[1][5])] == ["bad", "good"]
    assert table.rows[0][10].text == "434.0 (0.20 %)"


def test_direct_validation_weighs_motions_by_their_samples() -> None:
    ours = result(validation("direct", "a", 1.0, 10.0, 100), validation("direct", "b", 4.0, 40.0, 300))
    (row,) = direct_beside(ours, replace(ours, validation=()))
    assert row.mean_abs_error == pytest.approx(3.25)
    assert row.percent_of_max == pytest.approx(100 * 3.25 / 40)
    assert (row.published, row.paper_way) == (6.54, None)


def test_cross_validation_puts_the_papers_motions_first() -> None:
    ours = result(validation("cross", "Tilt2", 0.1, 9.0, 10), validation("cross", "Squat", 0.3, 9.0, 10))
    squat, tilt = cross_beside(ours, ours)
    assert (squat.motion, squat.published, tilt.published) == ("Squat", 0.38, None)
    assert [row[2].mark for row in table_3([squat, tilt]).rows] == [
        "weak",
        "",
    ]  # more than half of the paper's


def test_scores_pool_motions_and_tell_who_falls() -> None:
    def rows(feet: str, *errors: float | None) -> list[ReplayRow]:
        return [
            ReplayRow(feet, motion, axis, "rad", error)
            for motion, error in zip("ab", errors, strict=True)
            for axis in ("chest pitch", "chest roll")
        ]

    every = [
        *rows(IDENTIFIED, 0.0, 0.001),
        *rows(RIGID, 0.02, 0.02),
        *rows("soft", 0.001, None),
        *rows("hard", 0.1, 0.1),
    ]
    found = {score.feet: score for score in scores(every)}
    assert found[IDENTIFIED].pitch == pytest.approx(0.001 / np.sqrt(2))
    assert found[RIGID].both == pytest.approx(0.02 * np.sqrt(2))
    assert found["soft"].both is None
    assert best_guess(every) == "hard"  # the soft one falls in a motion
    text = {row[0].text: [cell.text for cell in row[1:]] for row in simulator_table(every).rows}
    assert text["soft"][0] == "falls"
    assert text["hard"][1] == "5.000"


def test_bias_and_slow_drift_of_an_attitude_are_not_the_feets() -> None:
    time = np.arange(2001) / 200.0
    turn = Rotation.from_euler(
        "zyx", np.column_stack([0.6 * np.sin(time), 0.05 * np.cos(time), 0.1 * time / 10])
    )
    off = Rotation.from_rotvec(np.array([0.003, -0.002, 0.1]) + np.outer(time, [1e-4, -2e-4, 1e-3]))
    recorded = (off * turn).as_matrix()
    assert pitch_and_roll(moved_onto(recorded, turn.as_matrix())) == pytest.approx(
        pitch_and_roll(recorded[:, 2, :]), abs=2e-5
    )
    # what else lies between the two stays
    wave = 0.004 * np.cos(2 * np.pi * (time - time.mean()))  # even about the middle: no line is in it
    swayed = turn * Rotation.from_rotvec(np.outer(wave, [0.0, 1.0, 0.0]))
    left = pitch_and_roll(moved_onto(recorded, swayed.as_matrix())) - pitch_and_roll(recorded[:, 2, :])
    assert left == pytest.approx(np.outer(wave, [1.0, 0.0]), abs=3e-4)


def test_errors_of_a_replay() -> None:
    time = np.arange(400) / 200.0
    chest, place = np.tile([0.003, -0.004], (400, 1)), ("left", "roll")
    late = np.where(time > 1.0, -2.0, 50.0)  # the first second is not scored
    one = Replayed(
        "Tilt1", IDENTIFIED, time, {place: late}, {place: np.zeros(400)}, chest, np.zeros((400, 2))
    )
    assert one.chest_error() == pytest.approx((0.003, 0.004))
    assert one.torque_error(*place) == pytest.approx(2.0)


def test_a_robot_that_fell_keeps_its_rows() -> None:
    assert {row.error for row in replay_rows([], ["Squat"], ["soft"])} == {None}


def test_the_choice_of_motions_is_set_beside_the_papers() -> None:
    def choice(width: float, *motions: str) -> Choice:
        widths = {("left", "pitch", "stiffness"): width / 2, ("left", "roll", "damping"): 2 * width}
        return Choice(motions, widths, 1.0)

    best = (choice(3.0, "a"), choice(0.9, "a", "b"), choice(0.5, "a", "b", "c"))
    paper = choice(1.0, "a", "c", "d")
    found = Selection((), best, choice(0.4, *"abcd"), paper)
    table = choice_table(found)
    assert [row[0].text for row in table.rows] == ["best of 1", "best of 2", "best of 3", COMPOSED, TOGETHER]
    assert [cell.text for cell in table.rows[3][1:4]] == ["a, c, d", "1.0 %", "2.0 % (C left roll)"]
    said = "promises 1.0 %, the best set of 3 0.50 %; 2 suffice for what the composed motion promises."
    assert explained(found).endswith(said)
    assert explained(replace(found, compared=choice(0.5, "c", "b", "a"))).endswith(
        "no other set of 3 promises more."
    )
    as_many = replace(found, best=(choice(3.0, "a"), choice(2.0, "a", "b"), choice(0.5, "a", "b", "c")))
    assert explained(as_many).endswith("the best set of 3 0.50 %."), "three for three is no gain"
    assert choice_rows(found)[3]["half_widths"][1]["percent"] == 2.0


def test_postures_stand_on_the_floor() -> None:
    robot = hrp2.robot()
    drawn = boxes(look_of(robot), planned("Manual_left_roll", robot))
    corners = np.vstack([box.corners for box in drawn])
    assert corners[:, 2].min() == pytest.approx(0.0, abs=1e-3)
    assert 1.4 < corners[:, 2].max() < 1.6
    feet = {
        box.side: box.corners[:, 2].min()
        for box in drawn
        if np.ptp(box.corners[:, 0]) == pytest.approx(0.2172, abs=0.01)
    }
    assert feet["right"] > 0.05 > feet["left"]  # the right leg is raised
