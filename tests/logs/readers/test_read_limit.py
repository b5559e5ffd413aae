"""Logs that are larger inside than they may be: refused in one line, before memory is taken."""

from __future__ import annotations

import gzip
import io
import re
import sqlite3
import struct
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pa_parquet
import pytest

from biped import record, sway
from biped_robot import make_robot
from log_formats import WRITERS
from mcap_records import mcap_of_chunk
from plantar.errors import LogError, NoRoom
from plantar.logs.inputs import open_together
from plantar.logs.motion_log import MotionLog
from plantar.logs.readers import open_log, read_limit, robot_logger
from plantar.logs.readers.read_limit import (
    ReadLimit,
    machine_memory,
    shown,
    usual_memory,
)
from plantar.logs.readers.streams import Stream, merge
from plantar.logs.save import save_log

COLUMNS = 10000

h5py = pytest.importorskip("h5py")
msgpack = pytest.importorskip("msgpack")
zstandard = pytest.importorskip("zstandard")

PEAK = 600 * 2**20  # bytes of memory of a whole process that refuses a bomb: 150 million of them are imports
HEADER = b"time,joint.a.position,joint.b.position\n"


@pytest.fixture(scope="module")
def original() -> MotionLog:
    return record(sway("log", duration=1.0))


def refusal(path: Path, **limits: int) -> str:
    """The one line with which a log is refused; it names the file and what is valid."""
    with pytest.raises(LogError) as caught:
        open_log(path, **limits)
    message = str(caught.value)
    assert "\n" not in message
    assert path.name in message
    assert "valid: " in message
    return message


def csv_gz_bomb(path: Path) -> None:
    """15 gzip streams of 2**26 bytes of rows."""
    rows = gzip.compress(b"0,0,0\n" * (2**26 // 6))
    path.write_bytes(gzip.compress(HEADER) + 15 * rows)


def parquet_bomb(path: Path) -> None:
    """34 million rows of run lengths."""
    zeros = pa.array(np.zeros(2**22))
    table = pa.table(dict.fromkeys(("time", "joint.a.position", "joint.b.position"), zeros))
    with pa_parquet.ParquetWriter(path, table.schema, compression="zstd") as writer:
        for _ in range(8):
            writer.write_table(table)


def mcap_bomb(path: Path) -> None:
    """One chunk of 2**30 zeros."""
    packer = zstandard.ZstdCompressor().compressobj()
    packed = b"".join(packer.compress(bytes(2**24)) for _ in range(64)) + packer.flush()
    path.write_bytes(mcap_of_chunk(packed, 2**30))


@pytest.mark.parametrize(
    ("name", "write", "says"),
    [
        ("log.csv.gz", csv_gz_bomb, "unpacks to"),
        ("log.parquet", parquet_bomb, "33554432 rows x 3 columns"),
        ("log.mcap", mcap_bomb, "a chunk unpacks to"),
    ],
)
def test_a_small_file_that_holds_a_gigabyte(
    name: str, write: Callable[[Path], None], says: str, tmp_path: Path
) -> None:
    write(tmp_path / name)
    assert (tmp_path / name).stat().st_size < 5e6
    script = (
        "import resource, sys\n"
        "from pathlib import Path\n"
        "from plantar.errors import LogError\n"
        "from plantar.logs.readers import open_log\n"
        "try: open_log(sys.argv[1], memory=2**28)\n"
        "except LogError as error: print(error)\n"
        # Linux counts what the parent held when it forked into ru_maxrss; the status file does not.
        "status = Path('/proc/self/status')\n"
        "lines = status.read_text().splitlines() if status.exists() else []\n"
        "own = [int(line.split()[1]) for line in lines if line.startswith('VmHWM')]\n"
        "print(1024 * (own or [resource.getrusage(resource.RUSAGE_SELF).ru_maxrss])[0])\n"
    )
    command = [sys.executable, "-c", script, str(tmp_path / name)]
    said, peak = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    assert says in said
    assert name in said
    assert int(peak) < PEAK, said


@pytest.mark.parametrize("name", WRITERS)
def test_every_format_keeps_to_the_memory_given(name: str, original: MotionLog, tmp_path: Path) -> None:
    path, columns = WRITERS[name](original, tmp_path)
    robot = make_robot(tmp_path / "robot", columns=columns)
    size = open_log(path, robot).size
    assert len(open_log(path, robot, memory=3 * size)) > 1  # messages and stamps take more than their numbers
    with pytest.raises(LogError, match="more with --memory") as caught:
        open_log(path, robot, memory=size // 2)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["csv", "parquet", "npz", "mcap", "ros1_bz2", "ros1_lz4", "robot_logger"])
def test_every_format_keeps_to_what_its_size_allows(
    name: str, original: MotionLog, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, columns = WRITERS[name](original, tmp_path)
    robot = make_robot(tmp_path / "robot", columns=columns)
    monkeypatch.setattr(read_limit, "SMALL", 20_000)
    monkeypatch.setattr(read_limit, "RATIO", 0)
    with pytest.raises(LogError, match="from a file of"):
        open_log(path, robot)


def test_ten_minutes_that_hardly_change_are_read_however_small_their_file_is() -> None:
    limit = ReadLimit(Path("x"), memory=2**30, files=[])
    limit.numbers(600_000, 55)
    with pytest.raises(
        LogError,
        match=r"^x: holds 6000000 rows x 55 columns, 2\.64 GB as numbers \(valid: at most 268 MB from a "
        r"file of 0 bytes: 268 MB and 100 times its size\)$",
    ):
        limit.numbers(6_000_000, 55)


def test_the_usual_memory_is_a_quarter_of_what_the_process_may_use(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert usual_memory() == machine_memory() // 4
    monkeypatch.setattr(read_limit, "CONTROL_GROUP", tmp_path / "memory.max")
    whole = machine_memory()
    (tmp_path / "memory.max").write_text("max\n")
    assert machine_memory() == whole
    (tmp_path / "memory.max").write_text("1000000\n")
    assert machine_memory() == 1_000_000
    assert [shown(size) for size in (12, 3_400, 5_600_000, 7_800_000_000)] == [
        "12 bytes", "3.4 kB", "5.6 MB", "7.8 GB",
    ]  # fmt: skip


def test_logs_together_fit_as_one_would(original: MotionLog, tmp_path: Path) -> None:
    robot = make_robot(tmp_path / "robot")
    paths = [tmp_path / "a.parquet", tmp_path / "b.parquet"]
    for path in paths:
        save_log(original, path)
    assert len(open_together(paths, robot, int(2.1 * original.size))) == 2
    with pytest.raises(
        LogError,
        match=r"[ab]\.parquet: does not fit beside the other logs: 17\.8 kB too much \(valid: fewer logs "
        r"at a time, or more with --memory \(memory= in Python\)\)$",
    ):
        open_together(paths, robot, int(1.5 * original.size))


def test_a_log_may_take_what_those_before_it_leave(original: MotionLog, tmp_path: Path) -> None:
    robot = make_robot(tmp_path / "robot")
    paths = [tmp_path / "a.csv", tmp_path / "b.csv"]
    for path in paths:
        save_log(original, path)
    left = int(0.3 * original.size)
    with pytest.raises(NoRoom, match=f"b.csv: .*at most {re.escape(shown(left))}, or more with --memory"):
        open_together(paths, robot, original.size + left)


@pytest.mark.parametrize("count", [COLUMNS + 1, 2 * COLUMNS + 1])
def test_more_columns_than_any_log_has(count: int, tmp_path: Path) -> None:
    names = ["time", *(f"joint.{place}.position" for place in range(count - 1))]
    row = ",".join("0" * count)
    (tmp_path / "wide.csv").write_text(",".join(names) + f"\n{row}\n")
    (tmp_path / "wide.txt").write_text("\n".join([row, row, ""]))
    pa_parquet.write_table(pa.table(dict.fromkeys(names, pa.array([0.0]))), tmp_path / "wide.parquet")
    for ending in ("csv", "txt", "parquet"):
        message = refusal(tmp_path / f"wide.{ending}")
        assert "more than 10000 columns" in message or (
            ending == "parquet" and "more than 20000 columns" in message
        )
    if count > 2 * COLUMNS:
        assert "claims" in refusal(tmp_path / "wide.parquet"), "no memory was taken for what a list claims"


def test_a_slow_topic_of_many_columns_at_the_rate_of_a_fast_one(tmp_path: Path) -> None:
    fast = Stream("w", np.arange(100_000) * 1e-3, {"wrench.l.force.z": np.zeros(100_000)})
    slow = Stream("j", np.arange(0, 101, 50.0), {f"joint.{i}.position": np.zeros(3) for i in range(5000)})
    with pytest.raises(
        LogError,
        match=r"test_a_slow_topic_of_many_colu0: holds 100000 rows x 5001 columns, 4 GB as numbers "
        r"\(valid: at most 268 MB from a file of 0 bytes: 268 MB and 100 times its size\)$",
    ):
        merge([fast, slow], ReadLimit(tmp_path, memory=2**40), [])


@pytest.mark.parametrize("ending", ["csv", "csv.gz", "txt"])
def test_a_text_without_lines(ending: str, tmp_path: Path) -> None:
    for place, content in enumerate((b"0" * 2**24, HEADER + b"0," * 2**23, b" " * 2**24 + b"0")):
        path = tmp_path / f"line_{place}.{ending}"
        path.write_bytes(gzip.compress(content, 1) if ending == "csv.gz" else content)
        assert "one sample a line" in refusal(path)


def test_rows_of_another_length_by_the_million(tmp_path: Path) -> None:
    (tmp_path / "ragged.csv").write_bytes(HEADER + b"0\n" * 2_000_000)
    with pytest.raises(LogError, match=r"ragged\.csv: a row has 1 values where the header has 3: 0\.\.\. "):
        open_log(tmp_path / "ragged.csv")


def test_parquet_of_something_else_than_numbers_is_not_unpacked(tmp_path: Path) -> None:
    long = pa.DictionaryArray.from_arrays(pa.array(np.zeros(100_000, np.int32)), pa.array(["x" * 2**20]))
    lists = pa.ListArray.from_arrays(
        pa.array([0, 10**6, 10**6 + 1], pa.int32()), pa.array(np.zeros(10**6 + 1))
    )
    for name, table in (
        ("text", {"time": np.arange(1e5), "joint.a.position": long}),
        ("list", {"time": np.arange(2.0), "joint.a.position": lists}),
    ):
        path = tmp_path / f"{name}.parquet"
        pa_parquet.write_table(pa.table(table), path, store_schema=False)
        assert "column 'joint.a.position': holds " in refusal(path)


def test_npz_of_another_compression_is_left_out(tmp_path: Path) -> None:
    array = io.BytesIO()
    np.save(array, np.arange(4.0))
    with zipfile.ZipFile(tmp_path / "log.npz", "w", zipfile.ZIP_LZMA) as archive:
        archive.writestr("time.npy", array.getvalue())
        archive.writestr("joint.a.position.npy", array.getvalue())
    assert "'time': is missing" in refusal(tmp_path / "log.npz")


def test_hdf5_that_claims_or_unpacks_to_more(tmp_path: Path) -> None:
    def signal(name: str, **data: object) -> Path:
        path = tmp_path / f"{name}.mat"
        with h5py.File(path, "w") as file:
            group = file.create_group("robot_logger_device/joints_state/positions")
            group["timestamps"] = np.arange(4.0)
            group.create_dataset("data", dtype="f8", **data)
        return path

    assert "unpacks to 3.2 GB" in refusal(signal("claims", shape=(400_000_000, 1), chunks=(2**17, 1)))
    path = signal("chunk", shape=(4,), maxshape=(None,), chunks=(2**27,), compression="gzip")
    assert path.stat().st_size < 1e5
    assert "unpacks to 1.07 GB" in refusal(path)
    path = signal("names", shape=(4,))
    with h5py.File(path, "a") as file:
        group = file["robot_logger_device/joints_state/positions"]
        group.create_dataset("elements_names", shape=(10**9,), chunks=(2**17,), dtype="f8")
    with pytest.raises(
        LogError,
        match=r"names\.mat: is not a readable MATLAB 7\.3 file: elements_names holds more than 1000 "
        r"names$",
    ):
        open_log(path)
    for chunks, refused in ((1000, False), (1001, True)):
        with h5py.File(tmp_path / f"text_{chunks}.mat", "w") as file:
            text = file.create_dataset("text", (4, 1), "u2", maxshape=(None, 1), chunks=(chunks, 1))
            text[:, 0] = [ord(letter) for letter in "knee"]
            if refused:
                with pytest.raises(ValueError, match="too long"):
                    robot_logger._text(text)
            else:
                assert robot_logger._text(text) == "knee"


def test_mc_rtc_entries_that_grow(tmp_path: Path) -> None:
    def write(name: str, *entries: bytes) -> Path:
        path = tmp_path / f"{name}.bin"
        path.write_bytes(b"ANNE" + b"".join(struct.pack("<Q", len(entry)) + entry for entry in entries))
        return path

    lists = b"\x92\xc0\xdd" + struct.pack(">I", 5_000_000) + b"\x90" * 5_000_000
    assert "an entry of" in refusal(write("lists", lists))
    keys = [f"{place}_rateIn" for place in range(4000)]
    first = msgpack.packb([["t", *keys], [2, 0.0] + [8, [0, 0, 0]] * len(keys)])
    rest = [msgpack.packb([["t"] if k == 1 else None, [2, 1e-3 * k]]) for k in range(1, 4000)]
    assert "more than 10000 columns" in refusal(write("keys", first, *rest))
    wide = msgpack.packb([["t", "qIn"], [2, 0.0, 11, [0] * 4_000_000]])
    narrow = [msgpack.packb([None, [2, 1e-3 * k, 11, [0]]]) for k in range(1, 500)]
    with pytest.raises(
        LogError,
        match=r"width\.bin: does not name its 1 joints \(valid: columns\.joints in the robot file, in "
        r"the log's order\)$",
    ):
        open_log(write("width", wide, *narrow))


@pytest.mark.parametrize(
    "messages",
    [
        "CREATE VIEW messages AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x+1 FROM c)"
        " SELECT x AS timestamp, 1 AS topic_id, zeroblob(60000000) AS data FROM c",
        "CREATE TABLE messages(topic_id INTEGER, timestamp INTEGER, data BLOB AS (zeroblob(60000000)))",
    ],
    ids=["view", "column"],
)
def test_sqlite_rows_that_are_computed(messages: str, tmp_path: Path) -> None:
    connection = sqlite3.connect(tmp_path / "log.db3")
    connection.execute("CREATE TABLE topics(id INTEGER, name TEXT, type TEXT, serialization_format TEXT)")
    connection.execute(messages)
    connection.close()
    assert "'messages' is not a plain table" in refusal(tmp_path / "log.db3")


def test_stamps_and_samples_of_a_robot_logger_count_as_what_is_kept(tmp_path: Path) -> None:
    """Single-precision numbers are kept as doubles: 8 bytes of each of 100 stamps and 300 values."""
    with h5py.File(tmp_path / "log.mat", "w") as file:
        group = file.create_group("signal")
        group["timestamps"] = np.arange(100, dtype="f4")
        group["data"] = np.zeros((100, 3), "f4")
        for memory, fits in ((3200, True), (3199, False)):
            limit = ReadLimit(tmp_path / "log.mat", memory=memory)
            if fits:
                robot_logger._signal(group, "signal", limit)
                assert limit.unpacks_to - limit.left == 3200
            else:
                with pytest.raises(
                    LogError,
                    match=r"log\.mat: holds 3\.2 kB of samples or more \(valid: at most 3\.2 kB, or more with "
                    r"--memory \(memory= in Python\), or a shorter log\)$",
                ):
                    robot_logger._signal(group, "signal", limit)
