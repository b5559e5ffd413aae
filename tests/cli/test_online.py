"""`plantar online` as a user calls it."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from command_line import refused, run
from plantar.cli import online
from plantar.cli.online import _plain
from plantar.report import live


def test_a_log_is_replayed_and_told_as_json(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert (
        run("online", campaign / "robot.yaml", campaign / "first.csv", "--wrench-delay", 0, "--json", "-q")
        == 0
    )
    found = json.loads(capsys.readouterr().out)
    assert set(found) == {"parameters", "latency_us", "samples"}
    assert set(found["latency_us"]) == {"median", "p999", "max"}
    assert found["samples"] == 1201
    assert 0 < found["latency_us"]["median"] < 1000
    rows = {(row["foot"], row["axis"], row["name"]): row for row in found["parameters"]}
    assert rows["left", "pitch", "stiffness"]["value"] == pytest.approx(420.0, rel=0.02)


def test_a_log_is_replayed_and_told_as_tables(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = tmp_path / "biped.estimator"
    assert run("online", campaign / "robot.yaml", campaign / "first.csv", "--write-model", model) == 0
    out = capsys.readouterr().out
    assert "At the end of the log" in out
    assert "a step: median" in out
    assert model.read_text().startswith("plantar.foot_estimator/1")


def test_on_a_terminal_a_table_is_refreshed_and_goes(
    campaign: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    monkeypatch.setattr("plantar.cli.online.REFRESH", 0.0)
    monkeypatch.setenv("TTY_COMPATIBLE", "1")
    assert run("online", campaign / "robot.yaml", campaign / "first.csv", "--wrench-delay", 0) == 0
    before, _, after = capsys.readouterr().out.partition("At the end of the log")
    assert [f"At {seconds:.1f} s" in before for seconds in (1.0, 6.0, 12.0)] == [True] * 3
    assert "flags now" in before
    assert "flags now" not in after


def test_the_table_is_not_drawn_more_often_than_one_can_read(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ten pieces of a log, 40 ms apart: a table behind the third of them, and behind each third from there on."""
    drawn: list[int] = []
    clock = iter(0.04 * np.arange(1, 30))
    estimator = SimpleNamespace(replay_in_pieces=lambda log, piece: range(1, 11))
    monkeypatch.setattr(online, "time", SimpleNamespace(monotonic=lambda: next(clock)))
    monkeypatch.setattr(online, "_so_far", lambda replay: drawn.append(replay) or "")
    assert online._refreshed(estimator, None) == 10  # type: ignore[arg-type, comparison-overlap]
    assert drawn == [3, 6, 9]


def test_a_log_is_drawn(campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ("online", campaign / "robot.yaml", campaign / "first.csv", "--wrench-delay", 0, "-q", "--plot")
    for kind, begin in (("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")):
        assert run(*words, tmp_path / f"log.{kind}") == 0
        assert (tmp_path / f"log.{kind}").read_bytes().startswith(begin)
    assert "valid: .png, .svg, .pdf" in refused(capsys, *words, tmp_path / "log.jpg")


@pytest.mark.parametrize(
    ("half", "text"),
    [(226.0, "± 230"), (3.46, "± 3.5"), (0.0123, "± 0.012"), (23.4e6, "± 23000000"), (None, "–")],
)
def test_a_half_width_has_two_digits_and_no_power_of_ten(half: float | None, text: str) -> None:
    assert _plain(half) == text


def test_the_delay_is_told_in_ms_and_written_in_s(campaign: Path, tmp_path: Path) -> None:
    model = tmp_path / "biped.estimator"
    words = ("--wrench-delay", 7.5, "--write-model", model, "-q")
    assert run("online", campaign / "robot.yaml", campaign / "first.csv", *words) == 0
    assert "wrench_delay 0.0075 0" in model.read_text()


def test_a_joint_that_the_log_lacks_is_noted(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = [line.split(",") for line in (campaign / "first.csv").read_text().splitlines()]
    kept = [place for place, name in enumerate(lines[0]) if name != "joint.neck.position"]
    log = tmp_path / "short.csv"
    log.write_text("\n".join(",".join(line[place] for place in kept) for line in lines) + "\n")
    assert run("online", campaign / "robot.yaml", log, "--wrench-delay", 0) == 0
    assert "neck" in capsys.readouterr().out


def test_what_is_wrong_is_one_line(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "does not exist" in refused(capsys, "online", campaign / "robot.yaml", tmp_path / "none.csv", "-q")
    words = ("online", campaign / "robot.yaml", campaign / "first.csv", "--wrench-delay", 2000, "-q")
    assert "wrench_delay" in refused(capsys, *words)


def verdicts(out: str) -> dict[str, set[str]]:
    """Of each axis' numbers, and the reasons."""
    rows = json.loads(out)["parameters"]
    return {"verdict": {row["verdict"] for row in rows}, "reason": {row["reason"] for row in rows}}


def test_without_a_batch_result_nothing_is_called_usable(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Hysteresis cannot be told from a spring while small motions run."""
    robot, log = campaign / "robot.yaml", campaign / "first.csv"
    assert run("online", robot, log, "--wrench-delay", 0, "--json", "-q") == 0
    alone = verdicts(capsys.readouterr().out)
    assert "usable" not in alone["verdict"]
    assert any("hysteresis" in reason for reason in alone["reason"])
    assert run("identify", "feet", robot, log, "--out", tmp_path / "feet", "-q") == 0
    capsys.readouterr()
    assert run("online", robot, log, "--result", tmp_path / "feet" / "result.json", "--json", "-q") == 0
    assert "usable" in verdicts(capsys.readouterr().out)["verdict"]


def test_a_log_with_a_fault_is_refused(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot, lines = campaign / "robot.yaml", (campaign / "first.csv").read_text().splitlines()
    heads, rows = lines[0].split(","), [line.split(",") for line in lines[1:]]
    rates = {place for place, name in enumerate(heads) if ".angular_velocity." in name}
    assert rates
    degrees = [[str(57.3 * float(x)) if place in rates else x for place, x in enumerate(row)] for row in rows]
    log = tmp_path / "degrees.csv"
    log.write_text("\n".join([lines[0], *(",".join(row) for row in degrees)]) + "\n")
    assert "degrees" in refused(capsys, "online", robot, log, "--wrench-delay", 0, "-q")


def test_the_command_plays_the_log_once_somebody_reads(
    campaign: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shown = list[float]()
    monkeypatch.setattr(live.LiveView, "wait_for_reader", lambda view, longest: True)
    monkeypatch.setattr(live.LiveView, "show", lambda view, now, found: shown.append(now))
    monkeypatch.setattr(live.time, "sleep", lambda seconds: None)
    words = ("--wrench-delay", 0, "--live", "--port", 8491, "--json", "-q")
    assert run("online", campaign / "robot.yaml", campaign / "first.csv", *words) == 0
    told = capsys.readouterr()
    assert told.out.startswith("{"), "nothing but JSON on stdout"
    assert "open http://127.0.0.1:" in told.err
    assert len(shown) == 240
    assert shown == sorted(shown)


def test_a_page_that_nobody_opens_ends(
    campaign: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("plantar.cli.online.LONGEST_WAIT", 0.0)
    words = ("--wrench-delay", 0, "--live", "--port", 8495, "-q")
    assert run("online", campaign / "robot.yaml", campaign / "first.csv", *words) == 0
    assert "nobody has opened the page" in capsys.readouterr().err
