"""Files of a fleet, local and in a store: whole or not there, and one line for whatever goes wrong."""

from __future__ import annotations

import os
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import fsspec
import pytest
from fsspec.implementations.memory import MemoryFileSystem

from plantar.errors import PlantarError
from plantar.fleet.places import (
    PlaceError,
    Store,
    brought,
    content_sha256,
    found_at,
    joined_place,
    name_of,
    stamp_of,
    time_of,
)


class Refusal(Exception):
    """An error of a store's package that is no OSError."""


class Closed(MemoryFileSystem):
    """A store that refuses everything."""

    protocol = "closed"

    def _refuse(self, *_: object, **__: object) -> None:
        raise Refusal("no key\nfor you")

    info = glob = find = get = isdir = modified = cat = pipe_file = makedirs = _refuse


@pytest.fixture(scope="module", autouse=True)
def closed() -> None:
    fsspec.register_implementation("closed", Closed, clobber=True)


@pytest.mark.parametrize("place", ["local", "memory://fleet/store"])
def test_a_store_gives_back_what_it_was_given(place: str, tmp_path: Path) -> None:
    store = Store(place if "://" in place else str(tmp_path / place))
    assert store.read("a/b.json") is None
    assert store.names("a") == []
    store.write("a/b.json", b"1")
    store.write("a/b.json", b"2")
    store.write("a/c/d.json", b"3")
    assert store.read("a/b.json") == b"2"
    assert store.names("a") == ["a/b.json", "a/c/d.json"]
    assert store.read("a/b.json/c") is None, "nothing is below a file"
    assert list(store.read_each(["a/c/d.json", "none", "a/b.json"])) == [b"3", None, b"2"]


@pytest.mark.parametrize(
    "act",
    [
        stamp_of,
        found_at,
        time_of,
        lambda place: brought(place, Path("/nowhere")),
        lambda place: Store(place).write("x", b""),
        lambda place: Store(place).read("x"),
        lambda place: Store(place).names("x"),
    ],
)
def test_whatever_a_store_says_is_one_line(act: Callable[[str], object]) -> None:
    with pytest.raises(PlantarError) as told:
        act("closed://bucket/log.csv")
    assert "no key for you" in str(told.value)
    assert str(told.value).startswith("closed://bucket/log.csv")
    assert "\n" not in str(told.value)


def test_a_store_that_cannot_be_used_is_told_apart_from_a_log_that_cannot_be_read(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(PlaceError, match="cannot be written"):
        Store(str(tmp_path / "file")).write("x", b"")
    (tmp_path / "folder").mkdir()
    with pytest.raises(PlaceError, match="cannot be read"):
        Store(str(tmp_path)).read("folder")


def test_a_folder_has_a_stamp_and_a_content(tmp_path: Path) -> None:
    for name, text in (("one", "a"), ("two", "a")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "part.db3").write_text(text)
    assert content_sha256(tmp_path / "one") == content_sha256(tmp_path / "two")
    before = stamp_of(str(tmp_path / "one"))
    (tmp_path / "one" / "part.db3").write_text("longer")
    assert stamp_of(str(tmp_path / "one")) != before
    assert content_sha256(tmp_path / "one") != content_sha256(tmp_path / "two")


def test_a_folders_content_is_that_of_its_folders_too(tmp_path: Path) -> None:
    for name, text in (("one", "a"), ("two", "b")):
        (tmp_path / name / "within").mkdir(parents=True)
        (tmp_path / name / "within" / "part.db3").write_text(text)
    assert content_sha256(tmp_path / "one") != content_sha256(tmp_path / "two")
    (tmp_path / "two" / "within" / "part.db3").write_text("a")
    assert content_sha256(tmp_path / "one") == content_sha256(tmp_path / "two")
    (tmp_path / "two" / "within").rename(tmp_path / "two" / "elsewhere")
    assert content_sha256(tmp_path / "one") != content_sha256(tmp_path / "two")


def test_remote_files_are_brought_under_their_name(tmp_path: Path) -> None:
    system = fsspec.filesystem("memory")
    system.pipe_file("/logs/day.csv", b"time\n")
    place = "memory://logs/day.csv"
    assert brought(place, tmp_path).read_bytes() == b"time\n"
    assert (tmp_path / "day.csv").is_file()
    assert stamp_of(place).size == 5
    assert abs((datetime.now(UTC) - time_of(place)).total_seconds()) < 60
    assert found_at("memory://logs/*.csv") == ["memory:///logs/day.csv"]
    with pytest.raises(PlantarError, match=r"none\.csv: does not exist"):
        brought("memory://logs/none.csv", tmp_path)


def test_places_beside_a_manifest() -> None:
    assert joined_place(Path("/a/fleet.csv"), "logs/x.csv") == "/a/logs/x.csv"
    assert joined_place(Path("/a/fleet.csv"), "/b/x.csv") == "/b/x.csv"
    assert joined_place(Path("/a/fleet.csv"), "s3://b/x.csv") == "s3://b/x.csv"
    assert (name_of("s3://b/x.csv"), name_of("/b/bag/")) == ("x.csv", "bag")


def test_an_error_without_words_is_told_by_its_kind(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise Refusal

    for name in ("info", "glob", "find", "isdir", "modified"):
        monkeypatch.setattr(Closed, name, refuse)
    with pytest.raises(PlantarError, match=r"closed://bucket/log\.csv.* cannot be read: Refusal"):
        stamp_of("closed://bucket/log.csv")


def test_a_folder_is_another_where_one_of_its_files_was_written_anew(tmp_path: Path) -> None:
    """By the time alone: its size stays."""
    inner = tmp_path / "bag" / "inner"
    inner.mkdir(parents=True)
    for name in ("a", "b"):
        (inner / name).write_bytes(b"12345")
    before = stamp_of(str(tmp_path / "bag"))
    assert before.size == 10
    assert stamp_of(str(tmp_path / "bag")) == before
    os.utime(inner / "b", ns=(0, 1_000))
    after = stamp_of(str(tmp_path / "bag"))
    assert (after.size, after != before) == (10, True)


def test_a_folder_of_a_store_is_as_large_as_its_files_and_another_with_any_of_them() -> None:
    system = fsspec.filesystem("memory")
    system.pipe_file("/logs/bag/a", b"12345")
    system.pipe_file("/logs/bag/inner/b", b"123")
    before = stamp_of("memory://logs/bag")
    assert before.size == 8
    assert stamp_of("memory://logs/bag") == before
    system.pipe_file("/logs/bag/inner/b", b"124")
    assert stamp_of("memory://logs/bag") != before, "written anew"
