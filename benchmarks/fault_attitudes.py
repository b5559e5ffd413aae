"""What faults do to an IMU's attitude, and to what it measures beside it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fault_case import Case, Change, Table
from fault_changes import first_order
from plantar.conventions import Array, rotation_from_quaternion


def reoriented(new: Callable[[Array], Array]) -> Change:
    """Other quaternions w x y z (N, 4)."""

    def change(case: Case) -> Case:
        names = [f"imu.{case.robot['imu']['name']}.orientation.{axis}" for axis in "wxyz"]
        return case.with_tables(
            lambda table: {**table, **dict(zip(names, new(np.column_stack([table[n] for n in names])).T, strict=True))}
        )  # fmt: skip

    return change


def gyroscope_in_world(case: Case) -> Case:
    """Angular velocity in the world's axes instead of the IMU's."""
    begin = f"imu.{case.robot['imu']['name']}"
    names = [f"{begin}.angular_velocity.{axis}" for axis in "xyz"]

    def each(table: Table) -> Table:
        turns = rotation_from_quaternion(
            np.column_stack([table[f"{begin}.orientation.{axis}"] for axis in "wxyz"])
        )
        rates = np.einsum("nij,nj->ni", turns, np.column_stack([table[n] for n in names]))
        return {**table, **dict(zip(names, rates.T, strict=True))}

    return case.with_tables(each)


def turned_heading(degrees: float) -> Change:
    """Another heading of the world: every quaternion turned about its vertical."""
    half = np.radians(degrees) / 2
    return reoriented(lambda q: _turned_in_world(np.array([[0.0, 0.0, np.sin(half)]]), q))


def pulled_to_accelerometer(rate: float) -> Change:
    """An attitude whose filter believes the accelerometer's vertical by a rate [1/s]: what accelerates tilts it."""

    def change(case: Case) -> Case:
        begin = f"imu.{case.robot['imu']['name']}"

        def each(table: Table) -> Table:
            q = np.column_stack([table[f"{begin}.orientation.{axis}"] for axis in "wxyz"])
            proper = np.column_stack([table[f"{begin}.linear_acceleration.{axis}"] for axis in "xyz"])
            up = np.einsum("nij,nj->ni", rotation_from_quaternion(q), proper)
            up /= np.linalg.norm(up, axis=1, keepdims=True)
            tilt = np.column_stack(
                [up[:, 1], -up[:, 0], np.zeros(len(up))]
            )  # which brings `up` to the vertical
            pulled = _turned_in_world(
                first_order(tilt, rate * float(np.median(np.diff(table["time"])))) / 2, q
            )
            return {
                **table,
                **{f"{begin}.orientation.{axis}": q for axis, q in zip("wxyz", pulled.T, strict=True)},
            }

        return case.with_tables(each)

    return change


def loose(angle: float, axis: int) -> Change:
    """An IMU that turns to and fro in its mount, by an angle [rad] about one of its axes, every few seconds."""

    def turn(table: Table, _: str) -> Array:
        time = table["time"]
        side = np.sign(np.sin(2 * np.pi * 0.21 * time) + np.sin(2 * np.pi * 0.083 * time + 1))
        return first_order(angle / 2 * side, 0.4)

    return _turning(turn, axis)


def on_soft_mount(tilt: float) -> Change:
    """An IMU whose mount lets it tilt about its y axis by so much [rad] for each m/s² along x."""

    def turn(table: Table, begin: str) -> Array:
        padded = np.pad(table[f"{begin}.linear_acceleration.x"], 10, mode="edge")
        return tilt * np.convolve(padded, np.full(21, 1 / 21), mode="valid")

    return _turning(turn, 1)


def _turning(turn: Callable[[Table, str], Array], axis: int) -> Change:
    """An IMU that turns in its mount about one of its axes: `turn` (N,) [rad] of a table and the IMU's prefix."""

    def change(case: Case) -> Case:
        begin = f"imu.{case.robot['imu']['name']}"

        def each(table: Table) -> Table:
            turned, rate = turn(table, begin), f"{begin}.angular_velocity.{'xyz'[axis]}"
            q = np.column_stack([table[f"{begin}.orientation.{each}"] for each in "wxyz"])
            about = rotation_from_quaternion(q)[:, :, axis]
            q = _turned_in_world(np.sin(turned / 2)[:, None] * about, q)
            orientation = {f"{begin}.orientation.{each}": own for each, own in zip("wxyz", q.T, strict=True)}
            return {**table, **orientation, rate: table[rate] + np.gradient(turned, table["time"])}

        return case.with_tables(each)

    return change


def _turned_in_world(half: Array, q: Array) -> Array:
    """Quaternions w x y z (N, 4) turned about the world's axes; half: sines of half the turns, (N, 3) or (1, 3)."""
    w, vector = q[:, :1], q[:, 1:]
    cosine = np.sqrt(1 - np.sum(half**2, axis=1, keepdims=True))
    turned = cosine * vector + w * half + np.cross(half, vector)
    return np.hstack([cosine * w - np.sum(half * vector, axis=1, keepdims=True), turned])
