"""The campaign end to end through the command line: what it writes, beside the truth."""

from __future__ import annotations

import io
import json
import re
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from kept_texts import assert_as_kept, lines_of
from plantar.campaign.replay import IDENTIFIED, RECORD, RIGID
from plantar.cli import main
from plantar.files import sha256
from report_visit import Visit, launched
from twin_samples import planned_part

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
    """Folder, stdout and stderr of a quick demo, of parts of its motions."""
    folder = tmp_path_factory.mktemp("demo")
    with pytest.MonkeyPatch.context() as patch:
        for module in ("twin.play", "campaign.replay", "campaign.pictures"):
            patch.setattr(import_module(f"plantar.{module}"), "planned", planned_part)
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
    moments, root, rate = (50, 120, 190), [], 10
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


def test_its_numbers_and_words_are_as_they_are_kept(
    content: dict[str, Any], demo: tuple[Path, str, str]
) -> None:
    folder, out, error = demo
    kept = Path(__file__).parent / "kept"
    said = re.sub(r"[─━]+|\d+(\.\d)? s\b|.*: \d+ %\n", "", out + error).replace(str(folder.parent), "FOLDER")
    assert_as_kept(re.sub(r"\S*FOLDER[\s\S]*?\n\n", "", said), kept / "said.txt", share=5e-3)
    left_out = ("created", "plantar", "inputs", "robot_model", "phases", "path", "sha256", "assumptions")
    assert_as_kept(lines_of(content, *left_out), kept / "result.txt", share=2e-3, least=1e-5)
