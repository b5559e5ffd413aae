"""A binary log as mc_rtc writes them, unpacked by hand."""

from __future__ import annotations

import struct
from pathlib import Path

import msgpack
import numpy as np
from scipy.spatial.transform import Rotation

from plantar.logs.save_mc_rtc import save_mc_rtc


def test_a_pose_is_the_world_in_the_body_and_the_body_s_place(tmp_path: Path) -> None:
    random = np.random.default_rng(0)
    time, positions = 0.005 * np.arange(3), random.normal(size=(3, 2))
    base = np.tile(np.eye(4), (3, 1, 1))
    base[:, :3, :3] = Rotation.random(3, random_state=0).as_matrix()
    base[:, :3, 3] = random.normal(size=(3, 3))
    save_mc_rtc(tmp_path / "log.bin", time, positions, base)
    data = (tmp_path / "log.bin").read_bytes()
    assert data[:4] == b"ANNE"
    at, entries = 4, []
    while at < len(data):
        (size,) = struct.unpack_from("<Q", data, at)
        entries.append(msgpack.unpackb(data[at + 8 : at + 8 + size]))
        at += 8 + size
    assert [keys for keys, _ in entries] == [["t", "qOut", "qIn", "ff"], None, None]
    for row, (_, (*_, kind, pose)) in enumerate(entries):
        assert kind == 18
        np.testing.assert_allclose(np.reshape(pose[:9], (3, 3)), base[row, :3, :3].T)
        np.testing.assert_allclose(pose[9:], base[row, :3, 3])
    for row, (_, values) in enumerate(entries):
        assert values[:2] == [11, time[row]]
        assert values[3] == values[5] == positions[row].tolist()
