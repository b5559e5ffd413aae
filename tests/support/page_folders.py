"""What a reader of a page has in front of him: a small made robot, and logs under the names that the page uses."""

from __future__ import annotations

import argparse
import json
from functools import cache
from pathlib import Path

import mujoco
import numpy as np
import yaml

import design_samples
from biped import TRUTH, record, sway
from biped_robot import FEET, SOLE_DEPTH, URDF, Frame, Mounting, make_robot, robot_entry, write_robot
from fleet_samples import small_fleet
from page_blocks import ROOT, blocks
from plantar.design.known import Known
from plantar.design.writing.outputs import write_design
from plantar.logs.motion_log import MotionLog
from plantar.logs.save import save_log
from plantar.motions import CAMPAIGN, DEMO
from plantar.results.feet import FeetResult
from plantar.robot.model import load_robot

MOUNTING = Mounting(wrench=Frame())  # force sensors at a link of the URDF, as drivers say in their messages
SECONDS = 8.0
STEP, STANDS = 1.5, 1.0  # s, of a step and of its stance


@cache
def swaying(name: str, seed: int) -> MotionLog:
    """The robot sways over both feet."""
    return record(sway(name, seed, duration=SECONDS), MOUNTING)


@cache
def stepping(name: str, seed: int) -> MotionLog:
    """The same with the left foot lifted for a third of each step; the right one carries what it does not."""
    log = swaying(name, seed)
    loaded = np.mod(log.time, STEP) < STANDS
    changed = {}
    for part in ("force", "torque"):
        for axis in "xyz":
            left, right = (f"wrench.{foot}.{part}.{axis}" for foot in ("left", "right"))
            changed[left] = np.where(loaded, log.columns[left], 0.0)
            if part == "force":
                changed[right] = log.columns[right] + np.where(loaded, 0.0, log.columns[left])
    return log.with_columns(changed)


def nothing(folder: Path) -> None:
    """For pages that need no file."""


def own_logs(folder: Path) -> None:
    """A URDF and bags, and no robot file yet."""
    known = make_robot(folder / "known", MOUNTING)
    for name in ("robot.urdf", "talos.urdf"):
        (folder / name).write_text(URDF)
    scene = mujoco.MjModel.from_xml_string(URDF)
    mujoco.mj_saveLastXML(str(folder / "robot.xml"), scene)
    for seed, name in enumerate(("sway_1", "sway_2", "squat", "another_day"), start=1):
        save_log(swaying(name, seed), folder / f"{name}.mcap", known)


def many_formats(folder: Path) -> None:
    """Beside the bags tables."""
    own_logs(folder)
    for seed, name in enumerate(("one", "two"), start=1):
        save_log(swaying(name, seed), folder / f"{name}.csv")


def with_robot_file(folder: Path) -> None:
    """Robot files and tables."""
    own_logs(folder)
    for name in ("robot", "talos"):
        written = write_robot(folder / name, MOUNTING)
        (folder / f"{name}.yaml").write_text(written.read_text().replace("biped.urdf", f"{name}.urdf"))
    for seed, name in enumerate(("sway_1", "sway_2", "squat"), start=1):
        save_log(swaying(name, seed), folder / f"{name}.csv")
    for seed, name in enumerate(("walk_1", "walk_2", "other_walk"), start=1):
        save_log(stepping(name, seed), folder / f"{name}.csv")


def other_names(folder: Path) -> None:
    """A table of a logger that has names, units and an order of its own, and the map that the page shows."""
    own_logs(folder)
    page = ROOT / "docs" / "how_to" / "other_names.md"
    (folder / "columns.yaml").write_text(next(block.text for block in blocks(page) if block.kind == "yaml"))
    log = swaying("logger", 1)
    renamed = {"time": 1e3 * log.time}
    for name, values in log.columns.items():
        kind, sensor, *rest = name.split(".")
        if kind == "wrench":
            renamed[f"{sensor[0]}f_{'f' if rest[0] == 'force' else 'm'}{rest[1]}"] = values
        elif rest[0] == "orientation":
            renamed[f"q{rest[1]}"] = values
        elif rest[0] in ("angular_velocity", "linear_acceleration"):
            renamed[f"{'g' if rest[0] == 'angular_velocity' else 'a'}{rest[1]}"] = values
        elif rest[0] == "position":
            renamed[f"q_{sensor}"] = np.degrees(values)
    header = ",".join(["stamp", *list(renamed)[1:]])
    rows = np.column_stack(list(renamed.values()))
    np.savetxt(folder / "logger.csv", rows, delimiter=",", header=header, comments="", fmt="%.10g")


def force_cells(folder: Path) -> None:
    """A robot on force cells at the places that the page shows, and a table of what they read."""
    page = ROOT / "docs" / "how_to" / "force_cells.md"
    shown = yaml.safe_load(next(block.text for block in blocks(page) if block.kind == "yaml"))
    mounting = Mounting(wrench=Frame((0.0, 0.0, -SOLE_DEPTH)))
    entry = robot_entry(mounting)
    for foot, own in entry["feet"].items():  # type: ignore[attr-defined]
        own |= shown["feet"][foot]
    (folder / "biped.urdf").write_text(URDF)
    (folder / "cells.yaml").write_text(yaml.safe_dump({**entry, "columns": shown["columns"]}))
    log = record(sway("cells", 1, duration=SECONDS), mounting)
    columns = {name: values for name, values in log.columns.items() if not name.startswith("wrench.")}
    for foot in FEET:
        cells = shown["columns"][f"wrench.{foot}.cells"]
        at, wrench = np.array(cells["at"]), log.wrench(foot)
        # Force z, torques x and y of each cell's newton.
        made = np.vstack([np.ones(len(at)), at[:, 1], -at[:, 0]])
        columns |= dict(zip(cells["from"], np.linalg.pinv(made) @ wrench[:, [2, 3, 4]].T, strict=True))
    rows = np.column_stack([log.time, *columns.values()])
    np.savetxt(
        folder / "cells.csv",
        rows,
        delimiter=",",
        header=",".join(["time", *columns]),
        comments="",
        fmt="%.10g",
    )


def simulated(words: list[str]) -> None:
    """`plantar simulate` without the twin: the made robot's logs under the motions' names, and its robot file."""
    asked = argparse.ArgumentParser(exit_on_error=True)
    asked.add_argument("motion")
    asked.add_argument("--out", type=Path, required=True)
    for option in ("--preset", "--bush"):
        asked.add_argument(option)
    asked.add_argument("--robot", type=Path)
    for option in ("--seed", "--sway", "--vertical", "--apart", "--period"):
        asked.add_argument(option, type=float)
    asked.add_argument("-q", "--quiet", action="store_true")
    for option in ("--robots", "--days"):
        asked.add_argument(option, type=int)
    given = asked.parse_args(words)
    assert given.robot is None or given.robot.is_file()
    if given.motion == "fleet":
        small_fleet(given.out, 2)
        return
    names = {"campaign": CAMPAIGN, "demo": DEMO}.get(given.motion, tuple(given.motion.split(",")))
    write_robot(given.out, MOUNTING)
    (given.out / "hrp2.urdf").write_text(URDF.replace('"torso"', '"CHEST_LINK1"'))
    bushes: dict[str, dict[str, float]] = {foot: {} for foot in FEET}
    for (foot, axis), law in TRUTH.items():
        bushes[foot] |= {f"{axis}_stiffness": law.stiffness, f"{axis}_damping": law.damping}
    before = len(list(given.out.glob("*.parquet")))  # no two recordings are the same
    for seed, name in enumerate((Path(name).stem for name in names), before):
        made = stepping(name, seed) if name.startswith("Walk") else swaying(name, seed)
        save_log(made, given.out / f"{name}.parquet")
        (given.out / f"{name}.truth.json").write_text(json.dumps({"bushes": bushes}))


def designed(words: list[str]) -> None:
    """`plantar design` without search and rehearsals: a small motion of the built-in robot."""
    asked = argparse.ArgumentParser(exit_on_error=True)
    asked.add_argument("robot", type=Path)
    asked.add_argument("--out", type=Path, required=True)
    asked.add_argument("--after", type=Path)
    for option in ("--stiffness", "--duration"):
        asked.add_argument(option, type=float)
    asked.add_argument("--to", action="append", default=[])
    asked.add_argument("--approach", action="store_true")
    given = asked.parse_args(words)
    load_robot(given.robot)
    assert given.stiffness is not None or Known.of(FeetResult.load(given.after)).stiffness > 0
    write_design(design_samples.designed(), given.out, 50.0, given.to, given.approach)


# Commands that play the twin, and what does their work on small made logs.
STAND_INS = {"simulate": simulated, "design": designed}
