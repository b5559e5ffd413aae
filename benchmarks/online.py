"""The estimator of controllers on the twin: errors after a time, coverage of its intervals, deflection, time of a step.

    python benchmarks/online.py --preset sensors --motions Tilt1 Tilt3 --seeds 20
    python benchmarks/online.py --preset realistic --motions Walk12 Walk16 --seeds 20

Motions of a seed are replayed one after the other by one estimator. The delay is told, and of rubber with hysteresis
the element (as a batch result would), its torque wrong by a draw of 1 %. The robot file is exact, as the twin is.
Numbers of axes that are not known within a tenth are counted. Errors are those of the numbers that `plantar online`
calls usable: an interval narrower than a tenth, of C narrower than 6 %, and a stiffness that does not rest on the slip
torque that was told alone. Intervals promise to hold for all, so that those of the others are scored too ("all
cover"). The truth is what stands between ankle and ground, bush and floor in series.
`--motions campaign` plays the paper's fourteen.
"""

from __future__ import annotations

import argparse
import tempfile
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

import talos
from coverage import on_the_floor
from plantar.conventions import ROTATIONAL_AXES
from plantar.feet.identify import identify_feet
from plantar.motions.campaign import CAMPAIGN
from plantar.online.estimates import Contact, Flag
from plantar.online.estimator import FootEstimator
from plantar.online.replay import USABLE, Replay
from plantar.results.feet import FeetResult
from plantar.results.feet_rows import Parameter
from plantar.robot.model import RobotModel
from plantar.robot.uncertainty import EXACT
from plantar.twin import PAPER, play_all
from plantar.twin.bush import Feet
from plantar.twin.presets import Preset, preset_named
from plantar.twin.recording import TwinRecording
from plantar.twin.robots import hrp2

TORQUE_STD = 0.01  # of an element's torque, as a batch result knows it
OTHERS = 1000  # added to a seed, whose sensors recorded what the batch fit has seen
NAMES = {"stiffness": "K", "damping": "C"}
WHOLE = {short: name for name, short in NAMES.items()}
UNTESTED = {"pitch": Flag.PITCH_UNTESTED, "roll": Flag.ROLL_UNTESTED}


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--robot", default="hrp2", choices=("hrp2", "talos"))
    parser.add_argument("--preset", default="sensors")
    parser.add_argument("--motions", nargs="+", default=["Tilt1", "Tilt3"])
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument(
        "--first", type=int, default=100, help="seed; those below 100 were used to choose thresholds"
    )
    parser.add_argument(
        "--after", type=float, default=60.0, help="s of logs, from which on numbers are scored"
    )
    parser.add_argument(
        "--batch",
        action="store_true",
        help="tell what identify feet finds in the campaign of another draw of the sensors, not the truth",
    )
    told = parser.parse_args()
    if told.motions == ["campaign"]:
        told.motions = list(CAMPAIGN)
    preset = preset_named(told.preset)
    scores: dict[str, list[Score]] = defaultdict(list)
    unknown: dict[str, int] = defaultdict(int)
    truth = on_the_floor(*twin_of(told.robot), told.preset)
    deflections: dict[str, list[float]] = defaultdict(list)
    latency: list[float] = []
    slides: list[tuple[float, float]] = []  # errors of the compliances at the end, and half widths
    twin = twin_of(told.robot)
    everything = play_all(
        told.motions, twin.robot, twin.bushes, told.preset, range(told.first, told.first + told.seeds)
    )
    for seed, recordings in enumerate(everything, told.first):
        result = batch(twin, told.preset, seed) if told.batch else law(preset, seed, twin)
        estimator = FootEstimator(
            twin.robot, result, wrench_delay=None if told.batch else preset.sensors.wrench_delay
        )
        last = _score(twin, truth, estimator, recordings, told.after, scores, unknown, deflections, latency)
        for foot, bush in truth.items():
            found = last.estimate(foot).compliance
            slides.append((found.value * bush.z_stiffness - 1, found.half_width * bush.z_stiffness))
    motions = ", ".join(told.motions)
    print(f"{told.robot}, {told.preset}, {motions}, {told.seeds} seeds, every 5 s from {told.after:g} s on")
    for key in sorted({*scores, *unknown}):
        error, half, rests = np.array(scores[key]).reshape(-1, 3).T * 100
        inside, narrow = np.abs(error) <= half, half <= USABLE[WHOLE[key[-1]]] * (100 + error)
        usable = narrow & (rests == 0)
        print(
            f"  {key:8} {usable.sum()} usable, {(rests > 0).sum()} resting on what was told, "
            f"{(~narrow & (rests == 0)).sum()} weak, {unknown[key]} not known: error rms "
            f"{_rms(error[usable]):.2f} %, mean {_mean(error[usable]):.2f} %, largest "
            f"{np.abs(error[usable]).max(initial=0):.2f} %, half width {_median(half[usable]):.2f} %, covers "
            f"{100 * _mean(inside[usable]):.0f} %, all cover {100 * _mean(inside):.0f} %"
        )
    for axis, values in deflections.items():
        print(
            f"  deflection {axis}: {np.mean(values):.3f} mrad rms about each recording's bias, worst {max(values):.3f}"
        )
    error, half = 100 * np.array(slides).T
    print(
        f"  compliance at the end: error rms {_rms(error):.1f} %, mean {_mean(error):.1f} %, largest "
        f"{np.abs(error).max():.1f} %, half width {_median(half):.1f} %, covers "
        f"{100 * _mean(np.abs(error) <= half):.0f} %"
    )
    median, p999 = np.percentile(latency, [50, 99.9])
    print(f"  a step: median {1e6 * median:.1f} µs, 99.9 % {1e6 * p999:.1f} µs")


class Score(NamedTuple):
    """A number's error and half width, shares of the truth; whether it rests on what was told of the element alone."""

    error: float
    half: float
    rests: bool


class Twin(NamedTuple):
    """A robot whose file is exact, and the bushes under it."""

    robot: RobotModel
    bushes: Feet


def twin_of(name: str) -> Twin:
    if name == "hrp2":
        return Twin(replace(hrp2.robot(), uncertainty=EXACT), PAPER)
    with tempfile.TemporaryDirectory() as folder:
        return Twin(replace(talos.robot(Path(folder)), uncertainty=EXACT), talos.BUSHES)


def _score(
    twin: Twin,
    bushes: Feet,
    estimator: FootEstimator,
    recordings: Sequence[TwinRecording],
    after: float,
    scores: dict[str, list[Score]],
    unknown: dict[str, int],
    deflections: dict[str, list[float]],
    latency: list[float],
) -> Replay:
    """Adds to the scores; returns what the estimator said of the last recording."""
    begun = 0.0
    for one in recordings:
        replay = estimator.replay(one.log)
        latency += replay.latency.tolist()
        for foot in replay.feet:
            tips = (replay.column(foot, "flags").astype(int) & Flag.EDGE) > 0
            stands = (replay.column(foot, "contact") == Contact.STANCE) & ~tips
            for axis in ROTATIONAL_AXES:
                truth = np.interp(replay.time, one.truth.time, one.truth.column(f"{foot}.deflection.{axis}"))
                away = (replay.column(foot, f"{axis}.deflection") - truth)[stands]
                if away.size:
                    deflections[axis].append(1e3 * float(np.std(away)))
                for sample in range(0, len(one.log), round(5.0 / one.log.period)):
                    if begun + replay.time[sample] - replay.time[0] < after:
                        continue
                    estimate = replay.estimate(foot, sample)
                    found, rests = getattr(estimate, axis), bool(estimate.flags & UNTESTED[axis])
                    for name, short in NAMES.items():
                        right, key = getattr(bushes[foot], f"{axis}_{name}"), f"{axis} {short}"
                        value = getattr(found, name)
                        if found.identified or rests:
                            told = rests and name == "stiffness"
                            scores[key].append(Score(value.value / right - 1, value.half_width / right, told))
                        else:
                            unknown[key] += 1
        begun += one.log.duration
    return replay


def batch(twin: Twin, preset: str, seed: int) -> FeetResult:
    """What the batch tool finds in the fourteen motions, recorded by sensors of another draw."""
    recordings = play_all(CAMPAIGN, twin.robot, twin.bushes, preset, [seed + OTHERS])[0]
    return identify_feet(twin.robot, [one.log for one in recordings])


def law(preset: Preset, seed: int, twin: Twin | None = None) -> FeetResult:
    """A batch result that knows the bushes' elements, or that they have none."""
    rows, random = [], np.random.default_rng([seed, 7])
    robot, bushes = twin or (None, PAPER)
    for foot, bush in (preset.physics(bushes, robot).bushes or {}).items():
        for axis in ROTATIONAL_AXES:
            rows.append(_row(foot, axis, "stiffness", getattr(bush, f"{axis}_stiffness"), 0.0))
            torque, angle = getattr(bush, f"{axis}_slip_torque"), getattr(bush, f"{axis}_slip_angle")
            if torque:
                told = torque * (1 + TORQUE_STD * random.standard_normal())
                rows += [
                    _row(foot, axis, "slip_angle", angle, 0.0),
                    _row(foot, axis, "slip_torque", told, TORQUE_STD * torque),
                ]
    return FeetResult("twin", (), {}, "told", tuple(rows), (), (), (), ())


def _row(foot: str, axis: str, name: str, value: float, std: float) -> Parameter:
    return Parameter(foot, axis, name, "", value, std, None, None, "usable", "")


def _mean(values: np.ndarray) -> float:
    return float(np.mean(values)) if values.size else 0.0


def _median(values: np.ndarray) -> float:
    return float(np.median(values)) if values.size else 0.0


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0


if __name__ == "__main__":
    main()
