"""The C++ library as its users get it: built without Python, installed, found from outside, its ticks counted."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import example_robots
from biped import record, sway
from biped_robot import make_robot
from plantar.online.estimator import FootEstimator

ROOT = Path(__file__).resolve().parents[2]
CONTROLLER = ROOT / "examples" / "controller"
TICKS = 200_000

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        shutil.which("cmake") is None or shutil.which("c++") is None, reason="needs CMake and a C++ compiler"
    ),
]


def run(*words: object, where: Path, **environment: str) -> str:
    done = subprocess.run(
        [str(word) for word in words],
        cwd=where,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with `build` and `prefix`; the kernels of one instruction set alone, and hardly optimised test programs:
    that takes a quarter of the time."""
    folder = tmp_path_factory.mktemp("library")
    chosen = ("PLANTAR_TESTS=ON", "PLANTAR_INSTRUCTION_SETS=OFF", "PLANTAR_WARNINGS_AS_ERRORS=ON")
    chosen += ("CMAKE_CXX_FLAGS_RELEASE=-O1",)
    run("cmake", "-S", ROOT, "-B", "build", *(f"-D{one}" for one in chosen), where=folder)
    run("cmake", "--build", "build", where=folder)
    run("cmake", "--install", "build", "--prefix", folder / "prefix", where=folder)
    return folder


@pytest.fixture(scope="module")
def talos_model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("talos")
    return FootEstimator(example_robots.talos_file(folder)).write_model(folder / "talos.estimator")


def test_its_own_tests_pass(built: Path) -> None:
    run("ctest", "--output-on-failure", where=built / "build")


@pytest.fixture(scope="module")
def outside(built: Path) -> Path:
    """The programs of a project outside of the tree."""
    run("cmake", "-S", CONTROLLER, "-B", "outside", f"-DCMAKE_PREFIX_PATH={built / 'prefix'}", where=built)
    run("cmake", "--build", "outside", where=built)
    return built / "outside"


def test_a_controller_outside_the_tree_finds_it(outside: Path, talos_model: Path) -> None:
    said = run(outside / "controller", talos_model, where=outside)
    assert (
        said.splitlines()[-1] == "right: contact 2, load 442.6 N, pitch 0.0000 rad, stiffness not known yet"
    )


def test_ticks_of_a_log_give_the_numbers_that_python_gives(outside: Path, tmp_path: Path) -> None:
    """As docs/tutorials/controller.md does it: a model file, a file of ticks, and the last estimates of both."""
    robot, log = make_robot(tmp_path), record(sway("sway", 1, duration=20.0))
    estimator = FootEstimator(robot, wrench_delay=0.0)
    model = estimator.write_model(tmp_path / "robot.estimator")
    assert robot.imu is not None
    columns = (log.positions(robot), log.orientation(robot.imu.name), log.angular_velocity(robot.imu.name))
    wrenches = [log.wrench(foot.wrench.name) for foot in robot.feet.values()]
    np.savetxt(tmp_path / "ticks.txt", np.column_stack([log.time, *columns, *wrenches]), fmt="%.17g")
    said = run(outside / "replay", model, tmp_path / "ticks.txt", where=outside).splitlines()
    replay = estimator.replay(log)
    expected = []
    for foot in robot.feet:
        last = replay.estimate(foot)
        for axis, now in (("pitch", last.pitch), ("roll", last.roll)):
            known = "identified" if now.identified else "not known yet"
            stiffness = f"{now.stiffness.value:.3f} ± {now.stiffness.half_width:.3f} N·m/rad"
            expected.append(f"{foot} {axis}: {1e3 * now.deflection:.2f} mrad, K {stiffness}, {known}")
    assert said == expected
    assert "identified" in said[0]


@pytest.mark.skipif(shutil.which("pkg-config") is None, reason="needs pkg-config")
def test_pkg_config_finds_it(built: Path, talos_model: Path) -> None:
    (package,) = built.glob("prefix/lib*/**/pkgconfig")
    flags = run(
        "pkg-config", "--cflags", "--libs", "plantar", where=built, PKG_CONFIG_PATH=str(package)
    ).split()
    run("c++", "-std=c++20", CONTROLLER / "controller.cpp", "-o", "by_pkg_config", *flags, where=built)
    assert "left: contact 2" in run(built / "by_pkg_config", talos_model, where=built)


def test_no_header_of_python_or_of_the_kernels_is_installed(built: Path) -> None:
    headers = {path.name for path in (built / "prefix" / "include" / "plantar").iterdir()}
    assert headers == {"estimator_model.hpp", "foot_estimator.hpp", "frame.hpp"}


def test_a_tick_takes_no_memory(built: Path, talos_model: Path) -> None:
    found = json.loads(run(built / "build/cpp/tests/estimator_ticks", talos_model, TICKS, where=built))
    assert found["allocations"] == 0


@pytest.mark.skipif(sys.platform != "linux", reason="seccomp is Linux's")
def test_a_tick_asks_nothing_of_the_system(built: Path, talos_model: Path) -> None:
    run(built / "build/cpp/tests/estimator_ticks", talos_model, TICKS, "strict", where=built)
