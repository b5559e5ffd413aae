"""Outputs as they were when somebody last looked at them: files beside the tests, compared number by number.

A change that is meant is written anew with `PLANTAR_KEEP=1 pytest FILE`, and read in the diff of the kept files.
"""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Collection, Mapping
from dataclasses import fields, is_dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np

NUMBER = re.compile(r"(?<![\w.])[-+−]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def assert_as_kept(text: str, kept: Path, *, share: float = 1e-6, least: float = 1e-9) -> None:
    """The text is that of the file: its words exactly, its numbers within a `share` of each, and `least`; of whatever
    version of plantar."""
    text = re.sub(r"plantar \d+\.\d+\.\d+", "plantar VERSION", text)
    if os.environ.get("PLANTAR_KEEP"):
        kept.parent.mkdir(exist_ok=True)
        kept.write_text(text, encoding="utf-8")
    wanted = kept.read_text(encoding="utf-8")
    for line, other in zip_longest(text.splitlines(), wanted.splitlines(), fillvalue=""):
        apart = f"{line.strip()}\nin {kept.name}: {other.strip()}"
        assert NUMBER.sub("0", line).split() == NUMBER.sub("0", other).split(), apart
        for found, told in zip(NUMBER.findall(line), NUMBER.findall(other), strict=True):
            value, expected = (float(one.replace("−", "-")) for one in (found, told))
            assert abs(value - expected) <= share * abs(expected) + least, apart


def lines_of(content: Mapping[str, Any], *left_out: str) -> str:
    """A result's content, one line a row and each number to nine digits, without the keys that are `left_out`."""
    lines = []
    for key, value in content.items():
        rows = value if isinstance(value, list) else [value]
        lines += [f"{key}: {json.dumps(_shortened(row, left_out))}" for row in rows if key not in left_out]
    return "".join(f"{line}\n" for line in lines)


def _shortened(value: Any, left_out: Collection[str]) -> Any:
    if isinstance(value, float):
        return float(f"{value:.9g}") if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {key: _shortened(one, left_out) for key, one in value.items() if key not in left_out}
    return [_shortened(one, left_out) for one in value] if isinstance(value, list | tuple) else value


def described(value: Any, name: str = "") -> str:
    """Whatever holds numbers and texts, a line for each: fields and items by name, long arrays by what sums them up."""
    if isinstance(value, np.ndarray) and value.dtype.kind in "fiub" and value.size > 6:
        flat = value.astype(float).ravel()
        known = np.flatnonzero(np.isfinite(flat))
        some = flat[known]
        sums = [some @ np.cos(known), np.sqrt(np.mean(some**2)), some[0], some[-1]] if some.size else []
        return f"{name} {value.shape}: {known.size}; {', '.join(f'{one:.8g}' for one in sums)}\n"
    if isinstance(value, np.ndarray):
        return f"{name}: {_shortened(value.tolist(), ())}\n"
    if is_dataclass(value):
        items = [(each.name, getattr(value, each.name)) for each in fields(value)]
    elif hasattr(value, "_asdict"):
        items = [*value._asdict().items()]
    elif isinstance(value, Mapping):
        items = [*value.items()]
    elif isinstance(value, list | tuple | set | frozenset):
        items = [*enumerate(value if isinstance(value, list | tuple) else sorted(value))]
    else:
        return f"{name}: {_shortened(float(value) if isinstance(value, np.number) else value, ())}\n"
    return "".join(described(one, f"{name}.{key}" if name else str(key)) for key, one in items)
