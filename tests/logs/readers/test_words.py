"""What readers say of files, maps and roles that they cannot use, or not in whole: every line, as it is kept."""

from __future__ import annotations

import gzip
import io
import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from kept_texts import assert_as_kept
from plantar.errors import LogError
from plantar.logs.inputs import check_names
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log
from plantar.logs.readers.column_map import apply, joint_order, ports
from plantar.logs.readers.ports import log_of_ports, port_columns
from plantar.logs.readers.read_limit import ReadLimit
from plantar.logs.readers.roles import role_columns
from plantar.logs.readers.streams import Stream, increasing, merge
from plantar.logs.readers.tables.csv_text import _Text
from plantar.logs.save import save_log
from plantar.notes import Note

KEPT = Path(__file__).parent / "kept"
PATH = Path("log.x")
NOTES = object()


def robot(columns: Any, joints: tuple[str, ...] = ("hip", "knee")) -> Any:
    return SimpleNamespace(
        columns=columns,
        path=Path("robot.yaml"),
        joint_names=joints,
        name="biped",
        feet={},
        imu=None,
        following_joints={},
    )


def said(act: Callable[..., object], *given: Any, **named: Any) -> str:
    """The error, or the notes where there is none: of a log, or those that took the place of NOTES."""
    notes: list[Note] = []
    try:
        found = act(*(notes if one is NOTES else one for one in given), **named)
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    if isinstance(found, MotionLog):
        notes = [*found.notes]
    return " | ".join(f"{note.code}, {note.severity}: {note.text}" for note in notes) or "nothing"


def test_maps_roles_and_ports(tmp_path: Path) -> None:
    table = {"t": np.arange(3.0), "a_angle": np.arange(3.0), "b": np.arange(3.0)}
    maps: list[Any] = [
        {"time": ""}, {"time": {"from": "t", "units": "s"}}, {"joint.a.position": "a_angle"}, {"time": ["t", "b"]},
        {"time": {"from": "t", "unit": "parsec"}}, {"time": "t", "imu.chest.orientation": "b"},
        {"time": "t", "imu.chest.orientation": {"from": ["b", "b", "b", "b"], "order": "zyx"}},
        {"time": "t", "imu.chest.angular_velocity": ["b", "b"]}, {"time": "t", "joint.a.position": ["b", "b"]},
        {"time": "t", "wrench.left.force": {"from": ["b", "b", "b"], "unit": "deg"}},
        {"time": "t", "joint.a.angle": "b"}, {"time": "t", "joint.a.position": "c"},
        {"time": "t", "joint.<joint>.position": "angle"},
        {"time": "t", "joint.<joint>.position": "<joint>_degrees"},
        {"time": "t", "joint.a.position": {"from": "b", "sign": 2}},
    ]  # fmt: skip
    lines = [said(apply, table, robot(one), PATH) for one in maps]
    lists: list[Any] = ["hip", ["hip", 3], ["hip", "hip"]]
    lines += [said(joint_order, robot({"joints": one})) for one in lists]
    entries: list[Any] = [
        {"q": 3}, {"q": {"unit": "deg"}}, {"q": {"role": "joints.position", "units": "deg"}},
        {"q": {"role": "joints.position", "joints": "hip"}}, {"q": {"role": "joints.position", "joints": ["a", "a"]}},
        {"q": {"role": "joints.position", "take": [3]}}, {"q": {"role": "joints.position", "take": [-1, 3]}},
        {"q": {"role": "joints.position", "sign": 0}},
    ]  # fmt: skip
    lines += [said(ports, robot({"ports": one})) for one in entries]
    lines.append(said(ports, robot({"ports": "q"})))
    roles = [
        ("joints.position", 3, None), ("joints.angle", 2, None), ("imu.chest.orientation.rpy", 4, None),
        ("imu.chest.orientation.wxyz", 3, None), ("imu.chest.angular_velocity", 2, "rad/s"),
        ("imu.chest.angular_velocity", 3, "rpm"), ("wrench.left", 6, "kN"), ("wrench.left", 5, None),
        ("wrench", 6, None),
    ]  # fmt: skip
    lines += [
        said(role_columns, role, np.zeros((2, count)), ("hip", "knee"), PATH, unit=unit)
        for role, count, unit in roles
    ]
    port: Any = SimpleNamespace(role="joints.position", take=None, joints=None, unit=None, sign=1.0)
    for count in (2, 3):
        lines.append(said(port_columns, port, np.zeros((4, count)), robot({}), PATH, NOTES))
    limit = ReadLimit(tmp_path, memory=2**20, files=[])
    data = {name: (np.arange(3.0), np.zeros((3, 2))) for name in "abc"}
    lines.append(said(log_of_ports, "log", limit, None, data, {}, None, NOTES))
    assert_as_kept("\n".join(lines).replace(str(tmp_path), "FOLDER") + "\n", KEPT / "words_of_maps.txt")


def test_streams_and_logs(tmp_path: Path) -> None:
    limit = ReadLimit(Path("walk.bag"), memory=2**20, files=[])
    ticks = np.arange(0.0, 1.0, 0.1)

    def stream(name: str, time: np.ndarray) -> Stream:
        return Stream(name, time, {f"joint.{name}.position": np.arange(float(time.size))})

    merged = [
        [], [stream("a", ticks[:1])], [stream("a", ticks), stream("b", 5 + ticks)],
        [stream("a", ticks), stream("b", 0.5 + ticks)], [stream("a", ticks), stream("b", 0.2 + ticks)],
        [stream("a", np.array([0.0, 1.0])), stream("b", np.array([0.4, 0.6]))],
    ]  # fmt: skip
    lines = [said(merge, one, limit, NOTES) for one in merged]
    for strays in (1, 6):
        time = np.arange(100.0)
        time[10 : 10 + 2 * strays : 2] = 3.0
        lines.append(said(increasing, stream("a", time), limit.path, NOTES))
    log = MotionLog("walk", ticks, {"joint.hip.position": np.full(10, np.nan), "joint.knee.position": ticks})
    lines.append(said(log.without_empty_joints))
    known = robot({}, ("knee", "neck"))
    lines += [f"{note.code}, {note.severity}: {note.text}" for note in log.joint_notes(known)]
    twice = MotionLog("walk", ticks, log.columns, path=tmp_path / "a.csv")
    for other in (twice, MotionLog("walk", ticks, log.columns, path=tmp_path / "b.csv")):
        lines.append(said(check_names, [twice, other]))
    assert_as_kept("\n".join(lines).replace(str(tmp_path), "FOLDER") + "\n", KEPT / "words_of_streams.txt")


def npz(path: Path, method: int, **arrays: bytes) -> None:
    with zipfile.ZipFile(path, "w", method) as archive:
        for name, content in arrays.items():
            archive.writestr(f"{name}.npy", content)


def npy(array: np.ndarray) -> bytes:
    out = io.BytesIO()
    np.save(out, array)
    return out.getvalue()


def test_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    texts = {
        "latin.csv": "time,joint.k\xfc.position\n0,1\n".encode("latin-1"), "twice.csv": b"time,time\n0,1\n1,2\n",
        "blank.csv": b"\n\n", "semicolons.csv": b"time;joint.k.position\n0,5;1\n1;2\n", "quote.csv": b'time,"a\n0,1\n',
        "plain.csv.gz": b"time,joint.k.position\n0,1\n", "stamp.csv": b"stamp,joint.k.position\n0,1\n1,2\n",
        "back.csv": b"time,joint.k.position\n" + b"".join(b"%d,1\n" % (n % 5) for n in range(20)),
        "step.csv": b"time,joint.k.position\n" + b"".join(b"%d,1\n" % n for n in (*range(9), 5, *range(9, 30))),
        "cut.csv.gz": gzip.compress(b"time,joint.k.position\n" + b"".join(b"%d,1\n" % n for n in range(5000)))[:-200],
        "not.npz": b"PK\x03\x04", "not.parquet": b"PAR1", "anne.bin": b"ANNA", "only.bin": b"ANNE",
        "not.mcap": b"\x89MCAP",
        "not.bag": b"#ROSBAG V1.2\n", "not.db3": b"SQLite format 3\0", "not.mat": b"\x89HDF", "odd.xyz": b"0 1 2\n",
    }  # fmt: skip
    for name, content in texts.items():
        Path(name).write_bytes(content)
    good, time = npy(np.zeros((3, 2))), npy(np.arange(3.0))
    knee = {"joint.k.position": time}
    npz(Path("bad.npz"), zipfile.ZIP_STORED, time=time, a=good[:-8], b=npy(np.zeros(4)), c=good, **knee)
    npz(Path("packed.npz"), zipfile.ZIP_BZIP2, time=time, **knee)
    npz(Path("none.npz"), zipfile.ZIP_DEFLATED, **knee)
    npz(Path("odd.npz"), zipfile.ZIP_DEFLATED, time=time, a=good)
    ticks = pa.array([0.0, 0.1, 0.2])
    tables = {
        "twice.parquet": ([ticks, ticks, ticks], ["time", "joint.a.position", "joint.a.position"]),
        "begun.parquet": ([ticks, ticks, pa.StructArray.from_arrays([ticks], ["x"])],
                          ["time", "joint.a.position", "joint.a.position.more"]),
        "words.parquet": ([ticks, pa.array(["a", "b", "c"])], ["time", "joint.a.position"]),
        "still.parquet": ([pa.array([0.0, 0.0, 0.0]), ticks], ["time", "joint.a.position"]),
    }  # fmt: skip
    for name, (arrays, names) in tables.items():
        pq.write_table(pa.Table.from_arrays(arrays, names), name)
    Path("folder").mkdir()
    found = [*texts, "bad.npz", "packed.npz", "none.npz", "odd.npz", *tables, "folder", "nowhere.csv"]
    text = "".join(f"{name}: {said(open_log, Path(name))}\n" for name in found)
    # What libraries say is theirs.
    theirs = r"(readable (?:NPZ|Parquet|gzip|MATLAB|sqlite3)[^:]*: ).*?(?= \(valid|$)"
    text = re.sub(theirs, r"\1REASON", text, flags=re.MULTILINE)
    assert_as_kept(text.replace(str(tmp_path), "FOLDER"), KEPT / "words_of_files.txt")


def test_what_a_bag_cannot_hold_is_told(tmp_path: Path) -> None:
    time = np.arange(5.0)
    moved = {f"joint.k.{what}": time for what in ("position", "acceleration")}
    (note,) = save_log(MotionLog("walk", time, moved), tmp_path / "walk.mcap")
    assert (note.code, note.severity) == ("columns_lost", "warning")
    assert note.text == "JointState holds no accelerations: 1 columns left out"
    with pytest.raises(LogError, match=r"^walk, t = -2 s: lies outside what a ROS stamp can hold$"):
        save_log(MotionLog("walk", time - 2, {"joint.k.position": time}), tmp_path / "before.mcap")
    with pytest.raises(LogError, match=r"^walk, t = 2147483648 s: lies outside what a ROS stamp can hold$"):
        save_log(MotionLog("walk", time + 2.0**31, {"joint.k.position": time}), tmp_path / "after.mcap")


def test_what_the_system_refuses_is_told_as_it_says_it(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r": cannot be read: Is a directory$"):
        list(_Text(tmp_path).blocks())


@pytest.mark.parametrize("ending", [".PARQUET", ".Csv", ".MCAP"])
def test_endings_in_capitals_are_known(ending: str, tmp_path: Path) -> None:
    time = np.arange(5.0)
    save_log(MotionLog("walk", time, {"joint.k.position": time**2}), tmp_path / f"walk{ending.lower()}")
    named = (tmp_path / f"walk{ending.lower()}").rename(tmp_path / f"WALK{ending}")
    np.testing.assert_array_equal(open_log(named).column("joint.k.position"), time**2)
