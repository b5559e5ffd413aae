"""Ways in which a recording gets mutilated: what `mutilated_logs.py` draws from.

A table is a dict from column name to values (N,), `time` among them. A mutilation takes the tables of one robot and a
random generator and gives the tables of one trial; where it does not apply (a log of 50 Hz thinned to 100) it gives
none.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from plantar.conventions import Array

Table = dict[str, Array]
Draw = np.random.Generator
One = Callable[[Table, Draw], Table | None]
Mutilation = Callable[[Sequence[Table], Draw], list[Table]]

HUGE = (1e6, -1e9, 1e15, 1e300, np.inf)
RATES = (3, 10, 25, 50, 100)  # Hz


def rows(table: Table, keep: Array | slice) -> Table:
    return {name: values[keep] for name, values in table.items()}


def with_values(table: Table, names: Sequence[str], values: Callable[[Array], Array]) -> Table:
    """The table with these columns changed."""
    return {name: values(column) if name in names else column for name, column in table.items()}


def channels(table: Table, part: str = "") -> list[str]:
    return [name for name in table if name != "time" and part in name]


def some(table: Table, rng: Draw, part: str = "", most: int = 5) -> list[str]:
    """One to `most` random columns whose name holds `part`."""
    names = channels(table, part) or channels(table)
    return list(rng.choice(names, size=min(len(names), int(rng.integers(1, most + 1))), replace=False))


def sensors(table: Table) -> list[str]:
    """The beginnings of the wrenches' names, one a foot."""
    return sorted({".".join(name.split(".")[:2]) + "." for name in channels(table, "wrench.")})


def piece(table: Table, rng: Draw, shortest: float, longest: float) -> slice:
    """Random consecutive rows that last between `shortest` and `longest` [s]."""
    time = table["time"]
    length = rng.uniform(shortest, longest)
    start = rng.uniform(time[0], max(time[0], time[-1] - length))
    return slice(*(int(place) for place in np.searchsorted(time, [start, start + length])))


def cut(shortest: float, longest: float) -> One:
    return lambda table, rng: rows(table, piece(table, rng, shortest, longest))


def few_rows(table: Table, rng: Draw) -> Table:
    start = int(rng.integers(len(table["time"]) - 40))
    return rows(table, slice(start, start + int(rng.choice([0, 1, 2, 3, 5, 9, 17, 30]))))


def thinned(rate: float) -> One:
    def thin(table: Table, _: Draw) -> Table | None:
        stride = round(1 / rate / float(np.median(np.diff(table["time"]))))
        return rows(table, slice(None, None, stride)) if stride > 1 else None

    return thin


def without_columns(table: Table, rng: Draw) -> Table:
    """A tenth of the columns gone, or all of one kind, or one foot's, one joint's, one leg's."""
    kinds = ("position", "velocity", "effort", "orientation", "angular_velocity", "linear_acceleration",
             "force.z", "torque.x", "imu.", "joint.", "wrench.", "leg_left", "l_hip", *sensors(table))  # fmt: skip
    present = [kind for kind in kinds if channels(table, kind)]
    if rng.random() < 0.3:
        gone = [name for name in channels(table) if rng.random() < 0.1]
    else:
        gone = channels(table, str(rng.choice(present)))
    return {name: values for name, values in table.items() if name not in gone}


def emptied(table: Table, names: Sequence[str], where: Array | slice) -> Table:
    def hole(values: Array) -> Array:
        changed = values.copy()
        changed[where] = np.nan
        return changed

    return with_values(table, names, hole)


def single_holes(table: Table, rng: Draw) -> Table:
    share = rng.choice([0.001, 0.01, 0.1, 0.5])
    return {name: values if name == "time" else np.where(rng.random(values.size) < share, np.nan, values)
            for name, values in table.items()}  # fmt: skip


def long_holes(table: Table, rng: Draw) -> Table:
    for _ in range(rng.integers(1, 4)):
        names = channels(table) if rng.random() < 0.5 else some(table, rng)
        table = emptied(table, names, piece(table, rng, 0.05, 4.0))
    return table


def foot_lost(table: Table, rng: Draw) -> Table | None:
    names = sensors(table)
    return emptied(table, channels(table, str(rng.choice(names))), slice(None)) if names else None


def foot_unloaded(table: Table, rng: Draw) -> Table | None:
    names = sensors(table)
    foot = str(rng.choice(names)) if names else ""
    return with_values(table, channels(table, foot), np.zeros_like) if names else None


def constant(table: Table, rng: Draw) -> Table:
    part = str(rng.choice(["torque.x", "torque.y", "force.z", "force", "position", "position"]))
    return with_values(table, some(table, rng, part, 2), lambda values: np.full_like(values, values[0]))


def level(table: Table, _: Draw) -> Table:
    return with_values(table, channels(table, "orientation"), lambda values: np.full_like(values, values[0]))


def jittered(table: Table, rng: Draw) -> Table:
    time = table["time"]
    share = rng.choice([0.05, 0.2, 0.45, 1.0])
    return {**table, "time": time + share * np.median(np.diff(time)) * rng.normal(size=time.size)}


def stepped_back(table: Table, rng: Draw) -> Table:
    time, at = table["time"].copy(), int(rng.integers(1, table["time"].size))
    time[at:] -= rng.choice([0.01, 0.5, 1e4, -0.5, -30.0, -1e6])
    return {**table, "time": time}


def disordered(table: Table, rng: Draw) -> Table:
    order = np.arange(table["time"].size)
    count = max(1, round(rng.choice([0.001, 0.008, 0.1]) * order.size))
    chosen = rng.choice(order.size - 1, size=count, replace=False)
    if rng.random() < 0.5:
        return rows(table, np.sort(np.concatenate([order, chosen])))
    order[chosen], order[chosen + 1] = order[chosen + 1], order[chosen]
    return rows(table, order)


def huge(table: Table, rng: Draw) -> Table:
    value = float(rng.choice(HUGE))

    def spoilt(values: Array) -> Array:
        where = rng.random(values.size) < rng.choice([1 / values.size, 0.01, 0.5])
        return np.where(where, value, values)

    return with_values(table, some(table, rng), spoilt)


def renamed(table: Table, _: Draw) -> Table:
    return {name.replace("joint.", "joint.robot/"): values for name, values in table.items()}


def scaled(table: Table, rng: Draw) -> Table:
    """One kind of channel in another unit, with another sign, or zero."""
    kind = str(
        rng.choice(["position", "force", "torque", "wrench", "angular_velocity", "orientation", "effort"])
    )
    factor = float(rng.choice([-1.0, 0.0, 1e-3, 57.3, 1e3]))
    return with_values(table, channels(table, kind), lambda values: factor * values)


def standing(table: Table, rng: Draw) -> Table:
    """A robot that stands as in the first row; sensors with a thousandth of the motion as noise, or with none."""
    time, noise = table["time"][:500], rng.choice([0.0, 1e-3])
    return {"time": time} | {
        name: np.nan_to_num(table[name][0] + noise * np.nanstd(table[name]) * rng.normal(size=time.size))
        for name in channels(table)
    }


def each(change: One) -> Mutilation:
    """The first table alone, changed."""

    def single(tables: Sequence[Table], rng: Draw) -> list[Table]:
        changed = change(tables[0], rng)
        return [] if changed is None else [changed]

    return single


def several_rates(tables: Sequence[Table], rng: Draw) -> list[Table]:
    """The first table, and it or another one with every n-th row."""
    other = tables[int(rng.integers(len(tables)))]
    return [tables[0], rows(other, slice(None, None, int(rng.choice([2, 3, 5, 10]))))]


def together(tables: Sequence[Table], rng: Draw) -> list[Table]:
    """The first table, one or two others, and a standing robot."""
    chosen = rng.choice(len(tables), size=min(len(tables), int(rng.integers(1, 3))), replace=False)
    return [tables[0], *(tables[place] for place in chosen if place), standing(tables[0], rng)]


def twice_mutilated(tables: Sequence[Table], rng: Draw) -> list[Table]:
    """Two or three mutilations of one table, one after another."""
    table = tables[0]
    for name in rng.choice(list(SINGLE), size=int(rng.integers(2, 4)), replace=False):
        if len(table["time"]) > 50 and len(table) > 1:
            table = SINGLE[str(name)](table, rng) or table
    return [table]


SINGLE: dict[str, One] = {
    "cut": cut(5.0, 12.0),
    "cut_short": cut(1.0, 5.0),
    "cut_to_a_fraction": cut(0.02, 1.0),
    "few_rows": few_rows,
    **{f"at_{rate}_hz": thinned(rate) for rate in RATES},
    "without_columns": without_columns,
    "single_holes": single_holes,
    "long_holes": long_holes,
    "empty_columns": lambda table, rng: emptied(table, some(table, rng), slice(None)),
    "foot_lost": foot_lost,
    "foot_unloaded": foot_unloaded,
    "constant": constant,
    "constant_orientation": level,
    "jittered": jittered,
    "stepped_back": stepped_back,
    "disordered": disordered,
    "huge": huge,
    "scaled": scaled,
    "renamed": renamed,
    "standing": standing,
}

MUTILATIONS: dict[str, Mutilation] = {
    "whole": lambda tables, _: [tables[0]],
    **{name: each(change) for name, change in SINGLE.items()},
    "several_rates": several_rates,
    "together": together,
    "twice_mutilated": twice_mutilated,
}
