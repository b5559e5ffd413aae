"""The C++ library as its users get it: built without Python, installed, found from outside, its ticks counted."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import example_robots
from biped import record, sway
from biped_robot import make_robot
from plantar.online.estimator import FootEstimator
from plantar.online.replay import Replay

ROOT = Path(__file__).resolve().parents[2]
CONTROLLER = ROOT / "examples" / "controller"
MESSAGES = ROOT / "examples" / "ros_messages"
TICKS = 70_000  # a minute's standing and walking, and standing again

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
    """A folder with `build` and `prefix`; the kernels of one instruction set alone, hardly optimised, and the library's
    files compiled as one, for they share their headers: that takes a fifth of the time."""
    folder = tmp_path_factory.mktemp("library")
    chosen = ("PLANTAR_TESTS=ON", "PLANTAR_INSTRUCTION_SETS=OFF", "PLANTAR_WARNINGS_AS_ERRORS=ON")
    chosen += ("CMAKE_CXX_FLAGS_RELEASE=-O1", "CMAKE_UNITY_BUILD=ON", "CMAKE_UNITY_BUILD_BATCH_SIZE=0")
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


@dataclass(frozen=True)
class Ticks:
    """A log as a file of ticks, the estimator's model file, and what Python says at the log's end."""

    model: Path
    ticks: Path
    replay: Replay


@pytest.fixture(scope="module")
def ticks(tmp_path_factory: pytest.TempPathFactory) -> Ticks:
    """As docs/tutorials/controller.md does it."""
    folder = tmp_path_factory.mktemp("ticks")
    robot, log = make_robot(folder), record(sway("sway", 1, duration=20.0))
    estimator = FootEstimator(robot, wrench_delay=0.0)
    model = estimator.write_model(folder / "robot.estimator")
    assert robot.imu is not None
    columns = (log.positions(robot), log.orientation(robot.imu.name), log.angular_velocity(robot.imu.name))
    wrenches = [log.wrench(foot.wrench.name) for foot in robot.feet.values()]
    np.savetxt(folder / "ticks.txt", np.column_stack([log.time, *columns, *wrenches]), fmt="%.17g")
    return Ticks(model, folder / "ticks.txt", estimator.replay(log))


def test_ticks_of_a_log_give_the_numbers_that_python_gives(outside: Path, ticks: Ticks) -> None:
    said = run(outside / "replay", ticks.model, ticks.ticks, where=outside).splitlines()
    expected = []
    for foot in ticks.replay.feet:
        last = ticks.replay.estimate(foot)
        for axis, now in (("pitch", last.pitch), ("roll", last.roll)):
            known = "identified" if now.identified else "not known yet"
            stiffness = f"{now.stiffness.value:.3f} ± {now.stiffness.half_width:.3f} N·m/rad"
            expected.append(f"{foot} {axis}: {1e3 * now.deflection:.2f} mrad, K {stiffness}, {known}")
    assert said == expected
    assert "identified" in said[0]


@pytest.mark.skipif(
    shutil.which("pkg-config") is None
    or subprocess.run(["pkg-config", "--exists", "sensor_msgs", "geometry_msgs"], check=False).returncode
    != 0,
    reason="needs the C++ headers of ROS 1's sensor_msgs (on Debian libsensor-msgs-dev)",
)
def test_ros_messages_give_the_numbers_that_their_ticks_give(
    built: Path, outside: Path, ticks: Ticks
) -> None:
    """Stamps of messages are whole nanoseconds: the last digits may differ."""
    run("cmake", "-S", MESSAGES, "-B", "messages", f"-DCMAKE_PREFIX_PATH={built / 'prefix'}", where=built)
    run("cmake", "--build", "messages", where=built)
    said, wanted = (
        run(program, ticks.model, ticks.ticks, where=built)
        for program in (built / "messages" / "feet_of_messages", outside / "replay")
    )
    number = r"-?\d+\.\d+"
    assert re.sub(number, "", said) == re.sub(number, "", wanted)
    found, expected = (np.array(re.findall(number, text), float) for text in (said, wanted))
    np.testing.assert_allclose(found, expected, rtol=1e-5, atol=2e-3)


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
