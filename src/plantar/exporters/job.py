"""What one export has to do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from plantar.exporters.bush import FootBush
from plantar.notes import Note


@dataclass(frozen=True)
class Job:
    """What a target is given: the feet, the result, the model to extend and where the file will stand."""

    result: Mapping[str, Any]
    feet: tuple[FootBush, ...]
    model: Path | None
    out: Path
    with_offset: bool
    remarks: tuple[Note, ...]  # what holds for every target, for the comment at the file's head
