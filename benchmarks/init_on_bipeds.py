"""`plantar init` on bipeds of example-robot-data: how far its guesses are off, and what becomes of the numbers.

    python benchmarks/init_on_bipeds.py
    python benchmarks/init_on_bipeds.py --robots g1 icub

Each twin is built as the URDF alone cannot tell (`biped_twins.py`); its logs are written as a user has them, `init`
writes the robot file from URDF and logs, and `identify feet` takes that file as it is. A number is wrong where it is
off by more than 2 % (stiffness) or 10 % (damping) and its 95 % interval misses the truth; SILENT WRONG where it is
called usable then. Behind a guess stands by how much its mark says that it may be off [mm].
"""

from __future__ import annotations

import argparse
import contextlib
import os
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from biped_twins import HRP2, URDFS, bushes_of, known_robot, placed, recorded, urdf_of
from fault_scoring import OFF
from plantar.cli.init import run as init
from plantar.errors import PlantarError
from plantar.feet.identify import identify_feet
from plantar.logs.readers import open_log
from plantar.results.feet import FeetResult, Parameter
from plantar.robot.model import RobotModel, load_robot
from plantar.twin.bush import Feet

DEFAULT_FOLDER = Path(tempfile.gettempdir()) / "plantar_bipeds"
SEED = 0


def tried(name: str, folder: Path) -> Iterator[str]:
    """The lines of one robot's row."""
    folder.mkdir(parents=True, exist_ok=True)
    try:
        urdf = urdf_of(name, folder)
        known = known_robot(name, urdf, folder)
        bushes = bushes_of(name, known)
        logs, refused = recorded(known, bushes, folder, SEED)
    except PlantarError as error:
        yield f"no twin: {error}"
        return
    yield from (f"not played: {reason}" for reason in refused)
    if not logs:
        return
    start = time.perf_counter()
    file = folder / "robot.yaml"
    try:
        with contextlib.redirect_stdout(None):
            init(urdf, logs, out=file, force=True)
        robot = load_robot(file)
    except PlantarError as error:
        yield f"init refuses: {error}"
        return
    yield f"{len(logs)} logs; init took {time.perf_counter() - start:.1f} s"
    yield from guesses(robot, known)
    yield from (line[2:] for line in file.read_text().splitlines() if line.startswith("# DOUBT"))
    try:
        result = identify_feet(robot, [open_log(path, robot) for path in logs])
    except PlantarError as error:
        yield f"identify refuses: {error}"
        return
    yield from numbers(result, bushes)
    warnings = sorted({note.code for note in result.notes if note.severity == "warning"})
    yield f"model {result.model}; warnings: {', '.join(warnings)}"


def guesses(robot: RobotModel, known: RobotModel) -> Iterator[str]:
    """How far each part of init's file is from the truth."""
    assert robot.imu is not None
    assert known.imu is not None
    spread = {guess.key: guess.spread for guess in robot.guesses}

    def within(key: str) -> str:
        if key not in spread:
            return "(no guess)"
        size = spread[key]
        return "(GUESS)" if size is None else f"(± {1e3 * size:.0f})"

    place, axes = placed(robot, "imu")
    truth, true_axes = placed(known, "imu")
    same = robot.frame(robot.imu.placement)[0] == known.frame(known.imu.placement)[0]
    where = f"{1e3 * np.linalg.norm(place - truth):.0f} mm" if same else f"on {robot.imu.placement.link}"
    yield f"imu {where} {within('imu')}, {angle(axes, true_axes):.1f} deg"
    for side in robot.feet:
        parts = []
        for part in ("bush", "wrench", "sole"):
            place, axes = placed(robot, part, side)
            truth, true_axes = placed(known, part, side)
            up = placed(known, "sole", side)[1]
            x, y, z = 1e3 * up.T @ (place - truth)
            turn = f", {angle(axes, true_axes):.1f} deg" if part == "wrench" else ""
            parts.append(f"{part} {x:+.0f} {y:+.0f} {z:+.0f} mm{turn} {within(f'feet.{side}.{part}')}")
        own, other = (np.ptp(one.feet[side].sole.polygon, axis=0) for one in (robot, known))
        length, width = 1e3 * (own - other)
        yield f"{side}: {'; '.join(parts)}; outline {length:+.0f} x {width:+.0f} mm of {1e3 * other[0]:.0f}"


def angle(one: np.ndarray, other: np.ndarray) -> float:
    """Between two rotations [deg]; a mirrored one is 180 off."""
    turn = one @ other.T
    if np.linalg.det(turn) < 0:
        return 180.0
    return float(np.degrees(np.arccos(np.clip((np.trace(turn) - 1) / 2, -1, 1))))


def numbers(result: FeetResult, bushes: Feet) -> Iterator[str]:
    """Errors and verdicts of stiffness and damping, foot by foot."""
    for side in bushes:
        parts = []
        for row in result.parameters:
            if row.foot == side and row.axis != "z" and row.name in OFF:
                parts.append(told(row, float(getattr(bushes[side], f"{row.axis}_{row.name}"))))
        yield f"{side}: {'; '.join(parts)}"


def told(row: Parameter, truth: float) -> str:
    """One number: `pitch K +0.4 ± 1.2 % usable`."""
    name = f"{row.axis} {'K' if row.name == 'stiffness' else 'C'}"
    if row.value is None:
        return f"{name} {row.verdict}"
    error = row.value / truth - 1
    low, high = row.interval95 or (row.value, row.value)
    wrong = abs(error) > OFF[row.name] and not low <= truth <= high
    mark = " SILENT WRONG" if wrong and row.verdict == "usable" else " OUT" if wrong else ""
    return f"{name} {100 * error:+.1f} ± {50 * (high - low) / truth:.1f} % {row.verdict}{mark}"


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    robots = (*URDFS, HRP2)
    parser.add_argument("--robots", nargs="+", default=robots, choices=robots)
    parser.add_argument(
        "--out", type=Path, default=DEFAULT_FOLDER, help="where logs and robot files are kept"
    )
    chosen = parser.parse_args()
    silent = 0
    for name in chosen.robots:
        start = time.perf_counter()
        for line in tried(name, chosen.out / name):
            silent += line.count("SILENT WRONG")
            print(f"{name:16} {line}", flush=True)
        print(f"{name:16} {time.perf_counter() - start:.0f} s", flush=True)
    print(f"silent wrong: {silent}")


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main()
