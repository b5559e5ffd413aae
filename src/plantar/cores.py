"""Work that is the same for each log or foot, shared between the machine's cores.

Python runs one thread at a time, and what comes between long loops over samples is Python. So this process and copies
of it take one item after the other, whoever is free the next; a copy has all that this one has and hands back what it
found. Results are those of one core: every item is worked on by itself, by the same code. What a copy could not do, for
whatever reason, this process does again, so that an error is the first one, as if nothing had been shared.
"""

from __future__ import annotations

import gc
import os
import signal
import struct
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from typing import Any, TypeVar

from plantar.handed_back import hand_back, held_by, taken

TURN = struct.Struct("<q")
Found = TypeVar("Found")
Each = Callable[..., Iterable[Any]]  # `over_cores`, a pool's map, or the usual one


def usable_cores() -> int:
    """Cores that work may be shared between; 1 where this process cannot be copied.

    That is: on systems other than Linux, and beside other threads of Python, whose locks a copy would never see free.
    """
    if sys.platform != "linux" or threading.active_count() > 1:
        return 1
    return len(os.sched_getaffinity(0))


@contextmanager
def blas_on_one_core() -> Iterator[None]:
    """BLAS without threads of its own: on matrices of some columns they mostly wait for each other, and copies of this
    process fill the cores already."""
    if os.environ.get("OPENBLAS_NUM_THREADS") == "1":  # as in every command
        yield
        return
    from threadpoolctl import threadpool_limits  # it costs start-up

    with threadpool_limits(1, user_api="blas"):
        yield


def over_cores(
    function: Callable[..., Found],
    *items: Iterable[Any],
    cores: int | None = None,
    meanwhile: Callable[[], object] | None = None,
) -> list[Found]:
    """`list(map(function, *items))` on all cores.

    The function must not change what it is given, nor anything else that is read later. It may call this again, and has
    the cores then that are idle. cores: all that are usable if left out. meanwhile: called here once, before this
    process takes items. Raises what the function raises, of the first item that it does so for.

    Example:
        >>> over_cores(abs, [-3, 4])
        [3, 4]
    """
    rows = list(zip(*items, strict=True))
    found: dict[int, Found] = {}
    copies = list[_Copy]()
    with _idle_cores(cores) as idle, _turns(len(rows)) as turns:
        try:
            with suppress(OSError):  # no room for another process: this one has the more to do
                while len(copies) < len(rows) - 1 and idle.take():
                    copies.append(_Copy(function, rows, turns, idle))
            if meanwhile is not None:
                meanwhile()
            with suppress(Exception):  # it comes again below, unless an earlier item has one
                for place in turns:
                    found[place] = function(*rows[place])
            if copies:
                idle.give()  # this one's, until they are done
                for copy in copies:
                    found |= copy.found()
                idle.take()
        finally:
            for copy in copies:
                copy.end()
    return [found[place] if place in found else function(*row) for place, row in enumerate(rows)]


@contextmanager
def begun(function: Callable[[], Found]) -> Iterator[Callable[[], Found]]:
    """A function at work on another core while the block goes on: gives what waits for what it found.

    It must not change anything that is read later. Asked for, it raises what the function raises.
    """
    with _idle_cores() as idle:
        copy = None
        with suppress(OSError):  # no room for another process
            copy = _Copy(function, [()], iter([0]), idle) if idle.take() else None
        if copy is None:
            yield function
            return
        try:
            yield lambda: (copy.found() or {0: function()})[0]
        finally:
            copy.end()


class _Idle:
    """How many cores nobody is at work on: bytes in a pipe, which this process and all its copies share."""

    def __init__(self, count: int) -> None:
        self._from, self._to = os.pipe()
        os.set_blocking(self._from, False)
        os.write(self._to, bytes(count))

    def take(self) -> bool:
        """Whether there was one, which is the caller's now."""
        with suppress(BlockingIOError):
            return bool(os.read(self._from, 1))
        return False

    def give(self) -> None:
        """One more."""
        os.write(self._to, bytes(1))

    def close(self) -> None:
        os.close(self._from)
        os.close(self._to)


_IDLE: ContextVar[_Idle | None] = ContextVar("idle", default=None)


@contextmanager
def _idle_cores(cores: int | None = None) -> Iterator[_Idle]:
    """Those that work around this one leaves idle; without any around it, or with so many `cores` of its own, all but
    this one."""
    around = _IDLE.get()
    if around is not None and cores is None and usable_cores() > 1:
        yield around
        return
    idle = _Idle(max(0, (usable_cores() if cores is None else cores) - 1))
    before = _IDLE.set(idle)
    try:
        yield idle
    finally:
        _IDLE.reset(before)
        idle.close()


@contextmanager
def _turns(count: int) -> Iterator[Iterator[int]]:
    """The numbers below `count`, each for the first process that asks: copies share where they stand in one file."""
    if not hasattr(os, "memfd_create"):  # nor are there copies
        yield iter(range(count))
        return
    file = os.memfd_create("turns")
    try:
        os.write(file, b"".join(map(TURN.pack, range(count))))
        os.lseek(file, 0, os.SEEK_SET)
        yield (TURN.unpack(taken)[0] for taken in iter(lambda: os.read(file, TURN.size), b""))
    finally:
        os.close(file)


class _Copy:
    """A copy of this process that takes rows while there are `turns`: the places of rows."""

    def __init__(
        self,
        function: Callable[..., Any],
        rows: Sequence[tuple[Any, ...]],
        turns: Iterator[int],
        idle: _Idle,
    ) -> None:
        self._held = held_by([rows])
        self._file = os.memfd_create("plantar")
        self._process = os.fork()
        if self._process:
            return
        try:
            if signal.getsignal(signal.SIGINT) != signal.SIG_IGN:
                signal.signal(signal.SIGINT, signal.SIG_DFL)  # whoever interrupts stops both, and one says so
            gc.disable()  # it would touch every object, and so copy its memory
            found = {}
            with suppress(Exception):
                for place in turns:
                    found[place] = function(*rows[place])
            hand_back(found, self._held, self._file)
            idle.give()
            os._exit(0)
        finally:  # nothing that this process had begun is the copy's to end
            os._exit(1)

    def found(self) -> dict[int, Any]:
        """What it found, by place, once it has ended: nothing where it was stopped."""
        process, self._process = self._process, 0
        _, status = os.waitpid(process, 0)
        return taken(self._file, self._held) if status == 0 else {}

    def end(self) -> None:
        """Stop it where it is still at work, and give back what it took."""
        if self._process:
            os.kill(self._process, signal.SIGKILL)
            os.waitpid(self._process, 0)
        os.close(self._file)
