"""Files on disk: whole or not at all when written, bounded and hashed when read."""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from plantar.errors import PlantarError

READ_BLOCK = 2**24  # bytes


@contextmanager
def atomic_write(path: str | os.PathLike[str]) -> Iterator[IO[bytes]]:
    """A binary handle whose content appears under `path` only when the block ends without an error."""
    target = Path(path)
    if target.is_dir():
        raise PlantarError("cannot be written: it is a folder", path=target, valid="the name of a file")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        descriptor, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.", suffix=".part")
    except OSError as error:
        raise PlantarError(f"cannot be written: {error.strerror}", path=target) from error
    temporary = Path(name)
    try:
        with os.fdopen(descriptor, "wb") as handle:
            yield handle
            handle.flush()
            os.fsync(handle.fileno())
        umask = os.umask(0)
        os.umask(umask)
        temporary.chmod(0o666 & ~umask)
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def write_text(path: str | os.PathLike[str], text: str) -> None:
    """Write UTF-8 text, whole or not at all."""
    with atomic_write(path) as handle:
        handle.write(text.encode())


def refuse_file(folder: Path) -> None:
    """PlantarError where a file stands in the place of a folder for results or above it, or where nothing may be
    written: said before the work, not after it."""
    there = next(part for part in (folder, *folder.absolute().parents) if os.path.lexists(part))
    if not there.is_dir():
        raise PlantarError("is a file", path=there, valid="a folder for the results")
    if not os.access(there, os.W_OK):
        raise PlantarError("may not be written to", path=there, valid="a folder of your own")


def sha256(path: str | os.PathLike[str]) -> str:
    """The file's SHA-256 as lower-case hex."""
    with open(path, "rb") as handle:
        return hashlib.file_digest(handle, "sha256").hexdigest()


def read_bounded(
    path: str | os.PathLike[str],
    limit: int,
    error: type[PlantarError] = PlantarError,
    valid: str = "a smaller file",
) -> bytes:
    """The file's bytes, or `error` when it is missing, unreadable or longer than `limit` bytes; `valid`: what would be
    right."""
    try:
        with open(path, "rb") as handle:
            blocks, size = [], 0
            while size <= limit and (block := handle.read(min(READ_BLOCK, limit + 1 - size))):
                blocks.append(block)  # one read of `limit` bytes would ask for that much memory at once
                size += len(block)
            content = b"".join(blocks)
    except OSError as problem:
        raise error(f"cannot be read: {problem.strerror}", path=path) from problem
    if len(content) > limit:
        raise error(f"is larger than {limit} bytes", path=path, valid=valid)
    return content
