"""Messages out as a ROS 2 bag in one MCAP file."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from plantar.errors import needs
from plantar.files import atomic_write

BLOCK = 2**22  # bytes copied at a time
Topic = tuple[str, str, Any]  # name, type, and its serialised messages: bytes, or rows of bytes


def ros_types() -> Any:
    """The message types of ROS 2 as rosbags has them. Raises MissingExtra without rosbags."""
    with needs("rosbags", "logs", "writing MCAP"):
        from rosbags.typesys import Stores, get_typestore
    return get_typestore(Stores.ROS2_HUMBLE)


def write_mcap(path: Path, topics: Sequence[Topic], stamps: Sequence[int]) -> None:
    """Write the bag, whole or not at all, in time's order, so that one that is cut is a shorter one.

    topics: each with one message for each of `stamps` [ns]. Raises MissingExtra without rosbags.
    """
    store = ros_types()
    from rosbags.rosbag2 import StoragePlugin, Writer

    with tempfile.TemporaryDirectory() as folder:
        bag = Path(folder) / "bag"
        with Writer(bag, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
            connections = [writer.add_connection(topic, kind, typestore=store) for topic, kind, _ in topics]
            for row, stamp in enumerate(stamps):
                for connection, (_, _, messages) in zip(connections, topics, strict=True):
                    writer.write(connection, stamp, bytes(messages[row]))
        with atomic_write(path) as handle, open(next(bag.glob("*.mcap")), "rb") as source:
            while block := source.read(BLOCK):
                handle.write(block)
