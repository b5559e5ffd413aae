"""Channels that stop while others go on: a cable that comes off, a driver that repeats its last value, a full scale."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence

import numpy as np

from plantar.conventions import FORCE, GRAVITY, SURE, Array, Mask
from plantar.errors import clock
from plantar.logs.motion_log import MotionLog, wrench_columns
from plantar.notes import Finding
from plantar.robot.model import Foot, RobotModel
from plantar.signals.held import FEWEST, ONE_STEP, SHORTEST, can_be_held, coarse, held_in
from plantar.signals.resampling import GAP_PERIODS
from plantar.signals.segments import longest_run, runs

LOST_FRAMES = "lost_frames"
TURNED = 0.02  # rad by which a joint moves, or the same one of another leg, while its position stands still
STEPS = 5.0  # of a coarse encoder: likewise
LEAST_ELSEWHERE = 0.2  # of a run's length, for the rest of the log to show the velocity's bias
# Repeated in a row: fewer a sensor does that is a little slower than the log. Share of the log that is worth a word.
BURST, LOST = 3, 0.01
# s by which what is read is old in the mean: of K/C = 25 1/s damping is then off by a hundredth.
OLD = 4e-4
JUMPS = 5.0  # usual steps, of most channels behind a standstill: motions begin slowly, a logger that froze missed many


def check_channels(robot: RobotModel, log: MotionLog) -> Iterator[Finding]:
    """Columns of the IMU and of the wrenches that stand at one value for a while, joints that do while they turn.

    Columns of one sensor that stop together are one finding, and so are its frames that are lost again and again.
    Encoders read in steps: of one that stands for a while nothing can be said. Where nothing at all changes, a
    simulated robot without noise is at rest.
    """
    if robot.imu is None:
        return
    for name in sorted(loaded_path(robot, log)):
        yield from _dead_encoder(name, log)
    rest = _at_rest(log)
    if rest.any():
        longest = longest_run(rest)
        when = f"t = {clock(log.time[longest.start])} to {clock(log.time[longest.stop - 1])} s"
        text = f"{when}: nothing changes, as of a simulated robot at rest; {100 * np.mean(rest):.0f} % of the log"
        yield Finding("at_rest", f"{text}, left out", severity="info")
    for sensor in (
        f"imu.{robot.imu.name}.",
        *(f"wrench.{foot.wrench.name}." for foot in robot.feet.values()),
    ):
        yield from _stuck(sensor, log, rest)
        yield from _lost_frames(sensor, log, rest)


def loaded_path(robot: RobotModel, log: MotionLog) -> frozenset[str]:
    """Names of the joints between the IMU and any foot that carries load; none without IMU."""
    if robot.imu is None:
        return frozenset()
    loaded = [foot for foot in robot.feet.values() if _carries(robot, foot, log)]
    return frozenset().union(*(robot.joints_between(robot.imu.placement, foot.bush) for foot in loaded))


def named(columns: Sequence[str], sensor: str | None = None, of: int = 0) -> str:
    """Columns as a finding names them: one, several, or all `of` a sensor, which its columns begin with."""
    if sensor is not None and len(columns) == of > 1:
        return f"columns '{sensor}*'"
    return f"column{'s' * (len(columns) > 1)} {', '.join(map(repr, columns))}"


def _carries(robot: RobotModel, foot: Foot, log: MotionLog) -> bool:
    """Whether this foot carries a tenth of the weight or more, at least half of the time."""
    squares = sum(
        (log.column(name) ** 2 for name in wrench_columns(foot.wrench.name)[FORCE]), np.zeros(len(log))
    )
    return bool(np.mean(squares > (0.1 * robot.mass * GRAVITY) ** 2) > 0.5)


def _dead_encoder(joint: str, log: MotionLog) -> Iterator[Finding]:
    """A position that stands still while the recorded velocity turns on: its deflections would all be wrong.

    Fatal where the velocity is known to tell the joint's motion: it turns much further than it parts from the position
    elsewhere, and than its noise adds up to.
    """
    position, velocity = log.joint(joint, "position"), log.joint(joint, "velocity")
    if position is None or velocity is None:
        return
    steps, time = np.diff(position), np.diff(log.time)
    known = np.isfinite(steps) & (time < GAP_PERIODS * log.period)
    turns = np.where(known, np.nan_to_num(velocity[1:] + velocity[:-1]) * time / 2, 0.0)
    least = max(FEWEST, round(SHORTEST / log.period))
    held = [run for run in runs(known & (steps == 0)) if run.stop - run.start >= least]
    if not held:
        return
    parted, seconds = turns - np.where(known, steps, 0.0), np.where(known, time, 0.0)
    turned, run = max(((_turned(turns, parted, seconds, run), run) for run in held), key=lambda pair: pair[0])
    moving = np.abs(steps[known & (steps != 0)])
    coarse = float(np.median(moving)) if moving.size else 0.0
    if turned < max(TURNED, STEPS * coarse, SURE * _noise_path(turns[run])):
        return
    doubt = _elsewhere(parted, seconds, run)
    where = (
        f"column 'joint.{joint}.position', t = {clock(log.time[run.start])} to {clock(log.time[run.stop])} s"
    )
    text = f"{where}, value {position[run.start]:.6g}: stands still while its velocity turns {turned:.2g} rad"
    if turned > SURE * doubt:
        yield Finding("dead_channel", f"{text}; the encoder is dead (valid: leave such cells empty)", True)
    else:
        why = f"the velocity alone is off by {doubt:.2g} rad in such a time; is the encoder dead?"
        yield Finding("stuck_channel", f"{text}; {why} (valid: leave such cells empty)")


def _turned(turns: Array, parted: Array, seconds: Array, run: slice) -> float:
    """How far the velocity's `turns` (n,) [rad] lead within a run, as they are or less their usual bias: the less.

    The bias is what the velocity parts from the position by elsewhere. Where the run leaves hardly any elsewhere it is
    the velocity's mean: a constant turns nothing.
    """
    own = float(seconds[run].sum())
    others = float(seconds.sum()) - own
    if others > LEAST_ELSEWHERE * own:
        bias = float(parted.sum() - parted[run].sum()) / others
    else:
        bias = float(turns[run].sum()) / own
    return min(_reach(turns[run]), _reach(turns[run] - bias * seconds[run]))


def _reach(turns: Array) -> float:
    """The largest angle between two moments of a path of `turns` (n,)."""
    return float(np.ptp(np.concatenate([[0.0], np.cumsum(turns)])))


def _elsewhere(parted: Array, seconds: Array, run: slice) -> float:
    """How far the velocity usually parts from the position [rad] in stretches as long as `run` outside of it."""
    rest, times = np.delete(parted, run), np.delete(seconds, run)
    if times.sum() <= 0:
        return 0.0
    path = np.cumsum(rest - times * rest.sum() / times.sum())
    length = min(run.stop - run.start, len(path))
    stretches = path[: len(path) // length * length].reshape(-1, length)
    return float(np.median(np.ptp(stretches, axis=1)))


def _noise_path(turns: Array) -> float:
    """How far white noise of a velocity, as strong as these `turns` (n,) differ, would lead [rad].

    Neighbours share a reading, so that those next but one are compared: each is a mean of two, their difference has the
    deviation of one.
    """
    return float(np.std(turns[2:] - turns[:-2]) * np.sqrt(len(turns)))


def _at_rest(log: MotionLog) -> Mask:
    """Samples (N,) in stretches in which no column changes and behind which most do not jump."""
    columns = [log.column(name) for name in log.columns if name.startswith(("imu.", "wrench.", "joint."))]
    still, found = np.ones(len(log) - 1, dtype=bool), np.zeros(len(log), dtype=bool)
    for column in columns:
        still &= np.diff(column) == 0
        if not still.any():  # the first noisy one says it
            return found
    for run in runs(still):
        if run.stop - run.start >= max(FEWEST, round(SHORTEST / log.period)):
            found[run.start : run.stop + 1] = True
    stretches = runs(found)
    ends = [run.stop - 1 for run in stretches]
    apart = list[Array]()
    for column in columns if stretches else ():
        steps = np.append(np.abs(np.diff(column)), 0.0)
        if (steps > 0).any():
            apart.append(steps[ends] / np.median(steps[steps > 0]))
    for place, run in enumerate(stretches):
        if apart and np.median([own[place] for own in apart]) > JUMPS:
            found[run] = False
    return found


def _stuck(sensor: str, log: MotionLog, rest: Mask) -> Iterator[Finding]:
    """A finding for each stretch over which columns of this sensor stand still while they change elsewhere, or while
    others do."""
    columns = [column for column in log.columns if column.startswith(sensor) and can_be_held(column)]
    together: defaultdict[tuple[int, int], list[tuple[str, float]]] = defaultdict(list)
    for column in columns:
        held = held_in(log, column) & ~rest
        if held.any():
            longest = longest_run(held)
            together[longest.start, longest.stop - 1].append((column, float(np.mean(held))))
    for (start, last), found in together.items():
        stopped = [column for column, _ in found]
        several = len(stopped) > 1
        when = f"t = {clock(log.time[start])} to {clock(log.time[last])} s"
        value = "" if several else f", value {log.column(stopped[0])[start]:.6g}"
        still = "stand still while they change" if several else "stands still while it changes"
        share = f"{100 * max(share for _, share in found):.0f} % of the log, left out"
        asked = (
            "is the sensor dead or at its full scale?"
            if several
            else "is the channel dead or at its full scale?"
        )
        text = f"{named(stopped, sensor, len(columns))}, {when}{value}: {still} elsewhere, {share}; {asked}"
        yield Finding("stuck_channel", f"{text} (valid: leave such cells empty)")


def _lost_frames(sensor: str, log: MotionLog, rest: Mask) -> Iterator[Finding]:
    """A finding where all columns of a sensor repeat for some samples again and again, between others that are new.

    A sensor that is slower than its log repeats every reading, in longer stretches it is stuck, and zeros were put in.
    """
    columns = [column for column in log.columns if column.startswith(sensor) and can_be_held(column)]
    still = ~rest[1:]
    for column in columns:  # one after the other: together they would be half of the log
        still &= np.diff(log.column(column)) == 0
    if not still.any() or all(coarse(log.column(column)) for column in columns):
        return
    still &= np.any([log.column(column)[1:] != 0 for column in columns], axis=0)
    again = np.mean(still[1:][~still[:-1]]) if not still[:-1].all() else 1.0
    bursts = [run for run in runs(still) if (run.stop - run.start) * log.period < SHORTEST]
    bursts = _ending_in_jumps([log.column(column) for column in columns], bursts)
    lost = sum(run.stop - run.start for run in bursts)
    longest = max((run.stop - run.start for run in bursts), default=0)
    if again < 0.5 and longest >= BURST and lost > LOST * len(log):
        ages = [(run.stop - run.start) * (run.stop - run.start + 1) / 2 for run in bursts]
        old = log.period * float(np.sum(ages)) / len(log)
        spoilt = "Delays and damping are not sure " if old > OLD else ""
        text = (
            f"{named(columns, sensor, len(columns))}: repeat their last values again and again, up to "
            f"{1e3 * longest * log.period:.0f} ms at a time, {100 * lost / len(log):.0f} % of the log; does a bus lose "
            f"frames? {spoilt}(valid: leave such cells empty)"
        )
        yield Finding(LOST_FRAMES, text, severity="warning" if spoilt else "info")


def _ending_in_jumps(columns: Sequence[Array], bursts: Sequence[slice]) -> list[slice]:
    """Those of the `bursts` without a change behind which a column (n,) changes by more than a step of its scale: where
    none does, a converter's steps are larger than what little moved meanwhile."""
    ends = np.array([run.stop for run in bursts if run.stop < len(columns[0]) - 1], dtype=int)
    jumps = np.zeros(len(ends), dtype=bool)
    for column in columns:
        changes = np.abs(np.diff(column))
        moving = changes[changes > 0]  # nor NaN
        if moving.size:
            jumps |= changes[ends] > ONE_STEP * moving.min()
    return [run for run, jump in zip(bursts, jumps, strict=False) if jump]
