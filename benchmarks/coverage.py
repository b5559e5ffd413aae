"""How often the 95 % intervals of K and C cover the truth, over noise seeds, presets of the twin, and two robots.

    python benchmarks/coverage.py --robots hrp2 talos --presets ideal sensors realistic --seeds 8
    python benchmarks/coverage.py --presets sensors realistic plain_log --motions Walk8_1 Walk12_1 Walk16_1 --others

One rollout a motion, preset and robot; the sensors are drawn anew for every seed. Of z the sum of both compliances is
scored, which is what any log with moving weight shows, and each foot's where the result separates them. The truth is
what stands between ankle and ground: bush and floor in series, the floor's part read from the exact simulation (2e-4 of
K on the hard floor, 1 to 2 % on the soft one of `harsh`).
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

import talos
from plantar.conventions import rotation_from_quaternion
from plantar.feet.identify import identify_feet
from plantar.feet.settings import FeetSettings
from plantar.motions.campaign import FIT
from plantar.results.feet import FeetResult
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import EXACT
from plantar.twin import PAPER, play_all
from plantar.twin.bush import Feet
from plantar.twin.play import planned, rolled
from plantar.twin.presets import preset_named
from plantar.twin.robots import hrp2
from plantar.twin.sensing.exact import bush_forces

ROBOTS: dict[str, tuple[Callable[[Path], RobotModel], Feet]] = {
    "hrp2": (lambda _: hrp2.robot(), PAPER),
    "talos": (talos.robot, talos.BUSHES),
}
FLAT = 0.005  # rad: a sole that leans by more stands on its edge
NAMES = {"stiffness": "K", "damping": "C"}


class Score(NamedTuple):
    """One interval beside the truth: error, half width and white std, all relative to the truth."""

    error: float
    inside: bool
    half: float
    white: float


Table = dict[tuple[str, str], list[Score]]  # by axis and K or C


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--robots", nargs="+", default=["hrp2"], choices=ROBOTS)
    parser.add_argument("--presets", nargs="+", default=["sensors"])
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--motions", nargs="+", default=list(FIT))
    parser.add_argument(
        "--others", nargs="*", default=["Myrand5"], help="motions to validate: they show the delay"
    )
    parser.add_argument("--offset", default="per-motion")
    parser.add_argument("--model", default="auto")
    parser.add_argument("--exact", action="store_true", help="tell plantar that the robot file is exact")
    chosen = parser.parse_args()
    settings = FeetSettings(offset=chosen.offset, model=chosen.model)
    every: Table = defaultdict(list)
    print(
        f"{len(chosen.motions)} motions, {chosen.seeds} seeds, offset {chosen.offset}, model {chosen.model}"
    )
    heads = ("mean err %", "max |err| %", "half width %", "white std %", "covered %")
    print(f"{'':22}" + "".join(f"{head:>13}" for head in heads))
    with tempfile.TemporaryDirectory() as folder:
        for name in chosen.robots:
            make, bushes = ROBOTS[name]
            robot = make(Path(folder))
            robot = replace(robot, uncertainty=EXACT) if chosen.exact else robot
            for preset in chosen.presets:
                started = time.perf_counter()
                campaigns = play_all(
                    [*chosen.motions, *chosen.others], robot, bushes, preset, range(chosen.seeds)
                )
                truth = on_the_floor(robot, bushes, preset)
                played = time.perf_counter() - started
                models: Counter[str] = Counter()
                table: Table = defaultdict(list)
                for recordings in campaigns:
                    logs, split = [one.log for one in recordings], len(chosen.motions)
                    result = identify_feet(robot, logs[:split], logs[split:], settings)
                    models[result.model] += 1
                    for key, score in [*_rotations(result, truth), *_compliances(result, truth)]:
                        table[key].append(score)
                        every[key].append(score)
                took = time.perf_counter() - started - played
                print(f"{name}, {preset}: laws {dict(models)}; rollouts {played:.0f} s, fits {took:.0f} s")
                _print(table)
    print("all together")
    _print(every)


def on_the_floor(robot: RobotModel, bushes: Feet, preset: str) -> Feet:
    """Each bush in series with the floor under its sole; the floor's damping is left out."""
    physics = preset_named(preset).physics(bushes, robot)
    found = {}
    for foot, bush in bushes.items():
        series = {}
        for axis, column in (("pitch", 1), ("roll", 2)):
            rollout = rolled(planned(f"Manual_{foot}_{axis}", robot), robot, physics)
            sole = rotation_from_quaternion(rollout.sensors[f"{foot}.sole"])
            tilt = np.arctan2(sole[:, 0, 2], sole[:, 2, 2]) if axis == "pitch" else -np.arcsin(sole[:, 1, 2])
            flat = np.abs(tilt - np.median(tilt)) < FLAT
            stiffness, torque = getattr(bush, f"{axis}_stiffness"), bush_forces(rollout, foot)[:, column]
            share = -stiffness * np.polyfit(torque[flat], tilt[flat], 1)[0]
            series[f"{axis}_stiffness"] = stiffness / (1 + share)
            series[f"{axis}_damping"] = getattr(bush, f"{axis}_damping") / (1 + share) ** 2
        rollout = rolled(planned("Tilt3", robot), robot, physics)
        sunk = -np.polyfit(bush_forces(rollout, foot)[:, 0], rollout.sensors[f"{foot}.place"][:, 2], 1)[0]
        series["z_stiffness"] = 1 / (1 / bush.z_stiffness + sunk)
        found[foot] = replace(bush, **series)
    return found


def _rotations(result: FeetResult, bushes: Feet) -> Iterator[tuple[tuple[str, str], Score]]:
    """K and C of pitch and roll."""
    for row in result.parameters:
        if row.axis == "z" or row.name not in NAMES or row.value is None or row.interval95 is None:
            continue
        truth = getattr(bushes[row.foot], f"{row.axis}_{row.name}")
        low, high = row.interval95
        white = row.relative_std_percent if row.relative_std_percent is not None else np.nan
        yield (
            (row.axis, NAMES[row.name]),
            Score(row.value / truth - 1, low <= truth <= high, (high - low) / 2 / truth, white / 100),
        )


def _compliances(result: FeetResult, bushes: Feet) -> Iterator[tuple[tuple[str, str], Score]]:
    """The sum of both feet's compliances in z, and each foot's stiffness where its verdict is usable."""
    rows = [row for row in result.parameters if row.axis == "z" and row.name == "stiffness"]
    if len(rows) != 2 or any(row.value is None for row in rows):
        return
    total = sum(1 / row.value for row in rows if row.value)
    true = sum(1 / bush.z_stiffness for bush in bushes.values())
    yield ("z", "sum of 1/K"), Score(total / true - 1, True, np.nan, np.nan)
    for row in rows:
        if row.verdict == "usable" and row.value and row.interval95:
            truth, (low, high) = bushes[row.foot].z_stiffness, row.interval95
            yield (
                ("z", "K"),
                Score(row.value / truth - 1, low <= truth <= high, (high - low) / 2 / truth, np.nan),
            )


def _print(table: Table) -> None:
    for (axis, name), scores in table.items():
        _row(f"{axis} {name}", scores)
    turning = [score for (axis, _), scores in table.items() if axis != "z" for score in scores]
    _row("pitch, roll: K and C", turning)


def _row(title: str, scores: list[Score]) -> None:
    error, inside, half, white = (np.array(column, dtype=float) for column in zip(*scores, strict=True))
    numbers = (error.mean(), np.abs(error).max(), half.mean(), white.mean(), inside.mean())
    print(f"  {title:20}" + "".join(f"{100 * number:13.3f}" for number in numbers) + f"  of {len(scores)}")


if __name__ == "__main__":
    main()
