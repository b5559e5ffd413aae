"""Motions that `plantar design` makes, played on feet that are not as told: what is promised and what comes of it.

    python benchmarks/design_motions.py --robots hrp2,talos,g1,icub --factors 0.6,1.7 --seeds 20 --out DIR
    python benchmarks/design_motions.py --robots g1 --factors 0.6 --second --out DIR
    python benchmarks/design_motions.py --robots hrp2 --paper --seeds 1 --out DIR
    python benchmarks/design_motions.py --summary --out DIR

Everything goes through files and the command line, as a user does it. Each seed draws the sensors anew; the rollout is
the same. A motion that lies in DIR already is played again. Every number goes into DIR/rows.jsonl; the summary has a
line for each robot, factor and kind of number: its errors and half widths [% of the value, ms for the delay], how many
are within the BARS, how many intervals hold the truth, how many numbers are called usable and are not held by their
intervals, and the half widths beside those promised at the nearest rehearsals.

`--second` designs the next motion from the first seed's result on each feet (`--after`), and plays that instead.

`--exact` says in the robot file that nothing in it is wrong, as on the twin: else intervals allow for 1 % of the force
sensors' gains and more. `--paper` records the paper's composed motion (188 s, an operator pushes) on the same feet, for
its half widths.
"""

from __future__ import annotations

import argparse
import io
import json
import os
from collections import Counter, defaultdict
from collections.abc import Iterator
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import yaml

import biped_twins
import talos
from plantar.cli import main as command_line
from plantar.conventions import GRAVITY
from plantar.motions.campaign import FIT
from plantar.robot.model import RobotModel, load_robot
from plantar.robot.uncertainty import EXACT
from plantar.twin.presets import gravitational_stiffness, preset_named
from plantar.twin.robots import hrp2

ROBOTS = ("hrp2", "talos", "g1", "icub")
STIFFER = 2.2  # times the stiffness with which the robot just stands: 500 N·m/rad for the HRP-2-like one
DAMPED = 0.04  # s: damping over stiffness, as `plantar design` takes it
SINKS = 0.003  # m, by which its weight would press one foot's bush: not what `plantar design` takes
KINDS = ("stiffness", "damping", "delay", "compliance")
BARS = {"stiffness": 0.5, "damping": 4.0, "delay": 1.0, "compliance": 5.0}  # % of the value, ms
KEYS = ("robot", "motion", "factor", "seed", "kind", "what")
Row = dict[str, Any]


def robot_file(name: str, folder: Path) -> RobotModel:
    """A robot's file in a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    if name == "hrp2":
        return load_robot(hrp2.write(folder))
    if name == "talos":
        return talos.robot(folder)
    return biped_twins.known_robot(name, biped_twins.urdf_of(name, folder), folder)


def plantar(*arguments: object) -> float:
    """Run a command, in this process; the seconds of CPU that it and its copies took. Raises RuntimeError with its last
    line where not."""
    begin, said = sum(os.times()[:4]), io.StringIO()
    try:
        with redirect_stdout(io.StringIO()), redirect_stderr(said):
            command_line([*map(str, arguments), "-q"])
    except SystemExit as done:
        if done.code:
            raise RuntimeError(said.getvalue().strip().splitlines()[-1]) from None
    return sum(os.times()[:4]) - begin


def told_of(robot: RobotModel) -> float:
    """The stiffness of each foot that the design is told [N·m/rad], of two significant digits."""
    return float(f"{STIFFER * gravitational_stiffness(robot) / len(robot.feet):.2g}")


def vertical(robot: RobotModel) -> float:
    """Stiffness of each bush along z [N/m]."""
    return robot.mass * GRAVITY / SINKS


def played(
    robot: RobotModel,
    motion: str,
    told: float,
    factor: float,
    preset: str,
    seed: int,
    folder: Path,
    exact: bool = False,
) -> Row:
    """The result of a motion, a table's path or names with commas, on feet of another stiffness."""
    k, c, z = factor * told, factor * DAMPED * told, vertical(robot)
    bush = f"{k},{c},{k},{c},{z},{0.005 * z}"
    plantar("simulate", motion, "--robot", robot.path, "--bush", bush, "--preset", preset, "--seed", seed,
            "--out", folder)  # fmt: skip
    if exact:
        file = folder / "robot.yaml"
        entry = yaml.safe_load(file.read_text())
        file.write_text(yaml.safe_dump(entry | {"uncertainty": asdict(EXACT)}))
    logs = [folder / f"{Path(name).stem}.parquet" for name in motion.split(",")]
    plantar("identify", "feet", folder / "robot.yaml", *logs, "--out", folder)
    for log in (*folder.glob("*.parquet"), *folder.glob("*.html")):
        log.unlink()
    return dict(json.loads((folder / "result.json").read_text()))


def scored(
    result: Row, promised: Row | None, robot: RobotModel, told: float, factor: float, late: float
) -> Iterator[Row]:
    """Every number's error and half width, and the promised half width [% of the value, ms for the delay]."""
    models = {(row["foot"], row["axis"]): row["law"] for row in result["laws"]}
    for row in result["parameters"]:
        kind, foot, axis = row["name"], row["foot"], row["axis"]
        if axis == "z" or kind not in KINDS:
            continue
        truth = factor * told * (1.0 if kind == "stiffness" else DAMPED)
        found = {"kind": kind, "what": f"{foot} {axis}", "model": models.get((foot, axis), ""), "error": None}
        if row["value"] is not None and row["interval95"] is not None:
            low, high = row["interval95"]
            found |= {"error": 100 * (row["value"] / truth - 1), "half": 50 * (high - low) / abs(row["value"]),
                      "held": low <= truth <= high, "verdict": row["verdict"]}  # fmt: skip
            if promised is not None:
                found["promised"] = at_stiffness(promised, foot, axis, kind, factor * told)
        yield found
    delay = result["latency"]
    half = 1000 * 1.96 * delay["std"]
    error = 1000 * (delay["wrench_delay"] - late)
    yield {"kind": "delay", "what": "", "error": error, "half": half, "held": abs(error) <= half}
    rows = [row for row in result["parameters"] if row["axis"] == "z" and row["name"] == "stiffness"]
    values = [row["value"] for row in rows]
    error = None if None in values else 50 * vertical(robot) * sum(1 / value for value in values) - 100
    yield {"kind": "compliance", "what": "sum", "error": error, "half": np.nan, "held": error is not None}


def second_round(robot: RobotModel, folder: Path, preset: str, factor: float, seed: int) -> tuple[str, Row]:
    """The table of a motion made from what the first one found on feet of `factor` in `seed`, and what it promises."""
    motion = folder / f"next_{factor:g}.csv"
    if not motion.exists():
        result = folder / f"design_{preset}_{factor:g}_{seed}" / "result.json"
        seconds = plantar("design", robot.path, "--after", result, "--out", motion)
        print(f"{robot.name}: designed after {result} in {seconds:.0f} s of CPU", flush=True)
    return str(motion), json.loads(motion.with_suffix(".json").read_text())


def at_stiffness(promised: Row, foot: str, axis: str, kind: str, stiffness: float) -> float:
    """The promised half width [%] between two rehearsals."""
    rows = (
        row for row in promised["parameters"] if (row["foot"], row["axis"], row["name"]) == (foot, axis, kind)
    )
    known = [
        (one["factor"], one["half_width_percent"]) for one in next(rows)["at"] if one["half_width_percent"]
    ]
    factors, widths = np.log(known).T
    return float(np.exp(np.interp(np.log(stiffness / promised["settings"]["stiffness"]), factors, widths)))


def lost(result: Row) -> dict[str, float]:
    """Seconds of the feet that were left out, by reason."""
    seconds: dict[str, float] = {}
    for phase in result["phases"]:
        if not phase["used"] and phase["end"] - phase["start"] > 0.01 and phase["reason"] != "filter's edge":
            seconds[phase["reason"]] = seconds.get(phase["reason"], 0.0) + phase["end"] - phase["start"]
    return seconds


def summary(rows: list[Row]) -> None:
    """A line for each robot, motion, factor and kind."""
    groups: dict[tuple[str, str, float], list[Row]] = defaultdict(list)
    for row in rows:
        groups[row["robot"], row["motion"], row["factor"]].append(row)
    for (name, motion, factor), group in groups.items():
        seeds = {row["seed"] for row in group}
        models = Counter(row["model"] for row in group if row["kind"] == "stiffness")
        gone = {reason for row in group for reason in row["lost"]}
        left_out = ", ".join(sorted(gone)) or "nothing"
        print(f"{name} x{factor:g}, {motion}, {len(seeds)} seeds; left out: {left_out}; {dict(models)}")
        for kind in KINDS:
            own = [row for row in group if row["kind"] == kind]
            known = [row for row in own if row["error"] is not None]
            if not known:
                print(f"  {kind:11} not identified")
                continue
            error, half = (np.array([row[key] for row in known], float) for key in ("error", "half"))
            ratio = [row["half"] / row["promised"] for row in known if row.get("promised")]
            beside = f"of the promised {np.median(ratio):.2f} to {max(ratio):.2f}" if ratio else ""
            held = 100 * np.mean([row["held"] for row in known])
            within = 100 * np.mean(np.abs(error) <= BARS[kind])
            if kind in ("stiffness", "damping"):
                usable = [row["held"] for row in known if row["verdict"] == "usable"]
                beside += f"  usable {len(usable)}, of these not held {usable.count(False)}"
            print(f"  {kind:11}{len(known):4d} of {len(own):3d}  median {np.median(error):+6.2f}  "
                  f"worst {np.abs(error).max():6.2f}  within {BARS[kind]:g}: {within:5.1f} %  "
                  f"half {np.median(half):6.2f} to {half.max():6.2f}  held {held:5.1f} %  {beside}")  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--robots", default=",".join(ROBOTS))
    parser.add_argument("--factors", default="0.6,1.7")
    parser.add_argument("--preset", default="realistic")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--first", type=int, default=1, help="the first seed")
    parser.add_argument(
        "--paper", action="store_true", help="the paper's composed motion in the design's place"
    )
    parser.add_argument("--second", action="store_true", help="the next motion, made after the first one")
    parser.add_argument("--exact", action="store_true", help="the robot file is right, and says so")
    parser.add_argument("--summary", action="store_true", help="only the summary of what is there")
    parser.add_argument("--out", type=Path, required=True)
    given = parser.parse_args()
    table = given.out / "rows.jsonl"
    if not given.summary:
        for name in given.robots.split(","):
            play_robot(name, given, table)
    rows = [json.loads(line) for line in table.read_text().splitlines()]
    summary(
        list({tuple(row[key] for key in KEYS): row for row in rows}.values())
    )  # what was played again counts once


def play_robot(name: str, given: argparse.Namespace, table: Path) -> None:
    """Design where need be, play every factor and seed, and append the rows."""
    folder = given.out / name
    robot, motion, promised = robot_file(name, folder), ",".join(FIT), None
    told = told_of(robot)
    if not given.paper:
        motion = str(folder / "motion.csv")
        if not Path(motion).exists():
            seconds = plantar("design", robot.path, "--stiffness", told, "--out", motion)
            print(f"{name}: designed for {told:g} N·m/rad in {seconds:.0f} s of CPU", flush=True)
        promised = json.loads(Path(motion).with_suffix(".json").read_text())
    kind = "paper" if given.paper else "second" if given.second else "design"
    name_of_kind = kind + (", exact" if given.exact else "")
    late = preset_named(given.preset).sensors.wrench_delay
    for factor in map(float, given.factors.split(",")):
        if given.second:
            motion, promised = second_round(robot, folder, given.preset, factor, given.first)
        for seed in range(given.first, given.first + given.seeds):
            place = folder / f"{kind}_{given.preset}_{factor:g}_{seed}"
            try:
                result = played(robot, motion, told, factor, given.preset, seed, place, given.exact)
            except RuntimeError as error:
                print(f"  {name} x{factor:g} seed {seed}: {error}", flush=True)
                continue
            facts = {
                "robot": name,
                "motion": name_of_kind,
                "factor": factor,
                "seed": seed,
                "lost": lost(result),
            }
            with table.open("a") as handle:
                for row in scored(result, promised, robot, told, factor, late):
                    handle.write(json.dumps(facts | row) + "\n")


if __name__ == "__main__":
    main()
