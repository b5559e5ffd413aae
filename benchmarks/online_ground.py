"""The estimator's watch for another ground: false alarms in ordinary motions, and how soon mats are noticed.

    python benchmarks/online_ground.py --preset sensors --seeds 4
    python benchmarks/online_ground.py --mats --seeds 5

Half an hour and more of standing and walking, each log a rollout with sensors of its own, passes through one estimator:
each change of ground that it tells is false. With `--mats` the feet are twice as stiff as the paper's on firm ground;
then the robot stands on mats that halve this, and does one of the motions again. Told are the seconds of the log, and
the seconds in which a foot that stands is bent faster than 5 mrad/s, from the first tick on mats to the flag of any
foot. Seeds below 100 were used to choose thresholds.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from online import law
from plantar.conventions import ROTATIONAL_AXES
from plantar.online.estimates import Contact, Flag
from plantar.online.estimator import FootEstimator
from plantar.online.replay import Replay
from plantar.robot.uncertainty import EXACT
from plantar.twin import PAPER
from plantar.twin.bush import Bush, Feet
from plantar.twin.play import planned, rolled
from plantar.twin.presets import Preset, preset_named
from plantar.twin.recording import TwinRecording, record
from plantar.twin.robots import hrp2

ORDINARY = (
    "Tilt1", "Tilt2", "Tilt3", "Tilt5", "Squat", "Myrand4", "Walk8", "Walk12", "Walk16", "WalkSlow8", "WalkTurn",
    "WalkInPlace",
)  # fmt: skip
FIRM = ("Tilt1", "Walk12", "Tilt3")  # what is learnt from before the mats
ON_MATS = ("Tilt1", "Tilt3", "Walk8", "Walk16")
MOVING = 0.005  # rad/s


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--preset", default="sensors")
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--first", type=int, default=100, help="seed")
    parser.add_argument("--mats", action="store_true", help="time until mats are noticed")
    told = parser.parse_args()
    seeds = range(told.first, told.first + told.seeds)
    (mats if told.mats else ordinary)(preset_named(told.preset), seeds)


def ordinary(preset: Preset, seeds: Sequence[int]) -> None:
    plays = {motion: Player(motion, PAPER, preset) for motion in ORDINARY}
    random, seconds, alarms = np.random.default_rng(seeds[0]), 0.0, 0
    for seed in seeds:
        estimator = _estimator(preset, seed)
        for motion in random.permutation(ORDINARY):
            log = plays[motion](seed).log
            replay, seconds = estimator.replay(log), seconds + log.duration
            for foot in replay.feet:
                begun = _rises(replay, foot)
                alarms += begun.size
                for time in begun:
                    print(f"  seed {seed}, {motion}, {foot}: told at {time:.1f} s")
    print(f"{preset.name}: {alarms} false changes of ground in {seconds / 60:.0f} min of both feet")


def mats(preset: Preset, seeds: Sequence[int]) -> None:
    firm: Mapping[str, Bush] = {foot: _times(bush, 2.0) for foot, bush in PAPER.items()}
    before = [Player(motion, firm, preset) for motion in FIRM]
    for motion in ON_MATS:
        after, passed, moved, missed = Player(motion, PAPER, preset), list[float](), list[float](), 0
        for seed in seeds:
            estimator = _estimator(preset, seed)
            for play in before:
                estimator.replay(play(seed).log)
            replay = estimator.replay(after(seed).log)
            told = [time for foot in replay.feet for time in _rises(replay, foot)]
            if not told:
                missed += 1
                continue
            passed.append(min(told) - replay.time[0])
            moved.append(_moving(replay, min(told)))
        times = ", ".join(
            f"{name} median {np.median(values):.1f} s, longest {max(values):.1f} s"
            for name, values in (("in the log", passed), ("moving", moved))
            if values
        )
        print(f"{preset.name}, {motion} on mats: noticed {len(passed)} of {len(passed) + missed}; {times}")


def _rises(replay: Replay, foot: str) -> np.ndarray:
    """When a change of ground is told anew [s]."""
    told = (replay.column(foot, "flags").astype(int) & Flag.GROUND_CHANGED) > 0
    return replay.time[1:][told[1:] & ~told[:-1]]


def _moving(replay: Replay, until: float) -> float:
    """Seconds up to a time in which one of the feet stands and is bent [s]."""
    moves = np.zeros(replay.time.size, dtype=bool)
    for foot in replay.feet:
        stands = replay.column(foot, "contact") == Contact.STANCE
        for axis in ROTATIONAL_AXES:
            moves |= stands & (np.abs(replay.column(foot, f"{axis}.rate")) > MOVING)
    return float(np.median(np.diff(replay.time)) * moves[replay.time <= until].sum())


def _times(bush: Bush, factor: float) -> Bush:
    names = ("pitch_stiffness", "pitch_damping", "roll_stiffness", "roll_damping")
    return replace(bush, **{name: factor * getattr(bush, name) for name in names})


class Player:
    """A motion's rollout, recorded anew for each seed."""

    def __init__(self, motion: str, bushes: Feet, preset: Preset) -> None:
        self.robot, self.preset, self.physics = hrp2.robot(), preset, preset.physics(bushes)
        self.rollout = rolled(planned(motion, self.robot), self.robot, self.physics)

    def __call__(self, seed: int) -> TwinRecording:
        return record(self.rollout, self.robot, self.physics, self.preset, seed)


def _estimator(preset: Preset, seed: int) -> FootEstimator:
    robot = replace(hrp2.robot(), uncertainty=EXACT)
    return FootEstimator(robot, law(preset, seed), wrench_delay=preset.sensors.wrench_delay)


if __name__ == "__main__":
    main()
