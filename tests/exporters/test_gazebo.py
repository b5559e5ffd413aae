"""The SDFormat export by Gazebo's own parts: sdformat's parser and ignition-physics with DART, its default engine."""

from __future__ import annotations

import os
import subprocess
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

from export_robots import TRUTH, bush_rotation, result, write_sdf, write_urdf
from plantar.exporters import export
from pushed_foot import DIRECTION, LOAD, deflection, measured

PLUGIN = "libignition-physics5-dartsim-plugin.so.5"
SETTLE, FREE, STEP = 0.6, 0.5, 1e-3  # s


@pytest.fixture(scope="session")
def gazebo(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """The program that pushes, compiled, and the folder of Gazebo's libraries."""
    prefix = os.environ.get("PLANTAR_GAZEBO_PREFIX")
    found = sorted(Path(prefix).glob("lib/**/libignition-physics5.so.5")) if prefix else []
    if prefix is None or not found:
        pytest.skip("no Gazebo: name the prefix of ignition-physics 5 and sdformat 12 (Debian: /usr) in "
                    "PLANTAR_GAZEBO_PREFIX")  # fmt: skip
    libraries, headers = found[0].parent, Path(prefix) / "include"
    program = tmp_path_factory.mktemp("gazebo") / "push"
    include = [
        f"-I{path}" for path in (*headers.glob("ignition/*"), *headers.glob("sdformat*"), headers / "eigen3")
    ]
    link = [
        "sdformat12",
        "ignition-physics5",
        "ignition-plugin1-loader",
        "ignition-plugin1",
        "ignition-math6",
    ]
    subprocess.run(
        ["c++", "-std=c++17", "-w", "-o", program, Path(__file__).with_name("gazebo_push.cpp"), *include,
         f"-I{headers}", f"-L{libraries}", *(f"-l{name}" for name in link), f"-Wl,-rpath-link,{libraries}"],
        check=True,
    )  # fmt: skip
    return program, libraries


def in_a_world(path: Path) -> None:
    """The model held at its pelvis, in a world without gravity."""
    root = ET.parse(path).getroot()
    model = root.find("model")
    assert model is not None
    root.remove(model)
    world = ET.SubElement(root, "world", name="pushed")
    ET.SubElement(world, "gravity").text = "0 0 0"
    world.append(model)
    held = ET.SubElement(model, "joint", name="held", type="fixed")
    ET.SubElement(held, "parent").text = "world"
    ET.SubElement(held, "child").text = "pelvis"
    ET.ElementTree(root).write(path)


@pytest.mark.parametrize("source", ["1.9", "urdf"])
def test_gazebo_gives_stiffness_and_damping_back(
    source: str, tmp_path: Path, gazebo: tuple[Path, Path]
) -> None:
    program, libraries = gazebo
    urdf = write_urdf(tmp_path / "rigid.urdf", rigid_legs=True)
    model = urdf if source == "urdf" else write_sdf(tmp_path / "robot.sdf", source)
    out = tmp_path / "out.sdf"
    export(result(urdf), "sdf", out, model=model)
    in_a_world(out)
    for foot, axes in TRUTH.items():
        for axis in axes:
            push = LOAD[axis] * bush_rotation(foot)[:, DIRECTION[axis]]
            kind = "force" if axis == "z" else "torque"
            steps = [round(time / STEP) for time in (SETTLE, FREE)]
            arguments = [
                out,
                libraries / PLUGIN,
                STEP,
                *steps,
                f"{foot}_ankle",
                f"{foot}_bush_sole",
                kind,
                *push,
            ]
            done = subprocess.run(
                [program, *map(str, arguments)], capture_output=True, text=True, timeout=100,
                env=os.environ | {"LD_LIBRARY_PATH": str(libraries)},
            )  # fmt: skip
            assert done.returncode == 0, done.stderr[-2000:]
            poses = np.array([line.split() for line in done.stdout.splitlines()], float)
            bends = np.array([deflection(axis, bush_rotation(foot), row[:7], row[7:]) for row in poses])
            k, c = measured(LOAD[axis], bends[1:] - bends[0], STEP)
            assert k == pytest.approx(TRUTH[foot][axis][0], rel=0.01)
            # DART springs and damps implicitly, which adds K·step/2 to C.
            assert c - k * STEP / 2 == pytest.approx(TRUTH[foot][axis][1], rel=0.03)
