"""Where files of a fleet lie: local paths and fsspec URLs (S3, GCS, SFTP, ...), read and written alike."""

from __future__ import annotations

import hashlib
import os
import posixpath
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path, PurePosixPath
from typing import Any, Final

from plantar.errors import PlantarError, needs
from plantar.files import READ_BLOCK, atomic_write

WHOLE_PUTS: Final = {"s3", "s3a", "gs", "gcs", "abfs", "abfss", "az", "memory"}
"""Stores whose objects appear when they are complete; elsewhere a file is renamed when it is."""
AT_ONCE: Final = 256  # objects that are asked for together: a store answers many questions in the time of one


class PlaceError(PlantarError):
    """Results cannot be written or read back: nothing that other logs would mend."""


@dataclass(frozen=True)
class Stamp:
    """What a listing says of a file: its size [bytes] and when it was changed, or its tag, as text."""

    size: int
    changed: str


def is_remote(place: str) -> bool:
    return "://" in place


def joined_place(beside: Path, place: str) -> str:
    """A place as a file names it: URLs and absolute paths as they are, others relative to that file."""
    return place if is_remote(place) else str(beside.parent / place)


def name_of(place: str) -> str:
    """The last part of a place."""
    return PurePosixPath(place.rstrip("/")).name if is_remote(place) else Path(place).name


def stamp_of(place: str) -> Stamp:
    """Size and change of a log, a file or a folder. PlantarError where it is not there."""
    if is_remote(place):
        system, path = _system(place)
        try:
            known = system.info(path)
            if known["type"] == "directory":
                parts = sorted(system.find(path, detail=True).values(), key=lambda part: str(part["name"]))
                return Stamp(sum(part["size"] or 0 for part in parts), _digest(map(_change, parts)))
            return Stamp(int(known["size"] or 0), _change(known))
        except Exception as error:
            raise _unreadable(place, error) from error
    try:
        own = Path(place).stat()
        if not Path(place).is_dir():
            return Stamp(own.st_size, str(own.st_mtime_ns))
        stats = [part.stat() for part in sorted(Path(place).rglob("*")) if part.is_file()]
        return Stamp(sum(s.st_size for s in stats), _digest(str(s.st_mtime_ns) for s in stats))
    except OSError as error:
        raise _unreadable(place, error) from error


def found_at(pattern: str) -> list[str]:
    """The URLs that a URL with wildcards names, in order. PlantarError where its store cannot be listed."""
    system, path = _system(pattern)
    try:
        return [str(system.unstrip_protocol(found)) for found in sorted(system.glob(path))]
    except Exception as error:
        raise _unreadable(pattern, error) from error


def time_of(place: str) -> datetime:
    """When a file was last changed, UTC. PlantarError where it is not there, or its store does not tell."""
    try:
        if not is_remote(place):
            return datetime.fromtimestamp(int(Path(place).stat().st_mtime), UTC)
        system, path = _system(place)
        changed: datetime = system.modified(path)
        return changed.astimezone(UTC).replace(microsecond=0)
    except Exception as error:
        raise _unreadable(place, error) from error


def brought(place: str, folder: Path) -> Path:
    """The file or folder at `place` on this machine: itself, or a copy of the same name in `folder`."""
    if not is_remote(place):
        if not Path(place).exists():
            raise PlantarError("does not exist", path=place)
        return Path(place)
    system, path = _system(place)
    target = folder / name_of(place)
    try:
        system.get(path, str(target), recursive=bool(system.isdir(path)))
    except Exception as error:
        raise _unreadable(place, error) from error
    return target


def content_sha256(path: Path) -> str:
    """SHA-256 of a file; of a folder, of its files' names and contents. PlantarError where one cannot be read."""
    try:
        if path.is_file():
            with open(path, "rb") as handle:
                return hashlib.file_digest(handle, "sha256").hexdigest()
        digest = hashlib.sha256()
        for part in sorted(part for part in path.rglob("*") if part.is_file()):
            digest.update(f"{part.relative_to(path).as_posix()}\0{part.stat().st_size}\0".encode())
            with open(part, "rb") as handle:
                while block := handle.read(READ_BLOCK):
                    digest.update(block)
        return digest.hexdigest()
    except OSError as error:
        raise _unreadable(str(path), error) from error


@dataclass(frozen=True)
class Store:
    """A folder for results, local or a URL. Files in it are whole or not there.

    Every method raises `PlaceError` where the folder cannot be used.
    """

    place: str

    def path(self, name: str) -> str:
        """Where a file of the folder lies."""
        return posixpath.join(self.place, name) if is_remote(self.place) else str(Path(self.place, name))

    def write(self, name: str, content: bytes) -> None:
        try:
            if not is_remote(self.place):
                with atomic_write(self.path(name)) as handle:
                    handle.write(content)
                return
            system, path = _system(self.path(name))
            if set(_protocols(system)) & WHOLE_PUTS:
                system.pipe_file(path, content)
                return
            system.makedirs(posixpath.dirname(path), exist_ok=True)
            part = f"{path}.{os.getpid()}.part"
            system.pipe_file(part, content)
            system.mv(part, path)
        except Exception as error:
            raise self._unusable("cannot be written", name, error) from error

    def read(self, name: str) -> bytes | None:
        """A file's content; None where there is none."""
        return next(self.read_each([name]))

    def read_each(self, names: Sequence[str]) -> Iterator[bytes | None]:
        """The contents of files in their order, a few in memory at a time; None for one that is not there."""
        for start in range(0, len(names), AT_ONCE):
            yield from self._batch(names[start : start + AT_ONCE])

    def names(self, folder: str) -> list[str]:
        """All files below one folder of this one, in order, as `read` takes them."""
        try:
            if not is_remote(self.place):
                root = Path(self.place)
                files = (path for path in (root / folder).rglob("*") if path.is_file())
                return sorted(path.relative_to(root).as_posix() for path in files)
            system, path = _system(self.path(folder))
            system.invalidate_cache()
            root = system._strip_protocol(self.place)
            return sorted(posixpath.relpath(found, root) for found in system.find(path))
        except FileNotFoundError:
            return []
        except Exception as error:
            raise self._unusable("cannot be listed", folder, error) from error

    def _batch(self, names: Sequence[str]) -> list[bytes | None]:
        if not is_remote(self.place):
            return [self._local(name) for name in names]
        try:
            system, root = _system(self.place)
            paths = [posixpath.join(root, name) for name in names]
            found = system.cat(paths, on_error="return") if paths else {}
        except Exception as error:
            raise self._unusable("cannot be read", names[0], error) from error
        contents: list[bytes | None] = []
        for name, path in zip(names, paths, strict=True):
            content = found[path]
            if isinstance(content, Exception) and not isinstance(content, FileNotFoundError):
                raise self._unusable("cannot be read", name, content) from content
            contents.append(None if isinstance(content, Exception) else content)
        return contents

    def _local(self, name: str) -> bytes | None:
        try:
            return Path(self.place, name).read_bytes()
        except (FileNotFoundError, NotADirectoryError):
            return None
        except OSError as error:
            raise self._unusable("cannot be read", name, error) from error

    def _unusable(self, what: str, name: str, error: Exception) -> PlaceError:
        if isinstance(error, PlantarError):
            return PlaceError(str(error))
        reason = getattr(error, "strerror", None) or str(error) or type(error).__name__
        return PlaceError(f"{what}: {reason}", path=self.path(name))


def _system(place: str) -> tuple[Any, str]:
    """The file system of a URL and the path in it."""
    with needs("fsspec", "fleet", place):
        import fsspec
    try:
        system, path = fsspec.core.url_to_fs(place)
    except ImportError as error:
        raise PlantarError(f"needs a package: {error}", path=place) from error
    except Exception as error:  # each store's package has errors of its own
        raise _unreadable(place, error) from error
    return system, str(path)


def _protocols(system: Any) -> tuple[str, ...]:
    protocol = system.protocol
    return (protocol,) if isinstance(protocol, str) else tuple(protocol)


def _change(known: dict[str, Any]) -> str:
    """When a remote file was changed, or its tag, whichever its system tells."""
    keys = ("ETag", "etag", "md5Hash", "LastModified", "mtime", "updated", "created")
    return next((str(known[key]) for key in keys if known.get(key)), "")


def _digest(texts: Iterator[str]) -> str:
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()


def _unreadable(place: str, error: Exception) -> PlantarError:
    if isinstance(error, PlantarError):
        return error
    if isinstance(error, FileNotFoundError):
        return PlantarError("does not exist", path=place)
    reason = getattr(error, "strerror", None) or str(error) or type(error).__name__
    return PlantarError(f"cannot be read: {reason}", path=place)
