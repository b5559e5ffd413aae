"""Kept plans and rollouts: the same when nothing changed, gone when anything did."""

from __future__ import annotations

import ast
import hashlib
import os
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from threading import Barrier
from time import sleep

import numpy as np
import pytest

from plantar.errors import MotionError
from plantar.motions import Postures
from plantar.twin import Bush, cache
from plantar.twin.keep import plan_arrays, plan_from, plan_key, rollout_arrays, rollout_from, rollout_key
from plantar.twin.play import roll_all, roll_each, rolled
from plantar.twin.robots import hrp2
from plantar.twin.simulation.physics import Physics, Slip
from plantar.twin.simulation.rollout import Rollout
from twin_samples import plan, short, tilted


@pytest.fixture(autouse=True)
def own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("PLANTAR_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def test_plans_come_back_whole() -> None:
    for motion in ("Tilt3", "Manual_right_roll"):
        first = plan(motion)
        key = cache.key("x", motion)
        cache.save(key, plan_arrays(first))
        again = plan_from(motion, cache.load(key))
        assert plan_arrays(again).keys() == plan_arrays(first).keys()
        for name, values in plan_arrays(first).items():
            assert np.array_equal(plan_arrays(again)[name], values)
        assert (again.hand is None) == (first.hand is None)


def test_rollouts_come_back_whole() -> None:
    kept = rollout_arrays(tilted())
    cache.save("rollout", kept)
    again = rollout_arrays(rollout_from("Tilt3", cache.load("rollout")))
    assert all(np.array_equal(again[name], values) for name, values in kept.items())


def test_any_change_is_another_key() -> None:
    base, physics = plan("Tilt3"), Physics()
    moved = replace(base, positions=base.positions + 1e-12)
    keys = {
        rollout_key(base, physics, "<mujoco/>"),
        rollout_key(moved, physics, "<mujoco/>"),
        rollout_key(base, physics, "<mujoco />"),
        rollout_key(base, replace(physics, slips=(Slip(1.0, 2.0, 0.1),)), "<mujoco/>"),
        rollout_key(base, replace(physics, bushes={"left": Bush(1, 1, 1, 1), "right": Bush(1, 1, 1, 1)}), ""),
        plan_key("Tilt3", hrp2.robot(), hrp2.postures(), {}),
        plan_key("Tilt3", hrp2.robot(), Postures(), {}),
        plan_key("Tilt3", hrp2.robot(), hrp2.postures(), {"sway": 0.03}),
    }
    assert len(keys) == 8
    assert rollout_key(base, physics, "") == rollout_key(replace(base), Physics(), "")


def test_a_sensor_moved_by_less_than_numpy_prints_is_another_key() -> None:
    robot = hrp2.robot()
    assert robot.imu is not None
    place = robot.imu.placement
    moved = replace(robot, imu=replace(robot.imu, placement=replace(place, xyz=place.xyz * (1 + 1e-12))))
    keys = {plan_key("Tilt3", each, hrp2.postures(), {}) for each in (robot, moved)}
    assert len(keys) == 2


def test_every_package_that_plans_or_steps_is_in_the_key() -> None:
    """Solvers too: another version plans another motion. Those that only write files change no number."""
    source = Path(cache.__file__).parents[1]
    imported = set()
    for file in (*(source / "motions").rglob("*.py"), *(source / "twin").rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Import | ast.ImportFrom):
                names = (
                    [alias.name for alias in node.names] if isinstance(node, ast.Import) else [node.module]
                )
                imported |= {str(name).split(".")[0] for name in names}
            if isinstance(node, ast.keyword) and node.arg == "solver":
                imported.add(ast.literal_eval(node.value))
    named = {"pinocchio": "pin", "pink": "pin-pink"}
    foreign = imported - set(sys.stdlib_module_names) - {"plantar", "pyarrow", "yaml"}
    assert {named.get(name, name) for name in foreign} | {"qpsolvers"} == set(cache.PACKAGES)


def test_changed_source_is_another_key(monkeypatch: pytest.MonkeyPatch) -> None:
    before = cache.key("x")
    monkeypatch.setattr(cache, "_code", lambda: "another version of the twin")
    assert cache.key("x") != before


def test_other_native_steps_are_another_key(monkeypatch: pytest.MonkeyPatch) -> None:
    names = ("src/stepping.hpp", "python/bindings_stepping.cpp")
    sources = [Path(__file__).parents[2] / "cpp" / name for name in names]
    hashes = [hashlib.sha256(source.read_bytes()).hexdigest() for source in sources]
    assert "".join(hashes) == cache.STEPPING_SOURCE  # as built
    cache._code.cache_clear()
    before = cache.key("x")
    monkeypatch.setattr(cache, "STEPPING_SOURCE", "other steps")
    cache._code.cache_clear()
    after = cache.key("x")
    cache._code.cache_clear()
    assert after != before


@pytest.mark.parametrize("part", ["FILES", "PACKAGES", "version"])
def test_other_files_or_packages_are_another_key(part: str, monkeypatch: pytest.MonkeyPatch) -> None:
    cache._code.cache_clear()
    before = cache.key("x")
    monkeypatch.setattr(
        cache, part, (lambda package: "0.0") if part == "version" else getattr(cache, part)[1:]
    )
    cache._code.cache_clear()
    after = cache.key("x")
    cache._code.cache_clear()
    assert after != before


def test_a_damaged_file_counts_as_none(own_folder: Path) -> None:
    cache.save("k", {"a": np.arange(5.0)})
    file = own_folder / "k.npz"
    content = file.read_bytes()
    for damage in (b"", content[: len(content) // 2], b"not a zip", content.replace(b"NUMPY", b"NUMPX")):
        file.write_bytes(damage)
        assert cache.load("k") is None


def test_pickles_are_never_loaded(own_folder: Path) -> None:
    own_folder.mkdir()
    np.savez(own_folder / "k.npz", a=np.array([{"evil": True}], dtype=object))
    assert cache.load("k") is None


def test_a_folder_that_cannot_be_written_is_no_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv("PLANTAR_CACHE", str(tmp_path / "file" / "below"))
    cache.save("k", {"a": np.arange(5.0)})
    assert cache.load("k") is None


def test_the_oldest_go_first(own_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache, "LIMIT", 25_000)
    for place, name in enumerate(("old", "older", "new")):
        cache.save(name, {"a": np.zeros(1250)})  # about 10 kB each
        os.utime(own_folder / f"{name}.npz", (1000 - place, 1000 - place) if name != "new" else None)
    cache.save("newest", {"a": np.zeros(1250)})
    assert sorted(file.stem for file in own_folder.glob("*.npz")) == ["new", "newest"]


def test_a_second_rollout_does_not_step(monkeypatch: pytest.MonkeyPatch) -> None:
    played, physics = short(plan("Tilt3"), 2.0, 2.3), Physics(settle=0.1)
    first = rolled(played, hrp2.robot(), physics)

    def forbidden(*_: object) -> None:
        raise AssertionError("stepped again")

    monkeypatch.setattr(sys.modules["plantar.twin.play"], "roll_out", forbidden)
    again = rolled(played, hrp2.robot(), physics)
    assert np.array_equal(first.efforts, again.efforts)
    with pytest.raises(AssertionError, match="stepped again"):
        rolled(played, hrp2.robot(), Physics(settle=0.15))


def test_what_two_ask_for_at_once_is_made_once(own_folder: Path) -> None:
    """By one of them; after an error by the next. No lock stays behind."""
    both, asked = Barrier(2), list[int]()

    def made() -> dict[str, np.ndarray]:
        asked.append(1)
        sleep(0.05)
        if len(asked) == 1:
            raise MotionError("it falls")
        return {"a": np.arange(3.0)}

    def ask(_: int) -> bool:
        both.wait()
        try:
            return bool(np.array_equal(cache.kept("k", made)["a"], np.arange(3.0)))
        except MotionError:
            return False

    with ThreadPoolExecutor(2) as pool:
        assert sorted(pool.map(ask, range(2))) == [False, True]
        assert list(pool.map(ask, range(2))) == [True, True]
    assert len(asked) == 2
    assert [file.name for file in own_folder.iterdir()] == ["k.npz"]
    (own_folder / "k.npz").unlink()
    with ThreadPoolExecutor(2) as pool:
        assert list(pool.map(ask, range(2))) == [True, True]
    assert len(asked) == 3


def test_one_fall_stops_the_others() -> None:
    soft = Bush(40.0, 2.0, 40.0, 2.0)
    jobs = [
        (short(plan("Tilt3"), 2.0, 6.0), Physics({"left": soft, "right": soft})),
        (short(plan("Tilt3"), 2.0, 40.0), Physics()),
    ]
    seen: list[float] = []
    with pytest.raises(
        MotionError,
        match=r"^t = 0 s: Tilt3: the robot falls, it leans 172° away from its plan \(valid: a smaller "
        r"or slower motion\)$",
    ):
        roll_all(jobs, hrp2.robot(), lambda motion, share: seen.append(share))
    assert max(seen, default=0.0) < 0.9


def test_a_fall_stands_in_its_rollouts_place() -> None:
    soft = Bush(40.0, 2.0, 40.0, 2.0)
    jobs = [
        (short(plan("Tilt3"), 2.0, 6.0), Physics({"left": soft, "right": soft})),
        (short(plan("Tilt3"), 2.0, 2.5), Physics(settle=0.1)),
    ]
    done: set[float] = set()
    fallen, stood = roll_each(jobs, hrp2.robot(), lambda motion, share: done.add(share))
    assert isinstance(fallen, MotionError)
    assert isinstance(stood, Rollout)
    assert stood.time.size == 100
    assert 1.0 in done


@pytest.mark.parametrize(
    ("platform", "set_to", "under"),
    [
        ("linux", {}, "home/.cache/plantar"),
        ("linux", {"XDG_CACHE_HOME": "xdg"}, "xdg/plantar"),
        ("linux", {"XDG_CACHE_HOME": ""}, "home/.cache/plantar"),
        ("linux", {"LOCALAPPDATA": "local"}, "home/.cache/plantar"),
        ("darwin", {"XDG_CACHE_HOME": "xdg"}, "home/Library/Caches/plantar"),
        ("win32", {"LOCALAPPDATA": "local"}, "local/plantar/cache"),
        ("win32", {}, "home/plantar/cache"),
        ("win32", {"PLANTAR_CACHE": "chosen"}, "chosen"),
    ],
)
def test_each_platform_has_a_place_for_caches(
    platform: str, set_to: dict[str, str], under: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("PLANTAR_CACHE", "XDG_CACHE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(name, raising=False)
    for name, value in set_to.items():
        monkeypatch.setenv(name, value and str(tmp_path / value))
    monkeypatch.setattr(cache.sys, "platform", platform)
    monkeypatch.setattr(Path, "home", lambda: tmp_path / "home")
    assert cache.folder() == tmp_path / under
