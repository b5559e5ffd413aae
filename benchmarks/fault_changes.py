"""What faults do to a case's logs: changes of values, names, moments and rows, the same for any robot."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fault_case import Case, Change, Columns, Table, chosen
from plantar.conventions import Array


def altered(columns: Columns, values: Callable[[Array], Array]) -> Change:
    """Other values in some columns."""

    def change(case: Case) -> Case:
        names = chosen(case, columns)
        return case.with_tables(
            lambda table: {name: values(old) if name in names else old for name, old in table.items()}
        )

    return change


def scaled(columns: Columns, factor: float) -> Change:
    return altered(columns, lambda values: factor * values)


def shifted(columns: Columns, amount: float) -> Change:
    return altered(columns, lambda values: values + amount)


def stepped(columns: Columns, start: float, amount: float) -> Change:
    """Columns whose zero jumps by an amount at this share of each log."""
    return altered(columns, lambda values: values + amount * (np.arange(len(values)) >= start * len(values)))


def removed(columns: Columns) -> Change:
    def change(case: Case) -> Case:
        names = chosen(case, columns)
        return case.with_tables(
            lambda table: {name: values for name, values in table.items() if name not in names}
        )

    return change


def renamed(columns: Columns, new: Callable[[str], str]) -> Change:
    """Other names of some columns."""

    def change(case: Case) -> Case:
        names = chosen(case, columns)
        return case.with_tables(
            lambda table: {new(name) if name in names else name: values for name, values in table.items()}
        )

    return change


def exchanged(first: Columns, second: Columns) -> Change:
    """Two groups of columns, alike but for their names, carry each other's values."""

    def change(case: Case) -> Case:
        pairs = list(zip(sorted(chosen(case, first)), sorted(chosen(case, second)), strict=True))
        other = dict(pairs) | {b: a for a, b in pairs}
        return case.with_tables(lambda table: {name: table[other.get(name, name)] for name in table})

    return change


def late(*delays: tuple[Columns, float]) -> Change:
    """Groups of columns that report so late [s]; the rows before the last one has begun are cut."""

    def change(case: Case) -> Case:
        own = {name: delay for columns, delay in delays for name in chosen(case, columns)}
        longest = max(delay for _, delay in delays)

        def each(table: Table) -> Table:
            time = table["time"]
            begun = time >= time[0] + longest
            return {
                name: (np.interp(time - own[name], time, values) if name in own else values)[begun]
                for name, values in table.items()
            }

        return case.with_tables(each)

    return change


def one_after_another(*changes: Change) -> Change:
    def change(case: Case) -> Case:
        for each in changes:
            case = each(case)
        return case

    return change


def in_one_log(fault: Change) -> Change:
    """The fault in the second log alone, as where a driver was set otherwise on one day; in the only one, if it is."""

    def change(case: Case) -> Case:
        name = list(case.tables)[:2][-1]
        spoiled = fault(replace(case, tables={name: case.tables[name]}))
        return replace(case, tables={**case.tables, **spoiled.tables})

    return change


def from_the_middle_on(fault: Change) -> Change:
    """A fault of values in the second half of each log alone."""

    def change(case: Case) -> Case:
        spoiled = fault(case).tables

        def half(good: Array, bad: Array) -> Array:
            return np.where(np.arange(len(good)) < len(good) // 2, good, bad)

        tables = {
            name: {column: half(values, spoiled[name][column]) for column, values in table.items()}
            for name, table in case.tables.items()
        }
        return replace(case, tables=tables)

    return change


def late_at_times(columns: Columns, rows: int) -> Change:
    """Columns that are so many rows late for a second in every 2.4, as behind a network that is busy at times."""

    def put(values: Array) -> Array:
        number = np.arange(len(values))
        return values[np.maximum(number - rows * (np.sin(0.013 * number) > 0.3), 0)]

    return altered(columns, put)


def by_largest(columns: Columns, values: Callable[[Array, float], Array]) -> Change:
    """Other values in some columns, from these and the largest reading of each in any log."""

    def change(case: Case) -> Case:
        largest = {
            name: max(float(np.abs(table[name]).max()) for table in case.tables.values())
            for name in chosen(case, columns)
        }
        return case.with_tables(
            lambda table: {
                name: values(old, largest[name]) if name in largest else old for name, old in table.items()
            }
        )

    return change


def clipped(columns: Columns, share: float) -> Change:
    """Columns cut at a share of their largest reading."""
    return by_largest(columns, lambda values, most: np.clip(values, -share * most, share * most))


def bent(columns: Columns, share: float) -> Change:
    """Columns whose largest reading is too small by a share, as of an amplifier that bends."""
    return by_largest(columns, lambda values, most: values * (1 - share * (values / most) ** 2))


def in_steps(columns: Columns, share: float) -> Change:
    """Columns in steps of a share of their largest reading, as of a coarse converter."""
    return by_largest(columns, lambda values, most: share * most * np.round(values / (share * most)))


def overwritten(columns: Columns, start: float, stop: float, value: float | None = None) -> Change:
    """Columns that repeat a value between two shares of each log: the last one before it, or the one given."""

    def put(values: Array) -> Array:
        changed, (first, last) = values.copy(), (round(share * len(values)) for share in (start, stop))
        changed[first:last] = values[first] if value is None else value
        return changed

    return altered(columns, put)


def dropouts(columns: Columns, value: float, length: int = 40, every: int = 1000) -> Change:
    """`length` samples of every `every` replaced by a value."""
    return altered(columns, lambda values: np.where(np.arange(len(values)) % every < length, value, values))


def rows(keep: Callable[[Array], Array]) -> Change:
    """Only those rows of each log that `keep` (N,) bool of its time (N,) [s] names."""

    def each(table: Table) -> Table:
        kept = keep(table["time"])
        return {name: values[kept] for name, values in table.items()}

    return lambda case: case.with_tables(each)


def thinned(rate: float) -> Change:
    """Every n-th row, down to `rate` [Hz]."""
    return rows(lambda time: np.arange(len(time)) % max(1, round(1 / rate / np.median(np.diff(time)))) == 0)


def every_nth_held(columns: Columns, stride: int) -> Change:
    """Columns of a slower sensor, each value repeated until the next one comes."""
    return altered(columns, lambda values: np.repeat(values[::stride], stride)[: len(values)])


def low_passed(columns: Columns, cutoff: float, rate: float = 200.0) -> Change:
    """A sensor's own filter of first order [Hz], which makes it late."""
    return altered(columns, lambda values: first_order(values, 2 * np.pi * cutoff / rate))


def first_order(values: Array, step: float) -> Array:
    """Values (N, ...) behind a filter of first order, with this many of its time constants in a sample."""
    gain, state, found = 1 - np.exp(-step), values[0], np.empty_like(values)
    for place, value in enumerate(values):
        state = state + gain * (value - state)
        found[place] = state
    return found


def dead_below(columns: Columns, share: float) -> Change:
    """Readings below a share of the largest one are exactly nothing, as behind a driver's dead band."""
    return altered(
        columns, lambda values: np.where(np.abs(values) < share * np.abs(values).max(), 0.0, values)
    )


def with_hysteresis(columns: Columns, share: float) -> Change:
    """A sensor that follows only when it is off by a share of its largest reading."""
    return altered(columns, lambda values: _behind(values, share * float(np.abs(values).max())))


def _behind(values: Array, width: float) -> Array:
    """What follows values (N,) only when it is off by a width."""
    state, found = values[0], np.empty_like(values)
    for place, value in enumerate(values):
        state = min(max(state, value - width), value + width)
        found[place] = state
    return found


def with_play(positions: Columns, play: float) -> Change:
    """Encoders [rad] in a drive that has play; their velocities are those of what is read."""

    def change(case: Case) -> Case:
        names = chosen(case, positions)

        def each(table: Table) -> Table:
            table = dict(table)
            for name in names:
                table[name] = _behind(table[name], play / 2)
                stands = np.diff(table[name], prepend=np.nan) == 0
                velocity = name.replace(".position", ".velocity")
                table[velocity] = np.where(stands, 0.0, table[velocity])
            return table

        return case.with_tables(each)

    return change


def lost_frames(columns: Columns, share: float, length: int) -> Change:
    """A bus that loses this share of its frames, up to `length` in a row: the last values are repeated."""

    def put(values: Array) -> Array:
        number = np.arange(len(values))
        # Starts that look as irregular as a bus' do, and are the same each time.
        starts = np.sin(1e4 * np.sin(number)) > np.cos(np.pi * share / length)
        lost = np.convolve(starts, np.ones(length))[: len(values)] > 0
        lost[0] = False
        return values[np.maximum.accumulate(np.where(lost, 0, number))]

    return altered(columns, put)


def timed(new: Callable[[Array], Array]) -> Change:
    """Another time column."""
    return lambda case: case.with_tables(lambda table: {**table, "time": new(table["time"])})


def drifting_clock(columns: Columns, rate: float) -> Change:
    """A sensor whose clock runs wrong by this share: ever later."""

    def change(case: Case) -> Case:
        names = chosen(case, columns)

        def each(table: Table) -> Table:
            time = table["time"]
            slow = time - rate * (time - time[0])
            return {n: np.interp(slow, time, values) if n in names else values for n, values in table.items()}

        return case.with_tables(each)

    return change


def shuffled(columns: Columns) -> Change:
    """Each column carries the values of the next one: names in another order than the data."""

    def change(case: Case) -> Case:
        names = sorted(chosen(case, columns))
        following = dict(zip(names, names[1:] + names[:1], strict=True))
        return case.with_tables(lambda table: {name: table[following.get(name, name)] for name in table})

    return change


def tared(columns: Columns) -> Change:
    """Sensors zeroed at each log's first sample, under load."""
    return altered(columns, lambda values: values - values[0])
