"""What a worker makes of logs that fail, without a fit: who is blamed, what is left, how much memory there is."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from plantar.errors import DataError, LogError, NoRoom, PlantarError
from plantar.fleet import work
from plantar.fleet.manifest import Log
from plantar.fleet.places import Stamp
from plantar.fleet.unit import Failure, UnitInput
from plantar.fleet.work import _failure, _Fetched, _fetched, _identified, _opened


def fetched(name: str, role: Any = "fit") -> _Fetched:
    place = f"s3://logs/{name}.csv"
    entry = UnitInput(place, f"{name}.csv", role, "hash", Stamp(1, "now"))
    return _Fetched(Log(place, role), Path(f"/tmp/plantar-1/{name}/{name}.csv"), entry)


A, B, C = fetched("a"), fetched("b"), fetched("c", "validate")


def test_an_error_is_of_the_one_log_that_it_names_and_tells_where_that_is() -> None:
    assert _failure([A, B], DataError("is short", path=A.path)) == Failure(
        "s3://logs/a.csv", "s3://logs/a.csv: is short"
    )
    both = _failure([A, B], PlantarError(f"{A.path} and {B.path} differ"))
    assert both == Failure("", "s3://logs/a.csv and s3://logs/b.csv differ")
    assert _failure([A, B], PlantarError("no foot stands")) == Failure("", "no foot stands")
    assert _failure([B], PlantarError("no foot stands")) == Failure("s3://logs/b.csv", "no foot stands")


@pytest.mark.parametrize(("memory", "left"), [(100, [100, 70, 70]), (None, [None, None, None])])
def test_each_log_has_the_memory_that_those_before_it_leave(
    memory: int | None, left: list[int | None], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The second one cannot be read: it takes none."""
    seen: list[int | None] = []

    def open_together(paths: list[Path], robot: object, room: int | None) -> list[Any]:
        seen.append(room)
        if paths == [B.path]:
            raise LogError("is no log", path=B.path)
        return [SimpleNamespace(size=30, name=path.stem) for path in paths]

    monkeypatch.setattr(work, "open_together", open_together)
    logs, failures = _opened(None, [A, B, C], memory)  # type: ignore[arg-type]
    assert seen == left
    assert [(one, log.name) for one, log in logs] == [(A, "a"), (C, "c")]
    assert failures == [Failure("s3://logs/b.csv", "s3://logs/b.csv: is no log")]


def test_a_machine_that_is_too_small_is_no_logs_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    def open_together(*_: object) -> Any:
        raise NoRoom("does not fit", path=A.path)

    monkeypatch.setattr(work, "open_together", open_together)
    with pytest.raises(NoRoom):
        _opened(None, [A, B], 10)  # type: ignore[arg-type]


def test_logs_that_are_refused_by_name_are_left_out_and_the_others_fitted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked: list[tuple[list[str], list[str]]] = []
    refusals = {"a": A, "c": C}

    def identify(robot: object, fit: list[str], validate: list[str], settings: object) -> Any:
        asked.append((fit, validate))
        for name in fit + validate:
            if name in refusals:
                raise DataError("is short", path=refusals[name].path)
        return "the result"

    monkeypatch.setattr(work, "identify_feet", identify)
    failures: list[Failure] = []
    logs: Any = [(A, "a"), (B, "b"), (C, "c")]
    assert _identified(None, logs, None, failures) == "the result"  # type: ignore[arg-type, comparison-overlap]
    assert asked == [(["a", "b"], ["c"]), (["b"], ["c"]), (["b"], [])]
    assert [one.log for one in failures] == ["s3://logs/a.csv", "s3://logs/c.csv"]
    assert _identified(None, logs[::2], None, []) is None, "none is left to fit"  # type: ignore[arg-type]
    assert len(asked) == 4


def test_an_error_that_names_no_log_ends_the_group(monkeypatch: pytest.MonkeyPatch) -> None:
    def identify(*_: object) -> Any:
        raise DataError("no foot stands")

    monkeypatch.setattr(work, "identify_feet", identify)
    failures: list[Failure] = []
    assert _identified(None, [(A, "a"), (B, "b")], None, failures) is None  # type: ignore[arg-type, list-item]
    assert failures == [Failure("", "no foot stands")]


def test_logs_that_are_not_there_are_told_where_they_should_be(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two of one name do not stand in each other's way; what fails on this machine is told by its own place."""
    (tmp_path / "x").mkdir()
    for place in ("x/log.csv", "log.csv"):
        (tmp_path / place).write_text(place)

    def brought(place: str, folder: Path) -> Path:
        if place.endswith("gone.csv"):
            raise PlantarError("cannot be read", path=folder / "gone.csv")
        (folder / "log.csv").write_text(Path(place).read_text())
        return folder / "log.csv"

    monkeypatch.setattr(work, "brought", brought)
    (tmp_path / "gone.csv").write_text("")
    places = [str(tmp_path / name) for name in ("x/log.csv", "gone.csv", "log.csv")]
    task = SimpleNamespace(logs=[Log(place, "fit") for place in places])
    folder = tmp_path / "own"
    folder.mkdir()
    found, missing = _fetched(task, folder)  # type: ignore[arg-type]
    assert [(one.log.place, one.path.read_text()) for one in found] == [
        (places[0], "x/log.csv"),
        (places[2], "log.csv"),
    ]
    assert [one.entry.name for one in found] == ["log.csv", "log.csv"]
    assert missing == [Failure(places[1], f"{places[1]}: cannot be read")]


@pytest.mark.parametrize("rows", [(), ("a row",)])
def test_a_unit_that_is_there_is_taken_as_it_is(
    rows: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """One without rows has failed, this time too."""
    monkeypatch.setattr(work, "_fetched", lambda task, folder: ([A], []))
    monkeypatch.setattr(work, "task_key", lambda task, inputs: f"key of {inputs[0].name}")
    monkeypatch.setattr(work, "kept", lambda store, key: SimpleNamespace(rows=rows))
    done = work.compute(SimpleNamespace(store=None))  # type: ignore[arg-type]
    assert (done.key, done.reused, done.failures, done.failed) == ("key of a.csv", True, (), not rows)
    assert 0.0 <= done.seconds < 60.0
