"""Results kept on disk under a hash of everything that they come from, so that none can be stale."""

from __future__ import annotations

import hashlib
import io
import os
import sys
import zipfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from importlib.metadata import version
from pathlib import Path

import numpy as np

from plantar._core import STEPPING_SOURCE
from plantar.conventions import Array
from plantar.errors import PlantarError
from plantar.files import atomic_write

LIMIT = 2 * 2**30  # bytes in the folder: the oldest files go first
PACKAGES = ("mujoco", "pin", "pin-pink", "qpsolvers", "daqp", "numpy", "scipy")
FILES = (
    "conventions.py",
    "contact/balance.py",
    "contact/polygon.py",
    "robot/model.py",
)  # what motions and twin run through


def folder() -> Path:
    """Where results are kept: `PLANTAR_CACHE`, or the platform's place for a user's caches."""
    if chosen := os.environ.get("PLANTAR_CACHE"):
        return Path(chosen)
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA", Path.home())) / "plantar" / "cache"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "plantar"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "plantar"


def key(*parts: str | Array) -> str:
    """Hash of what a result comes from, of the code that makes it and of the packages that this calls."""
    digest = hashlib.sha256(_code().encode())
    for part in parts:
        content = part.encode() if isinstance(part, str) else np.ascontiguousarray(part).tobytes()
        shape = "text" if isinstance(part, str) else f"{part.dtype}{part.shape}"
        digest.update(f"|{shape}:{len(content)}|".encode())
        digest.update(content)
    return digest.hexdigest()


def kept(name: str, make: Callable[[], Mapping[str, Array]]) -> Mapping[str, Array]:
    """The arrays kept under a key, else those of `make`, kept from now on: of all who ask at once, one makes them."""
    if (arrays := load(name)) is not None:
        return arrays
    with _one_at_a_time(name):
        if (arrays := load(name)) is not None:
            return arrays
        made = make()
        save(name, made)
        return made


def load(name: str) -> dict[str, Array] | None:
    """The arrays kept under a key, or None when there are none or the file is damaged."""
    path = folder() / f"{name}.npz"
    try:
        with np.load(path, allow_pickle=False) as kept:
            arrays = {field: kept[field] for field in kept.files}
        os.utime(path)
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None
    return arrays


def save(name: str, arrays: Mapping[str, Array]) -> None:
    """Keep arrays under a key; a folder that cannot be written keeps nothing."""
    content = io.BytesIO()
    np.savez(content, allow_pickle=False, **dict(arrays))
    try:
        with atomic_write(folder() / f"{name}.npz") as handle:
            handle.write(content.getbuffer())
        _prune(folder().glob("*.npz"))
    except (PlantarError, OSError):
        return


@contextmanager
def _one_at_a_time(name: str) -> Iterator[None]:
    """Threads and processes with the same key wait for each other, where the system locks files."""
    try:
        import fcntl

        folder().mkdir(parents=True, exist_ok=True)
        lock = open(folder() / f"{name}.lock", "wb")  # noqa: SIM115
    except (ImportError, OSError):
        yield
        return
    with lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        try:
            yield
        finally:
            Path(lock.name).unlink(missing_ok=True)
            fcntl.flock(lock, fcntl.LOCK_UN)  # copies of this process may hold the file, too


def _prune(files: Iterable[Path]) -> None:
    """Remove the files used longest ago until the rest fits."""
    room = LIMIT
    for file in sorted(files, key=lambda file: file.stat().st_mtime, reverse=True):
        room -= file.stat().st_size
        if room < 0:
            file.unlink(missing_ok=True)


@cache
def _code() -> str:
    """Hash of the source of everything that a plan or a rollout runs through, the native steps among it."""
    digest = hashlib.sha256(STEPPING_SOURCE.encode())
    for package in PACKAGES:
        digest.update(f"{package} {version(package)}\n".encode())
    root = Path(__file__).parents[1]
    rooms = [file for room in ("motions", "twin") for file in sorted((root / room).rglob("*.py"))]
    for source in (*rooms, *(root / path for path in FILES)):
        digest.update(source.relative_to(root).as_posix().encode() + b"\0" + source.read_bytes())
    return digest.hexdigest()
