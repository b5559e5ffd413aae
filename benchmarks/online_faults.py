"""Readings with faults: do the estimator's outputs stay finite, do its flags say so, is it itself again afterwards?

    python benchmarks/online_faults.py --preset sensors --seeds 3

The twin walks and tilts; then the same readings come with a fault, once for four seconds in the middle of a log, once
from the first tick to the last. Told are, for each fault: whether any number was not finite; the share of the fault's
ticks at which one of the flags stands that say so; how long after the fault's end flags and deflections are again those
of the log without it; how far K of what is called identified is off, in its half widths, at worst, and C of it, where
its interval is narrow enough to be used. A number that is wrong should not look narrow: more than 2 half widths are
told with an exclamation mark. Seeds below 100 were used to choose thresholds.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from coverage import on_the_floor
from online import Twin, law, twin_of
from plantar.conventions import ROTATIONAL_AXES
from plantar.logs.motion_log import MotionLog
from plantar.online.estimates import FIELDS, Flag, foot_estimate
from plantar.online.estimator import FootEstimator
from plantar.online.replay import USABLE
from plantar.signals.segments import runs
from plantar.twin import play_all
from plantar.twin.presets import Preset, preset_named

MOTIONS = ("Walk12", "Tilt1", "Manual_right_pitch", "Walk16")
BROKEN = (1, 3)  # of these motions, those in which a fault of some seconds comes
BEGIN, LAST = 12.0, 4.0  # s of the log
SAID = (
    Flag.INPUT_MISSING | Flag.FROZEN | Flag.TIME_FAULT | Flag.NOT_STANDING | Flag.EDGE | Flag.SLIP | Flag.IMPACT
    | Flag.NEVER_LOADED | Flag.GROUND_CHANGED | Flag.CONTRADICTION | Flag.LATE_WRENCH
    | Flag.LATE_IMU
)  # fmt: skip
AWAY = 1e-3  # rad: a deflection further from the faultless one is not yet itself again
BLINK = 0.05  # s: a landing that counts a little later is no fault
BELIEVED = 2.0  # half widths


@dataclass
class Readings:
    """What a controller would read: (N,), (N, joints), (N, 4), (N, 3), (N, feet, 6)."""

    time: np.ndarray
    position: np.ndarray
    attitude: np.ndarray
    rate: np.ndarray
    wrench: np.ndarray

    @classmethod
    def of(cls, log: MotionLog, twin: Twin, after: float) -> Readings:
        robot, imu = twin.robot, twin.robot.imu
        assert imu is not None
        attitude = log.orientation(imu.name)
        assert attitude is not None
        wrench = np.stack([log.wrench(foot.wrench.name) for foot in robot.feet.values()], axis=1)
        rate = log.angular_velocity(imu.name)
        time = log.time - log.time[0] + after
        return cls(time, *(np.array(one) for one in (log.positions(robot), attitude, rate, wrench)))

    def through(self, estimator: FootEstimator) -> np.ndarray:
        rows = np.empty((len(self.time), len(estimator.robot.feet), len(FIELDS)))
        whole = [np.ascontiguousarray(one) for one in (self.time, self.position)]
        rest = [np.ascontiguousarray(one) for one in (self.attitude, self.rate)]
        estimator._core.replay(
            *whole, None, *rest, None, np.ascontiguousarray(self.wrench), rows, np.empty(len(rows))
        )
        return rows


Fault = Callable[[Readings, slice], None]


def nan(part: str) -> Fault:
    def spoil(readings: Readings, ticks: slice) -> None:
        random = np.random.default_rng(0)
        hit = np.arange(ticks.start, ticks.stop)[random.random(ticks.stop - ticks.start) < 0.3]
        getattr(readings, part)[hit] = np.nan

    return spoil


def frozen(part: str, index: tuple[int, ...] = ()) -> Fault:
    def spoil(readings: Readings, ticks: slice) -> None:
        values = getattr(readings, part)
        values[(ticks, *index)] = values[(ticks.start, *index)]

    return spoil


def times(part: str, factor: float, index: tuple[int, ...] = ()) -> Fault:
    def spoil(readings: Readings, ticks: slice) -> None:
        getattr(readings, part)[(ticks, *index)] *= factor

    return spoil


def spiked(readings: Readings, ticks: slice) -> None:
    random = np.random.default_rng(0)
    hit = np.arange(ticks.start, ticks.stop)[random.random(ticks.stop - ticks.start) < 0.03]
    readings.wrench[hit, 0] += 300.0 * random.standard_normal((hit.size, 6))


def back(readings: Readings, ticks: slice) -> None:
    """A clock that is set back by 0.2 s, again and again."""
    for place in range(ticks.start, ticks.stop, 100):
        readings.time[place:] -= 0.2


def stuck_clock(readings: Readings, ticks: slice) -> None:
    readings.time[ticks] = readings.time[ticks.start]


def late(readings: Readings, ticks: slice) -> None:
    """Wrenches that come 30 ms too late."""
    readings.wrench[ticks] = readings.wrench[ticks.start - 6 : ticks.stop - 6] if ticks.start >= 6 else 0.0


def late_imu(readings: Readings, ticks: slice) -> None:
    """Attitude and gyroscope that come 15 ms too late."""
    for values in (readings.attitude, readings.rate):
        values[ticks] = values[ticks.start - 3 : ticks.stop - 3] if ticks.start >= 3 else 0.0


def dead(readings: Readings, ticks: slice) -> None:
    """A gyroscope that reads its noise alone."""
    size = readings.rate[ticks].shape
    readings.rate[ticks] = 1e-3 * np.random.default_rng(0).standard_normal(size)


def none(readings: Readings, ticks: slice) -> None:
    """What the numbers beside the faults are to be compared with."""


FAULTS: dict[str, Fault] = {
    "none": none,
    "NaN in the attitude": nan("attitude"),
    "NaN in the joints": nan("position"),
    "NaN in the wrenches": nan("wrench"),
    "NaN in the gyroscope": nan("rate"),
    "attitude frozen": frozen("attitude"),
    "gyroscope frozen": frozen("rate"),
    "gyroscope zero": times("rate", 0.0),
    "gyroscope only noise": dead,
    "gyroscope in deg/s": times("rate", 180 / np.pi),
    "gyroscope negative": times("rate", -1.0),
    "one wrench frozen": frozen("wrench", (0,)),
    "one torque channel frozen": frozen("wrench", (0, 4)),
    "one wrench zero": times("wrench", 0.0, (0,)),
    "one wrench's sign": times("wrench", -1.0, (0,)),
    "one wrench's torque sign": times("wrench", -1.0, (0, slice(3, 6))),
    "one wrench half": times("wrench", 0.5, (0,)),
    "spikes in one wrench": spiked,
    "wrenches 30 ms late": late,
    "IMU 15 ms late": late_imu,
    "ankle roll encoder frozen": frozen("position", (-1,)),
    "ankle pitch encoder frozen": frozen("position", (-2,)),
    "knee encoder frozen": frozen("position", (-3,)),
    "joints in degrees": times("position", 180 / np.pi),
    "time steps back": back,
    "time stands still": stuck_clock,
}


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--preset", default="sensors")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--first", type=int, default=100, help="seed")
    parser.add_argument("--faults", nargs="+", default=list(FAULTS), choices=FAULTS)
    told = parser.parse_args()
    preset, twin = preset_named(told.preset), twin_of("hrp2")
    seeds = range(told.first, told.first + told.seeds)
    everything = play_all(MOTIONS, twin.robot, twin.bushes, told.preset, seeds)
    logs = {seed: [one.log for one in recordings] for seed, recordings in zip(seeds, everything, strict=True)}
    for name in told.faults:
        burst = [_burst(twin, preset, seed, logs[seed], FAULTS[name]) for seed in seeds]
        whole = [_whole(twin, preset, seed, logs[seed], FAULTS[name]) for seed in seeds]
        said, again = float(np.mean([one[0] for one in burst])), max(one[1] for one in burst)
        print(
            f"{name:27} for {LAST:g} s: said at {100 * said:3.0f} % of the ticks, again itself after {again:4.2f} s, "
            f"{_worst([one[2] for one in burst])}; throughout: {_worst(whole)}",
            flush=True,
        )


Worst = tuple[bool, float, float]  # whether all was finite; K and C, half widths away at worst


def _worst(found: list[Worst]) -> str:
    finite = all(one[0] for one in found)
    words = [
        f"{name} {max(values):4.1f}{'!' if max(values) > BELIEVED else ''}"
        for name, values in (("K", [one[1] for one in found]), ("C", [one[2] for one in found]))
    ]
    return ", ".join(words) + " half widths off" + ("" if finite else ", NOT FINITE!")


def _burst(
    twin: Twin, preset: Preset, seed: int, logs: list[MotionLog], fault: Fault
) -> tuple[float, float, Worst]:
    faultless, broken = (
        FootEstimator(twin.robot, law(preset, seed, twin), wrench_delay=preset.sensors.wrench_delay)
        for _ in range(2)
    )
    after, said, again, worst = 0.0, list[float](), 0.0, (True, 0.0, 0.0)
    for place, log in enumerate(logs):
        good, bad = Readings.of(log, twin, after), Readings.of(log, twin, after)
        begin, end = round(BEGIN / log.period), round((BEGIN + LAST) / log.period)
        if place in BROKEN:
            fault(bad, slice(begin, end))
        right, rows = good.through(faultless), bad.through(broken)
        worst = _merged(worst, _believed(twin, preset, rows))
        after = max(good.time[-1], bad.time[-1]) + 1.0
        if place not in BROKEN:
            continue
        flags, usual = (one[:, :, FIELDS.index("flags")].astype(int) & SAID for one in (rows, right))
        said.append(float((flags[begin:end] != 0).any(axis=1).mean()))
        differs = ((flags & ~usual) != 0).any(axis=1)
        for axis in ROTATIONAL_AXES:
            column = FIELDS.index(f"{axis}.deflection")
            differs |= (np.abs(rows[:, :, column] - right[:, :, column]) > AWAY).any(axis=1)
        for spoilt in runs(differs):
            if spoilt.stop > end and (spoilt.stop - spoilt.start) * log.period > BLINK:
                again = max(again, (spoilt.stop - end) * log.period)
    return float(np.mean(said)), again, worst


def _whole(twin: Twin, preset: Preset, seed: int, logs: list[MotionLog], fault: Fault) -> Worst:
    estimator = FootEstimator(twin.robot, law(preset, seed, twin), wrench_delay=preset.sensors.wrench_delay)
    after, worst = 0.0, (True, 0.0, 0.0)
    for log in logs:
        readings = Readings.of(log, twin, after)
        fault(readings, slice(6 if fault in (late, late_imu) else 0, len(log)))
        worst = _merged(worst, _believed(twin, preset, readings.through(estimator)))
        after = readings.time[-1] + 1.0
    return worst


def _merged(one: Worst, other: Worst) -> Worst:
    return one[0] and other[0], max(one[1], other[1]), max(one[2], other[2])


def _believed(twin: Twin, preset: Preset, rows: np.ndarray) -> Worst:
    """How far what may be used is off, in half widths."""
    truth, k, c = on_the_floor(*twin, preset.name), 0.0, 0.0
    for place, foot in enumerate(twin.robot.feet):
        for row in rows[:: max(1, len(rows) // 20), place]:
            if not np.isfinite(row).all():
                continue
            found = foot_estimate(row)
            for axis in ROTATIONAL_AXES:
                one, right = getattr(found, axis), truth[foot]
                if not one.identified:
                    continue
                away = abs(one.stiffness.value - getattr(right, f"{axis}_stiffness"))
                k = max(k, away / one.stiffness.half_width)
                away, half = (
                    abs(one.damping.value - getattr(right, f"{axis}_damping")),
                    one.damping.half_width,
                )
                if half <= USABLE["damping"] * abs(one.damping.value):
                    c = max(c, away / half)
    return bool(np.isfinite(rows).all()), k, c


if __name__ == "__main__":
    main()
