"""Files of a fleet, local and in a store: whole or not there, and one line for whatever goes wrong."""

from __future__ import annotations

import os
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import fsspec
import pytest
from fsspec.implementations.memory import MemoryFileSystem

from plantar.errors import PlantarError
from plantar.fleet import places
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
    with pytest.raises(PlaceError, match=r"x: cannot be written: File exists$"):
        Store(str(tmp_path / "file")).write("x", b"")
    (tmp_path / "folder").mkdir()
    with pytest.raises(PlaceError, match=r"folder: cannot be read: Is a directory$"):
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
    with pytest.raises(PlantarError, match=r"^memory://logs/none\.csv: does not exist$"):
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


@pytest.mark.parametrize("store", ["", "memory:/"])
def test_in_whatever_order_a_system_lists_its_files(
    store: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A folder is the same one, and its files come by name."""
    place = f"{store}{tmp_path}/bag"
    system = fsspec.filesystem("memory" if store else "file")
    for number, name in enumerate(("a", "b", "inner/c")):
        system.makedirs(f"{tmp_path}/bag/inner", exist_ok=True)
        system.pipe_file(f"{tmp_path}/bag/{name}", b"12345"[number:])
    for number, name in enumerate(("a", "b", "inner/c") if not store else ()):
        os.utime(tmp_path / "bag" / name, ns=(0, 1_000 * number))
    before = stamp_of(place)
    glob, find = Path.rglob, type(system).find
    monkeypatch.setattr(Path, "rglob", lambda *given: reversed(list(glob(*given))))

    def backwards(*given: Any, detail: bool = False) -> Any:
        found = find(*given, detail=True)
        turned = {name: found[name] for name in reversed(found)}
        return turned if detail else list(turned)

    monkeypatch.setattr(type(system), "find", backwards)
    assert stamp_of(place) == before
    assert Store(place).names("") == ["a", "b", "inner/c"]


def test_a_folder_of_a_store_is_as_large_as_its_files_and_another_with_any_of_them() -> None:
    system = fsspec.filesystem("memory")
    system.pipe_file("/logs/bag/a", b"12345")
    system.pipe_file("/logs/bag/inner/b", b"123")
    before = stamp_of("memory://logs/bag")
    assert before.size == 8
    assert stamp_of("memory://logs/bag") == before
    system.pipe_file("/logs/bag/inner/b", b"124")
    assert stamp_of("memory://logs/bag") != before, "written anew"


@pytest.mark.parametrize("place", ["local", "memory://fleet/many"])
def test_many_files_are_read_a_few_at_a_time_and_come_in_their_order(
    place: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(places, "AT_ONCE", 2)
    store = Store(place if "://" in place else str(tmp_path / place))
    for name in "abcd":
        store.write(f"{name}.json", name.encode())
    asked: list[list[str]] = []
    monkeypatch.setattr(
        Store, "_batch", lambda own, names, batch=Store._batch: (asked.append(names), batch(own, names))[1]
    )
    names = [f"{name}.json" for name in "dxbca"]
    assert list(store.read_each(names)) == [b"d", None, b"b", b"c", b"a"]
    assert asked == [names[:2], names[2:4], names[4:]]
    assert list(store.read_each([])) == []


def test_a_file_of_a_store_that_is_no_object_store_appears_when_it_is_whole(tmp_path: Path) -> None:
    store = Store(f"file://{tmp_path}/made/later")
    store.write("units/a.json", b"1")
    assert (tmp_path / "made" / "later" / "units" / "a.json").read_bytes() == b"1"
    assert store.names("units") == ["units/a.json"], "no part of it is left"
    assert store.names("units/none") == []
    assert store.path("units/a.json") == f"file://{tmp_path}/made/later/units/a.json"
    assert Store("out").path("units/a.json") == str(Path("out", "units", "a.json"))


def test_a_stores_file_has_the_tag_or_the_time_that_its_store_tells() -> None:
    assert places._change({"size": 3}) == ""
    assert places._change({"created": 1, "mtime": 2, "LastModified": None}) == "2"
    assert places._change({"mtime": 2, "etag": "x", "ETag": "y"}) == "y"
    assert places._change({"updated": "u", "created": "c"}) == "u"


def test_what_is_wrong_with_a_place_is_said_once() -> None:
    """As the system says it, with the store's file before it; an error of plantar's own as it is."""
    store = Store("s3://b/fleet")
    denied = OSError(13, "Permission denied", "/x")
    assert str(store._unusable("cannot be read", "a.json", denied)) == (
        "s3://b/fleet/a.json: cannot be read: Permission denied"
    )
    own = PlantarError("needs a package", path="s3://b")
    assert str(store._unusable("cannot be read", "a.json", own)) == "s3://b: needs a package"
    assert str(places._unreadable("a.csv", denied)) == "a.csv: cannot be read: Permission denied"
    assert (
        str(places._unreadable("a.csv", FileNotFoundError(2, "No such file", "/x")))
        == "a.csv: does not exist"
    )
    assert places._unreadable("a.csv", own) is own
    with pytest.raises(PlantarError, match=r"^none\.csv: does not exist$"):
        brought("none.csv", Path("x"))
    with pytest.raises(PlantarError, match=r"^none\.csv: does not exist$"):
        time_of("none.csv")
    with pytest.raises(PlantarError, match=r"^memory://none/x\.csv: does not exist$"):
        stamp_of("memory://none/x.csv")
    with pytest.raises(PlantarError, match=r"^nope://b/x: cannot be read: Protocol not known: nope$"):
        stamp_of("nope://b/x")


def test_a_files_time_is_in_whole_seconds_of_utc_and_its_stamp_in_nanoseconds(tmp_path: Path) -> None:
    log = tmp_path / "a.csv"
    log.write_bytes(b"12345")
    os.utime(log, ns=(0, 1_234_567_891_500_000_000))
    assert time_of(str(log)) == datetime(2009, 2, 13, 23, 31, 31, tzinfo=UTC)
    assert stamp_of(str(log)) == places.Stamp(5, "1234567891500000000")


def test_a_folder_of_a_store_is_brought_with_all_that_is_in_it(tmp_path: Path) -> None:
    system = fsspec.filesystem("memory")
    system.pipe_file("/bags/one/part.db3", b"1")
    system.pipe_file("/bags/one/inner/metadata.yaml", b"2")
    found = brought("memory://bags/one", tmp_path)
    assert found == tmp_path / "one"
    assert (found / "part.db3").read_bytes() + (found / "inner" / "metadata.yaml").read_bytes() == b"12"
