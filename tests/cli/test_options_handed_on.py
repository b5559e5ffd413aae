"""What a command is told reaches what it calls, each option under its own name and in its unit."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from biped_robot import write_robot
from command_line import run
from plantar.errors import PlantarError
from plantar.feet.settings import FeetSettings
from plantar.whole_body.settings import DynamicsSettings


class Seen:
    """Stands for what a command calls: keeps what it was given, and ends the command."""

    def __init__(self, module: str, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
        self.given: tuple[Any, ...] = ()
        self.named: dict[str, Any] = {}
        self.module = importlib.import_module(module)
        monkeypatch.setattr(self.module, name, self)

    def __call__(self, *given: Any, **named: Any) -> Any:
        self.given, self.named = given, named
        raise PlantarError("far enough")


def workers(seen: Seen, monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    asked: list[Any] = []

    @contextmanager
    def connected(*given: Any) -> Iterator[str]:
        asked.extend(given)
        yield "client"

    monkeypatch.setattr(seen.module, "connected", connected)
    return asked


def test_fleet_run(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seen = Seen("plantar.cli.fleet.run", "run_fleet", monkeypatch)
    asked = workers(seen, monkeypatch)
    monkeypatch.setattr(seen.module, "read_manifest", lambda place: [place])
    monkeypatch.setattr(seen.module, "dashboard", lambda client: None)
    told = (
        "--workers",
        3,
        "--memory",
        "2GB",
        "--offset",
        "shared",
        "--model",
        "elastoplastic",
        "--wrench-delay",
        "4",
    )
    assert run("fleet", "run", "fleet.csv", "--out", tmp_path / "out", *told) == 1
    assert asked == [3, None, 2_000_000_000]
    groups, store, settings, client, _, room = seen.given
    assert (groups, store.place, client) == (["fleet.csv"], str(tmp_path / "out"), "client")
    assert settings == FeetSettings("shared", "elastoplastic", wrench_delay=0.004)
    assert room == 500_000_000, "a quarter of a worker's memory for the logs' numbers"
    assert run("fleet", "run", "fleet.csv", "--out", tmp_path / "out") == 1
    assert (asked[3:], seen.given[2], seen.given[5]) == ([None, None, None], FeetSettings(), None)


def test_fleet_inertia(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seen = Seen("plantar.cli.fleet.inertia", "inertia_over", monkeypatch)
    asked = workers(seen, monkeypatch)
    logs = [
        SimpleNamespace(place=place, role=role)
        for place, role in (("a", "fit"), ("b", "validate"), ("c", "fit"))
    ]
    groups = [
        SimpleNamespace(robot="robot.yaml", logs=logs),
        SimpleNamespace(robot="robot.yaml", logs=logs[:1]),
    ]
    monkeypatch.setattr(seen.module, "read_manifest", lambda place: groups)
    told = ("--scheduler", "tcp://here:1", "--memory", "1GB", "--cutoff", "7", "--as-recorded")
    assert run("fleet", "inertia", "fleet.csv", "--out", tmp_path / "out", *told) == 1
    assert asked == [None, "tcp://here:1", 1_000_000_000]
    assert seen.given[:4] == ("client", "robot.yaml", ["a", "c"], DynamicsSettings(7.0, True))
    groups.append(SimpleNamespace(robot="other.yaml", logs=logs))
    seen.given = ()
    assert run("fleet", "inertia", "fleet.csv", "--out", tmp_path / "out") == 1
    assert seen.given == (), "of two robots nothing adds up"


def test_export(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = Seen("plantar.cli.export", "export", monkeypatch)
    told = ("--to", "mjcf", "--out", "o.xml", "--model", "m.xml", "--with-offset", "--swing", "0.02", "--hysteresis",
            "--pivot", "bush", "--least-load", "0.25")  # fmt: skip
    assert run("export", "result.json", *told) == 1
    assert seen.given == (Path("result.json"), "mjcf", Path("o.xml"), Path("m.xml"))
    assert seen.named == {
        "with_offset": True,
        "swing": 0.02,
        "hysteresis": True,
        "pivot": "bush",
        "least_load": 0.25,
    }


def test_convert(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seen = Seen("plantar.cli.convert", "open_log", monkeypatch)
    robot = write_robot(tmp_path)
    assert run("convert", "walk.bag", "--out", tmp_path / "o.csv", "--robot", robot, "--memory", "3GB") == 1
    assert (seen.given[0], seen.given[1].name, seen.named) == (
        Path("walk.bag"),
        "biped",
        {"memory": 3_000_000_000},
    )


def test_simulate(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seen = Seen("plantar.twin", "play_all", monkeypatch)
    told = ("--preset", "ideal", "--seed", 5, "--sway", "0.04", "--vertical", "0.02", "--apart", "0.3", "--period", "4",
            "--bush", "1,2,3,4")  # fmt: skip
    assert run("simulate", "Tilt1,Squat", "--out", tmp_path / "out", *told) == 1
    motions, robot, bushes, preset, seeds, _ = seen.given
    assert (motions, robot, preset, seeds) == (["Tilt1", "Squat"], None, "ideal", [5])
    left = bushes["left"]
    assert (left.pitch_stiffness, left.pitch_damping, left.roll_stiffness, left.roll_damping) == (1, 2, 3, 4)
    assert seen.named == {"sway": 0.04, "vertical": 0.02, "apart": 0.3, "period": 4.0}
    fleet = Seen("plantar.twin.fleet", "write_fleet", monkeypatch)
    assert run("simulate", "fleet", "--out", tmp_path / "out", "--robots", 3, "--days", 7, "--seed", 2) == 1
    assert fleet.given == (tmp_path / "out", 3, 7)
    assert {key: fleet.named[key] for key in ("motion", "preset", "seed")} == {
        "motion": "Tilt3", "preset": "sensors", "seed": 2,
    }  # fmt: skip


def test_validate(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seen = Seen("plantar.cli.validate", "open_together", monkeypatch)
    monkeypatch.setattr(seen.module.FeetResult, "load", lambda path, residuals: (path, residuals))
    assert run("validate", "r.json", write_robot(tmp_path), "a.csv", "b.csv", "--memory", "1GB") == 1
    logs, robot, memory = seen.given
    assert (logs, robot.name, memory) == ([Path("a.csv"), Path("b.csv")], "biped", 1_000_000_000)


def test_design(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seen = Seen("plantar.design.story", "design_motion", monkeypatch)
    told = ("--stiffness", "500", "--damping", "15", "--duration", "40", "--criterion", "D", "--seed", 4)
    assert run("design", write_robot(tmp_path), "--out", tmp_path / "m.CSV", *told) == 1
    robot, settings, earlier, _ = seen.given
    assert (robot.name, earlier) == ("biped", None)
    assert settings == seen.module.DesignSettings(500.0, 15.0, 40.0, "D", 4)  # type: ignore[attr-defined]


def test_identify_feet(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    command = importlib.import_module("plantar.cli.identify.feet")
    asked: list[Any] = []

    def open_in_turn(paths: list[Path], robot: str, size: Any, memory: int, ahead: Any) -> list[str]:
        asked.extend([robot, memory])
        return [path.stem for path in paths]

    monkeypatch.setattr(command, "read_ahead", lambda paths, memory: None)
    monkeypatch.setattr(command, "robot_of", lambda place: "robot")
    monkeypatch.setattr(command, "open_in_turn", open_in_turn)
    seen = Seen("plantar.feet.prepare", "prepare_all", monkeypatch)
    told = ("--offset", "shared", "--model", "hardening", "--wrench-delay", "-3", "--cutoff", "4", "--window", "1.5",
            "--memory", "1GB", "--validate", "c.csv", "--validate", "d.csv")  # fmt: skip
    assert (
        run("identify", "feet", write_robot(tmp_path), "a.csv", "b.csv", "--out", tmp_path / "out", *told)
        == 1
    )
    robot, fitted, unseen, settings, *_ = seen.given
    assert (robot, fitted, unseen) == ("robot", ["a", "b"], ["c", "d"])
    window = pytest.approx(0.026179939)  # 1.5 degrees
    assert settings == FeetSettings("shared", "hardening", 4.0, window=settings.window, wrench_delay=-0.003)
    assert settings.window == window
    assert asked == ["robot", 1_000_000_000]


@pytest.mark.parametrize("what", ["inertia", "joints"])
def test_identify_inertia_and_joints(what: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seen = Seen(f"plantar.cli.identify.{what}", f"identify_{what}", monkeypatch)
    opened: list[Any] = []
    monkeypatch.setattr(
        seen.module.identification, "opened", lambda *given: opened.extend(given) or ("robot", ["a"], ["b"])
    )
    told = ("--cutoff", "7", "--as-recorded", "--memory", "1GB", "--validate", "b.csv")
    more = ("--inertia", "known") if what == "joints" else ()
    assert run("identify", what, "robot.yaml", "a.csv", "--out", tmp_path / "out", *told, *more) == 1
    logs, unseen = [Path("a.csv")], [Path("b.csv")]
    assert opened == [Path("robot.yaml"), logs, unseen, tmp_path / "out", 1_000_000_000]
    assert seen.given[:4] == ("robot", ["a"], ["b"], DynamicsSettings(7.0, True))
    assert seen.named == ({"inertia": "known"} if more else {})


def test_compare_and_select(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    robot = write_robot(tmp_path)
    seen = Seen("plantar.comparison.compare", "compare", monkeypatch)
    command = importlib.import_module("plantar.cli.compare")
    monkeypatch.setattr(command.FeetResult, "load", lambda path, residuals: path)
    monkeypatch.setattr(command, "open_together", lambda logs, known, memory: (logs, known.name, memory))
    told = ("--swing", "0.02", "--pivot", "bush", "--least-load", "0.3", "--memory", "1GB")
    assert run("compare", "r.json", robot, "a.csv", *told) == 1
    assert (seen.given[0], seen.given[1].name, seen.given[2]) == (
        Path("r.json"), "biped", ([Path("a.csv")], "biped", 1_000_000_000),
    )  # fmt: skip
    assert seen.given[4:] == (0.02, command.Stance("bush", 0.3))
    chosen = Seen("plantar.cli.select", "select_motions", monkeypatch)
    monkeypatch.setattr(chosen.module, "open_together", lambda logs, known, memory: (logs, memory))
    assert run("select", robot, "a.csv", "b.csv", "--compare", "x, y", "--largest", 4, "--memory", "1GB") == 1
    assert chosen.given[1:] == (([Path("a.csv"), Path("b.csv")], 1_000_000_000), ["x", "y"], 4)


def test_init(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seen = Seen("plantar.cli.init", "guess_robot_file", monkeypatch)
    out = tmp_path / "robot.yaml"
    assert run("init", "r.urdf", "a.csv", "--out", out, "--columns", "c.yaml") == 1
    assert seen.given == (Path("r.urdf"), [Path("a.csv")], out, Path("c.yaml"))
    out.write_text("")
    seen.given = ()
    assert run("init", "r.urdf", "--out", out) == 1
    assert seen.given == (), "nothing is written over"
    assert run("init", "r.urdf", "--out", out, "--force") == 1
    assert seen.given == (Path("r.urdf"), [], out, None)
