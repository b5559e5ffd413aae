"""The C++ library as its users get it: built without Python, installed, found from outside, its ticks counted."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import example_robots
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
    """A folder with `build` and `prefix`; the kernels of one instruction set alone, which takes a third of the time."""
    folder = tmp_path_factory.mktemp("library")
    chosen = ("PLANTAR_TESTS=ON", "PLANTAR_INSTRUCTION_SETS=OFF", "PLANTAR_WARNINGS_AS_ERRORS=ON")
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


def test_a_controller_outside_the_tree_finds_it(built: Path, talos_model: Path) -> None:
    run("cmake", "-S", CONTROLLER, "-B", "outside", f"-DCMAKE_PREFIX_PATH={built / 'prefix'}", where=built)
    run("cmake", "--build", "outside", where=built)
    said = run(built / "outside" / "controller", talos_model, where=built)
    assert (
        said.splitlines()[-1] == "right: contact 2, load 442.6 N, pitch 0.0000 rad, stiffness not known yet"
    )


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
