"""Walking over the records of a bag: messages handed to their topics, and what is said of a file that is hurt."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from plantar.logs.readers.read_limit import ReadLimit
from plantar.logs.readers.ros.layouts import IMU, JOINT_STATE, WRENCH, Encoding
from plantar.logs.readers.ros.topics import Topic
from plantar.notes import Note

MESSAGES = 2**16  # messages of a topic decoded at a time
READ = {JOINT_STATE, IMU, WRENCH}

# By channel: where its messages start and end, and when they came.
Found = dict[int, tuple[list[int], list[int], list[int]]]


class Scan:
    """Walks over records: learns channels, hands messages to their topics."""

    def __init__(self, path: Path, topics: dict[str, Topic], limit: ReadLimit, notes: list[Note]) -> None:
        self.path, self.topics, self.limit, self.notes = path, topics, limit, notes
        self.needed = 0  # bytes that the record at the end of a block wants
        self._channels: dict[int, Topic | None] = {}

    def note_cut(self) -> None:
        """The file ends within a record."""
        self._note("file_cut", " is cut; what is whole was read")

    def _lost(self) -> bool:
        """A record that cannot stand here: what follows is not in step either."""
        self._note("file_damaged", " is damaged; what comes before was read")
        return True

    def _broken(self, error: Exception) -> None:
        self._note("chunk_broken", f": a chunk is left out: {error}")

    def _note(self, code: str, text: str) -> None:
        self.notes.append(Note(code, "warning", f"{self.path.name}{text}"))

    def _open(self, channel: int, name: str, kind: str, encoding: Encoding) -> None:
        """What a channel's messages go to: the topic of its name, nothing where no reader wants its kind."""
        if kind not in READ:
            self._channels[channel] = None
            return
        topic = self.topics.get(name)
        if topic is None or topic.kind != kind or topic.encoding != encoding:
            topic = self.topics[name] = Topic(name, kind, encoding)
        self._channels[channel] = topic

    def _flush(self, data: bytes, found: Found) -> None:
        """Decode the messages found so far in `data`."""
        buffer = np.frombuffer(data, np.uint8)
        for channel, (starts, ends, received) in found.items():
            topic = self._channels.get(channel)
            if topic is not None:
                self.limit.hold(sum(ends) - sum(starts))
                topic.add(buffer, starts, ends, received)
        found.clear()
