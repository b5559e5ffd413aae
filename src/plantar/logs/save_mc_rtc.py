"""A planned motion out: a binary log as mc_rtc writes them, whose outputs its Replay plugin plays."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Final

import numpy as np

from plantar.conventions import Array
from plantar.errors import needs
from plantar.files import atomic_write

MAGIC: Final = b"ANNE"  # version 0, which every mc_rtc reads
DOUBLE, POSE, VECTOR = 11, 18, 21
"""Types of mc_rtc's log entries: a number, a pose, a vector of numbers."""
# Where the Replay plugin looks: time, what the robot is told, what the encoders read, the floating base.
KEYS: Final = (("t", DOUBLE), ("qOut", VECTOR), ("qIn", VECTOR), ("ff", POSE))


def save_mc_rtc(path: Path, time: Array, positions: Array, base: Array) -> None:
    """Positions (N, n) [rad], in the order of the robot module's `ref_joint_order`, and poses of the floating base
    (N, 4, 4), at `time` (N,) [s].

    A pose is stored as the rotation from world to body, row by row, and then the place of the body in the world.
    Raises MissingExtra without msgpack.
    """
    with needs("msgpack", "logs", "writing mc_rtc logs"):
        import msgpack
    into_body = np.swapaxes(base[:, :3, :3], 1, 2).reshape(-1, 9)
    poses = np.hstack([into_body, base[:, :3, 3]]).tolist()
    keys = [key for key, _ in KEYS]
    with atomic_write(path) as handle:
        handle.write(MAGIC)
        for row, (moment, told, pose) in enumerate(
            zip(time.tolist(), positions.tolist(), poses, strict=True)
        ):
            values = zip(KEYS, (moment, told, told, pose), strict=True)
            typed = [part for (_, kind), value in values for part in (kind, value)]
            entry = msgpack.packb([None if row else keys, typed])
            handle.write(struct.pack("<Q", len(entry)) + entry)
