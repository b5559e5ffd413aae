"""Do intervals hold where nothing is plantar's own? Robots in plain MuJoCo, their logs identified as a user would.

    python benchmarks/outside_worlds.py --exact --robots hrp2 g1 --worlds 1        sensors and robot file exact
    python benchmarks/outside_worlds.py --worlds 6 --first 100 --keep DIR          --keep: logs are made once
    python benchmarks/outside_worlds.py --walks --robots hrp2 talos g1             walks instead of standing

Each seed is another robot with rubber, sensors and a robot file of its own; every second one has rubber that slides
inside. A number is wrong if it is called usable and the truth lies outside of one and a half half widths by more than a
per cent of it.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from outside import robots, sensors
from outside.motions import MOTIONS, plan
from outside.physics import LIFTED_SOLE, Motion, play
from outside.robots import NAMES, real_robot, rubber_of, with_soles, write_told
from outside.rubber import Rubber
from outside.stance import Stance
from outside.walks import WALKS, walked
from plantar.conventions import NORMAL95
from plantar.errors import MotionError
from plantar.robot.model import RobotModel

DURATION = 30.0  # s
SIZES = (1.0, 0.7, 0.5, 0.35)  # times a motion's usual size, the largest that keeps the soles flat
FLAT = 0.002  # rad
BEYOND, WORTH = 1.5, 0.01  # half widths, and share of the truth, from which a usable number is wrong
NAMES_OF = {"stiffness": "K", "damping": "C", "slip_torque": "slip torque", "slip_angle": "slip angle"}
Row = dict[str, Any]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--robots", nargs="+", default=NAMES, choices=NAMES)
    parser.add_argument("--worlds", type=int, default=6)
    parser.add_argument("--first", type=int, default=100, help="the first seed")
    parser.add_argument(
        "--exact", action="store_true", help="sensors and robot file without errors, no sliding"
    )
    parser.add_argument("--walks", action="store_true", help="walks instead of motions on standing feet")
    parser.add_argument("--gears", type=float, default=0.0, help="by which joints bend unseen [rad/(N.m)]")
    parser.add_argument("--keep", type=Path, help="folder in which logs stay, and are found again")
    chosen = parser.parse_args()
    kept = chosen.keep or Path(tempfile.mkdtemp(prefix="plantar-"))
    rows, kind = list[Row](), ("_exact" if chosen.exact else "") + ("_walks" if chosen.walks else "")
    kind += f"_{chosen.gears:g}" if chosen.gears else ""
    for name in chosen.robots:
        for seed in range(chosen.first, chosen.first + chosen.worlds):
            folder = kept / f"{name}_{seed}{kind}"
            if not (folder / "truth.json").exists():
                make(name, seed, chosen.exact, chosen.walks, chosen.gears, folder)
            found = score(folder, name, seed, WALKS if chosen.walks else MOTIONS)
            rows += found
            for row in found:
                print(_line(row), flush=True)
    print(_summary(rows))


def make(name: str, seed: int, exact: bool, walks: bool, gears: float, folder: Path) -> None:
    """Logs, robot file and truth of one world."""
    folder.mkdir(parents=True, exist_ok=True)
    robot = real_robot(name, folder)
    rubber = rubber_of(robot, seed, sliding=not exact and seed % 2 == 1)
    lab = sensors.EXACT if exact else sensors.Lab()
    drawn = sensors.draw_sensors(robot, lab, seed, 200.0 if exact else None)
    stance = Stance(robot)
    for motion in WALKS if walks else MOTIONS:
        played = _walk(robot, motion, rubber, gears) if walks else _flat(stance, motion, seed, rubber, gears)
        if played is not None:
            columns = sensors.record(robot, played, lab, drawn, seed, motion)
            sensors.write(columns, str(folder / f"{motion}.csv"))
    told = with_soles(robot, *LIFTED_SOLE) if walks else robot
    write_told(told, robots.EXACT if exact else robots.Spread(), seed, folder)
    truth = _truth(robot, rubber) + [["", "", "delay", float(np.mean(list(drawn.late.values())))]]
    facts = {"numbers": truth, "rate": drawn.rate, "late": dict(drawn.late)}
    (folder / "truth.json").write_text(json.dumps(facts))


def _flat(stance: Stance, motion: str, seed: int, rubber: dict[str, Rubber], gears: float) -> Motion | None:
    for size in SIZES:
        try:
            made = plan(stance, motion, DURATION, seed, size)
        except ValueError:
            continue
        played = play(stance.robot, made.start, made.targets, rubber, gears=gears)
        if played.tilt < FLAT:
            return played
    return None


def _walk(robot: RobotModel, name: str, rubber: dict[str, Rubber], gears: float) -> Motion | None:
    try:
        return walked(robot, name, rubber, gears)
    except MotionError as error:
        print(error, file=sys.stderr)
        return None


def _truth(robot: RobotModel, rubber: dict[str, Rubber]) -> list[list[Any]]:
    rows = list[list[Any]]()
    for foot in robot.feet:
        for axis in ("pitch", "roll"):
            hinge = getattr(rubber[foot], axis)
            rows += [[foot, axis, "stiffness", hinge.stiffness], [foot, axis, "damping", hinge.damping]]
            if hinge.slip_torque:
                rows += [
                    [foot, axis, "slip_torque", hinge.slip_torque],
                    [foot, axis, "slip_angle", hinge.slip_angle],
                ]
        rows.append([foot, "z", "stiffness", rubber[foot].stiffness])
    return rows


def score(folder: Path, name: str, seed: int, motions: Sequence[str]) -> list[Row]:
    """Every number of one world beside its truth; none where fewer than two motions could be played."""
    facts = json.loads((folder / "truth.json").read_text())
    logs = [folder / f"{motion}.csv" for motion in motions if (folder / f"{motion}.csv").exists()]
    if len(logs) < 2:
        return []
    command = [Path(sys.executable).parent / "plantar", "identify", "feet", folder / "robot.yaml", *logs[:-1]]
    command += ["--validate", logs[-1], "--out", folder / "out", "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        return [
            {
                "robot": name,
                "seed": seed,
                "foot": "",
                "axis": "",
                "name": done.stderr.strip(),
                "verdict": "failed",
            }
        ]
    result = json.loads((folder / "out" / "result.json").read_text())
    said = {(row["foot"], row["axis"], row["name"]): row for row in result["parameters"]}
    rows = list[Row]()
    for foot, axis, quantity, truth in facts["numbers"]:
        row: Row = {"robot": name, "seed": seed, "foot": foot, "axis": axis, "name": quantity, "truth": truth}
        found = said.get((foot, axis, quantity))
        if quantity == "delay":
            found = _delay(result)
        if found is None or found["value"] is None or found["interval95"] is None:
            rows.append(row | {"verdict": "missing" if found is None else found["verdict"]})
            continue
        low, high = found["interval95"]
        scale = 0.001 if quantity == "delay" else abs(truth)
        error, half = (found["value"] - truth) / scale, (high - low) / 2 / scale
        held = low <= truth <= high
        wrong = found["verdict"] == "usable" and abs(error) > max(
            BEYOND * half, 0.1 if quantity == "delay" else WORTH
        )
        rows.append(
            row | {"verdict": found["verdict"], "error": error, "half": half, "held": held, "wrong": wrong}
        )
    return rows


def _delay(result: dict[str, Any]) -> Row | None:
    found = result["latency"]
    if not found:
        return None
    value, half = found["wrench_delay"], NORMAL95 * found["std"]
    verdict = "usable" if found["measured"] else "weak"
    return {"value": value, "interval95": [value - half, value + half], "verdict": verdict}


def _line(row: Row) -> str:
    quantity = NAMES_OF.get(row["name"], row["name"])
    title = f"{row['robot']:10} {row['seed']:4} {row['foot']:6}{row['axis']:6}{quantity:12}"
    if "error" not in row:
        return f"{title}{row['verdict']}"
    unit, scale = ("ms", 1) if row["name"] == "delay" else ("%", 100)
    sign = "WRONG" if row["wrong"] else "" if row["held"] else "out"
    return (
        f"{title}{row['verdict']:15}{scale * row['error']:+8.2f} ± {scale * row['half']:6.2f} {unit:3}{sign}"
    )


def _summary(rows: Sequence[Row]) -> str:
    groups = defaultdict(list)
    for row in rows:
        groups[f"{row['axis']:6}{NAMES_OF.get(row['name'], row['name'])}"].append(row)
    lines = [f"{'':20}{'held %':>8}{'of':>5}{'median |error| %':>18}{'median half %':>15}  verdicts"]
    for title, group in sorted(groups.items()):
        told = [row for row in group if "error" in row]
        verdicts = dict(Counter(row["verdict"] for row in group))
        wrong = sum(row["wrong"] for row in told)
        numbers = ""
        if told:
            error, half = (100 * np.median(np.abs([row[key] for row in told])) for key in ("error", "half"))
            numbers = (
                f"{100 * np.mean([row['held'] for row in told]):8.1f}{len(told):5d}{error:18.2f}{half:15.2f}"
            )
        lines.append(f"{title:20}{numbers:46}  {verdicts}{f', {wrong} wrong' if wrong else ''}")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
