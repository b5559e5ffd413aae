"""ROS 2 bags in sqlite3: the tables `topics` and `messages` of rosbag2's default storage."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import numpy as np

from plantar.errors import LogError
from plantar.logs.readers.read_limit import BLOCK, ReadLimit
from plantar.logs.readers.ros.scan import MESSAGES, READ
from plantar.logs.readers.ros.topics import Topic
from plantar.notes import Note

MESSAGE_LIMIT = 64 * 2**20  # bytes of one message: those of sensors have some hundred


def read_sqlite(path: Path, topics: dict[str, Topic], limit: ReadLimit, notes: list[Note]) -> None:
    """Add the file's messages to `topics`. LogError when it is no bag; a note when it breaks off."""
    try:
        connection = sqlite3.connect(f"file:{_quoted(path)}?mode=ro&immutable=1", uri=True)
    except sqlite3.Error as error:
        raise LogError(f"is not a readable sqlite3 bag: {error}", path=path) from error
    connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, MESSAGE_LIMIT)
    try:
        _plain_tables(connection, path)
        channels = _channels(connection, topics)
        for identity, topic in channels.items():
            _messages(connection, identity, topic, limit, path, notes)
    except (sqlite3.Error, OverflowError, ValueError, TypeError) as error:
        if not any(topic.series for topic in topics.values()):
            valid = "a whole file; `sqlite3 FILE .recover | sqlite3 NEW` saves what a cut one holds"
            raise LogError(f"is not a readable sqlite3 bag: {error}", path=path, valid=valid) from error
        notes.append(
            Note("file_cut", "warning", f"{path.name} is damaged ({error}); what could be read was read")
        )
    finally:
        connection.close()


def _plain_tables(connection: sqlite3.Connection, path: Path) -> None:
    """LogError where the bag computes its rows: a view or a computed column may have no end."""
    for name in ("topics", "messages"):
        kinds = connection.execute("SELECT type FROM sqlite_master WHERE name = ?", (name,)).fetchall()
        query = "SELECT COUNT(*) FROM pragma_table_xinfo(?) WHERE hidden"
        hidden = connection.execute(query, (name,)).fetchone()
        if kinds not in ([], [("table",)]) or hidden != (0,):
            raise LogError(f"'{name}' is not a plain table", path=path, valid="a bag of rosbag2")


def _channels(connection: sqlite3.Connection, topics: dict[str, Topic]) -> dict[int, Topic]:
    query = "SELECT id, name, type, serialization_format FROM topics LIMIT 10000"
    rows = connection.execute(query).fetchall()
    found: dict[int, Topic] = {}
    for identity, name, kind, encoding in rows:
        plain = str(kind).replace("/msg/", "/")
        if plain in READ and encoding == "cdr" and isinstance(identity, int):
            found[identity] = topics.setdefault(str(name), Topic(str(name), plain, "cdr"))
    return found


def _messages(
    connection: sqlite3.Connection,
    identity: int,
    topic: Topic,
    limit: ReadLimit,
    path: Path,
    notes: list[Note],
) -> None:
    query = "SELECT timestamp, data FROM messages WHERE topic_id = ? ORDER BY timestamp"
    cursor = connection.execute(query, (identity,))
    while True:
        broken: sqlite3.Error | None = None
        rows: list[tuple[object, object]] = []
        try:
            size = 0
            while len(rows) < MESSAGES and size < BLOCK and (row := cursor.fetchone()) is not None:
                rows.append(row)
                size += len(row[1]) if isinstance(row[1], bytes | str) else 0
        except sqlite3.Error as error:
            broken = error
        whole = [(t, d) for t, d in rows if isinstance(t, int) and isinstance(d, bytes) and 0 <= t < 2**63]
        topic.broken += len(rows) - len(whole)
        topic.count += len(rows) - len(whole)
        if whole:
            ends = np.cumsum([len(data) for _, data in whole]).tolist()
            limit.hold(ends[-1])
            buffer = np.frombuffer(b"".join(data for _, data in whole), np.uint8)
            topic.add(buffer, [0, *ends[:-1]], ends, [stamp for stamp, _ in whole])
        if broken is not None:
            notes.append(Note("file_cut", "warning", f"{path.name}: {topic.name} breaks off: {broken}"))
        if broken is not None or not rows:
            return


def _quoted(path: Path) -> str:
    """The path inside a URI."""
    return str(path.resolve()).replace("%", "%25").replace("?", "%3f").replace("#", "%23")
