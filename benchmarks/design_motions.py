"""Motions that `plantar design` makes, played on feet that are not as told: what is promised and what comes of it.

    python benchmarks/design_motions.py --robots hrp2,talos,g1,icub --factors 0.6,1.7 --seeds 3 --out DIR

Everything goes through files and the command line, as a user does it. One line for each robot, factor and parameter:
the error and half width [%], what was promised at the nearest rehearsal, and the samples that slip, roll or tip.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

import biped_twins
import talos
from plantar.robot.model import RobotModel, load_robot
from plantar.twin.robots import hrp2

TOLD = {"hrp2": 500.0, "talos": 900.0, "g1": 300.0, "icub": 150.0}  # N·m/rad
DAMPED = 0.04  # s: damping over stiffness, as `plantar design` takes it


def robot_file(name: str, folder: Path) -> RobotModel:
    """A robot's file in a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    if name == "hrp2":
        return load_robot(hrp2.write(folder))
    if name == "talos":
        return talos.robot(folder)
    return biped_twins.known_robot(name, biped_twins.urdf_of(name, folder), folder)


def plantar(*arguments: object) -> float:
    """Run a command; the seconds it took."""
    begin = time.monotonic()
    command = [sys.executable, "-m", "plantar", *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr.strip().splitlines()[-1])
    return time.monotonic() - begin


def played(
    robot: RobotModel, motion: Path, told: float, factor: float, preset: str, seed: int
) -> dict[str, object]:
    """The result of a motion on feet of another stiffness."""
    k, c = factor * told, factor * DAMPED * told
    folder = motion.parent / f"{preset}_{factor:g}_{seed}"
    bush = f"{k},{c},{k},{c}"
    plantar(
        "simulate",
        motion,
        "--robot",
        robot.path,
        "--bush",
        bush,
        "--preset",
        preset,
        "--seed",
        seed,
        "--out",
        folder,
        "-q",
    )
    plantar(
        "identify", "feet", folder / "robot.yaml", folder / f"{motion.stem}.parquet", "--out", folder, "-q"
    )
    return dict(json.loads((folder / "result.json").read_text()))


def rows(
    result: dict[str, object], promised: dict[str, object], told: float, factor: float
) -> Iterator[tuple[str, float, float, float]]:
    """Parameter, its error and half width, and the promised half width [%]."""
    for row in result["parameters"]:  # type: ignore[attr-defined]
        if row["axis"] == "z" or row["name"] not in ("stiffness", "damping"):
            continue
        truth = factor * told * (1.0 if row["name"] == "stiffness" else DAMPED)
        if row["value"] is None:
            yield f"{row['foot']} {row['axis']} {row['name']}", np.nan, np.nan, np.nan
            continue
        promise = next(
            one for one in promised["parameters"]  # type: ignore[attr-defined]
            if (one["foot"], one["axis"], one["name"]) == (row["foot"], row["axis"], row["name"])
        )  # fmt: skip
        known = [
            (one["factor"], one["half_width_percent"]) for one in promise["at"] if one["half_width_percent"]
        ]
        at = np.exp(np.interp(np.log(factor), np.log([f for f, _ in known]), np.log([w for _, w in known])))
        half = 50 * (row["interval95"][1] - row["interval95"][0]) / abs(row["value"])
        yield f"{row['foot']} {row['axis']} {row['name']}", 100 * (row["value"] / truth - 1), half, float(at)


def lost(result: dict[str, object]) -> str:
    """Seconds of the feet that were left out, by reason."""
    seconds: dict[str, float] = {}
    for phase in result["phases"]:  # type: ignore[attr-defined]
        if not phase["used"] and phase["end"] - phase["start"] > 0.01 and phase["reason"] != "filter's edge":
            seconds[phase["reason"]] = seconds.get(phase["reason"], 0.0) + phase["end"] - phase["start"]
    return ", ".join(f"{reason} {value:.2f} s" for reason, value in seconds.items()) or "nothing"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robots", default=",".join(TOLD))
    parser.add_argument("--factors", default="0.6,1.7")
    parser.add_argument("--preset", default="realistic")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--out", type=Path, required=True)
    given = parser.parse_args()
    for name in given.robots.split(","):
        robot, motion = robot_file(name, given.out / name), given.out / name / "motion.csv"
        seconds = plantar("design", robot.path, "--stiffness", TOLD[name], "--out", motion, "-q")
        promised = json.loads(motion.with_suffix(".json").read_text())
        print(f"{name}: designed for {TOLD[name]:g} N·m/rad in {seconds:.0f} s", flush=True)
        for factor in map(float, given.factors.split(",")):
            for seed in range(given.seeds):
                try:
                    result = played(robot, motion, TOLD[name], factor, given.preset, seed)
                except RuntimeError as error:
                    print(f"  x{factor:g} seed {seed}: {error}", flush=True)
                    continue
                print(f"  x{factor:g} seed {seed}, left out: {lost(result)}", flush=True)
                for parameter, error, half, promise in rows(result, promised, TOLD[name], factor):
                    held = "holds" if abs(error) <= half else "MISSES"
                    ratio = half / promise
                    print(f"    {parameter:24s} {error:+7.2f} %  ±{half:6.2f} %  promised ±{promise:6.2f} %  "
                          f"x{ratio:.2f}  {held}", flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
