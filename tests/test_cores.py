"""Work shared between copies of the process: the same as on one core, whatever happens to a copy."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np
import pytest

from plantar import cores
from plantar.cores import begun, over_cores, usable_cores
from plantar.logs.motion_log import MotionLog

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="processes are copied on Linux")
HERE = os.getpid()


@contextmanager
def two_cores() -> Iterator[None]:
    """As on a machine of two, whatever this one has."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("plantar.cores.usable_cores", lambda: 2)
        yield


def log(seed: int) -> MotionLog:
    values = np.random.default_rng(seed).normal(size=(2, 500))
    columns = dict(zip(("joint.hip.position", "joint.knee.position"), values, strict=True))
    return MotionLog(f"log {seed}", np.arange(500.0), columns)


@pytest.mark.parametrize("cores", [1, 2, 3, 8])
def test_any_number_of_cores_finds_the_same_in_the_same_order(cores: int) -> None:
    logs = [log(seed) for seed in range(5)]
    found = over_cores(lambda one, by: one.select(slice(by, None)), logs, range(5), cores=cores)
    for by, (before, after) in enumerate(zip(logs, found, strict=True)):
        assert after.name == before.name
        assert after.time.tobytes() == before.time[by:].tobytes()
        for name, values in before.columns.items():
            assert after.columns[name].tobytes() == values[by:].tobytes()
            assert not after.columns[name].flags.writeable


def test_the_work_is_shared() -> None:
    def long(_: int) -> int:
        time.sleep(0.1)
        return os.getpid()

    processes = over_cores(long, range(4), cores=2)
    assert processes.count(HERE) == 2
    assert len({*processes}) == 2


def test_whoever_is_free_takes_the_next(tmp_path: Path) -> None:
    """A copy does all the others while this process is at its own work, or at a long item."""
    done = tmp_path / "done"

    def wait() -> None:
        while not done.exists():
            time.sleep(0.01)

    def work(item: int) -> int:
        if item == 3:
            done.touch()
        return os.getpid()

    processes = over_cores(work, range(4), cores=2, meanwhile=wait)
    assert len({*processes}) == 1
    assert HERE not in processes


def test_what_both_have_is_not_sent_back_but_is_the_same_object() -> None:
    logs = [log(seed) for seed in range(2)]
    found = over_cores(lambda one: (one, one.columns["joint.hip.position"], one.time + 1), logs, cores=2)
    for before, (same, column, new) in zip(logs, found, strict=True):
        assert same is before
        assert column is before.columns["joint.hip.position"]
        assert np.array_equal(new, before.time + 1)
        new += 1  # its own, and to be written


def test_arrays_keep_their_order_in_memory() -> None:
    """Sums over another order of memory round otherwise."""
    found = over_cores(lambda size: np.ones((3, size)).T, [4, 5], cores=2)
    assert all(one.flags.f_contiguous and not one.flags.c_contiguous for one in found)


def test_arrays_begin_where_memory_of_their_own_would() -> None:
    """At 64 bytes, whatever stands in front of them, where another process has made them."""

    def made(size: int) -> tuple[int, list[np.ndarray]]:
        time.sleep(0.002)  # so that the other process has its turn
        return os.getpid(), [np.arange(size + k, dtype=np.uint8) for k in range(3)]

    sizes = range(5, 205, 5)
    found = over_cores(made, sizes, cores=2)
    for size, (_, arrays) in zip(sizes, found, strict=True):
        assert [one.tolist() for one in arrays] == [list(range(size + k)) for k in range(3)]
    others = [one for process, arrays in found if process != HERE for one in arrays]
    assert others
    assert not any(one.ctypes.data % 64 for one in others)


@pytest.mark.parametrize("wrong", [{0}, {1}, {0, 1}, {1, 2}, {2, 3}, {3}])
def test_the_error_is_that_of_the_first_item(wrong: set[int]) -> None:
    def refuse(item: int) -> int:
        if item in wrong:
            raise ValueError(f"item {item}")
        return item

    with pytest.raises(ValueError, match=f"item {min(wrong)}"):
        over_cores(refuse, range(5), cores=2)


def test_what_a_copy_cannot_do_is_done_here() -> None:
    def killed(item: int) -> int:
        if os.getpid() != HERE:
            os.kill(os.getpid(), signal.SIGKILL)
        return item + 1

    assert over_cores(killed, range(4), cores=2) == [1, 2, 3, 4]
    generators = over_cores(lambda item: (item for _ in "a"), range(3), cores=2)  # nothing that can be sent
    assert [next(one) for one in generators] == [0, 1, 2]


def test_nothing_is_left_behind() -> None:
    def files() -> int:
        return len(os.listdir("/proc/self/fd"))

    def children() -> set[str]:
        """Other processes than copies may be children of this one: other tests begin some."""
        found = set()
        for status in Path("/proc").glob("[0-9]*/stat"):
            with suppress(OSError):  # it has ended
                if int(status.read_text().rpartition(")")[2].split()[1]) == os.getpid():
                    found.add(status.parent.name)
        return found

    before, family = files(), children()
    for _ in range(3):
        over_cores(abs, range(4), cores=3)
        with pytest.raises(TypeError):
            over_cores(abs, "abcd", cores=3)
    assert files() == before
    assert children() == family


def test_one_core_beside_threads_of_python_and_on_no_other_system(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(threading, "active_count", lambda: 1)
    assert usable_cores() == len(os.sched_getaffinity(0))
    monkeypatch.setattr(sys, "platform", "darwin")
    assert usable_cores() == 1
    monkeypatch.undo()
    done = threading.Event()
    thread = threading.Thread(target=done.wait)
    thread.start()
    assert usable_cores() == 1
    done.set()
    thread.join()


def test_an_interrupt_ends_all_processes_at_once() -> None:
    code = (
        "import os, signal, time\nfrom plantar.cores import over_cores\n"
        # A shell lets what it starts in the background ignore interrupts.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "def work(item):\n"
        "    os.write(1, b'%d\\n' % os.getpid())\n"
        "    time.sleep(60)\n"
        "try:\n    over_cores(work, range(2), cores=2)\n"
        "except KeyboardInterrupt:\n    print('interrupted', flush=True)\n"
    )
    command = [sys.executable, "-c", code]
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    assert process.stdout is not None
    ours = [int(process.stdout.readline()) for _ in range(2)]
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=30)
    assert (out, err) == ("interrupted\n", "")
    assert not any(Path(f"/proc/{one}").exists() for one in ours)


def test_work_inside_of_work_takes_no_core_that_is_busy(tmp_path: Path) -> None:
    """Both items of two processes are shared out again, and each of these finds that nobody is idle."""

    def inner(place: int) -> int:
        (tmp_path / str(place)).touch()
        while len(list(tmp_path.iterdir())) < 2:
            time.sleep(0.01)
        return os.getpid()

    def outer(place: int) -> list[int]:
        return over_cores(inner, [place, place])

    with two_cores():
        found = over_cores(outer, range(2))
    assert [len({*processes}) for processes in found] == [1, 1]


@pytest.mark.parametrize("short", [0, 1])
def test_work_inside_of_work_takes_a_core_that_has_nothing_left(short: int, tmp_path: Path) -> None:
    """Whichever of two items is soon done, in the copy or here, its core takes part in the other one."""

    def inner(_: int) -> int:
        time.sleep(0.05)
        return os.getpid()

    def outer(place: int) -> list[int]:
        while len(list(tmp_path.iterdir())) < 1 and place == short:
            time.sleep(0.01)
        (tmp_path / str(place)).touch()
        if place == short:
            return []
        time.sleep(0.5)
        return over_cores(inner, range(6))

    with two_cores():
        found = over_cores(outer, range(2))
    assert len({*found[1 - short]}) == 2


def test_what_is_begun_goes_on_beside_the_block(tmp_path: Path) -> None:
    """Neither waits for the other to end: each waits for what the other does in its middle."""

    def wait(path: Path) -> None:
        end = time.monotonic() + 30
        while not path.exists():
            assert time.monotonic() < end, path
            time.sleep(0.01)

    def work() -> int:
        (tmp_path / "begun").touch()
        wait(tmp_path / "block")
        return os.getpid()

    with two_cores(), begun(work) as found:
        wait(tmp_path / "begun")
        (tmp_path / "block").touch()
        assert found() != HERE


def test_what_is_begun_fails_where_it_is_asked_for() -> None:
    def fail() -> int:
        raise ValueError("no number")

    with two_cores(), begun(fail):
        pass
    with two_cores(), begun(fail) as found, pytest.raises(ValueError, match="no number"):
        found()


def test_what_is_begun_is_done_here_where_there_is_one_core(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("plantar.cores.usable_cores", lambda: 1)
    with begun(os.getpid) as found:
        assert found() == HERE


def test_what_nobody_waits_for_is_stopped(tmp_path: Path) -> None:
    def work() -> None:
        time.sleep(0.3)
        (tmp_path / "late").touch()

    with begun(work):
        pass
    time.sleep(0.5)
    assert not (tmp_path / "late").exists()


def test_work_that_is_given_cores_shares_none_with_the_work_around_it() -> None:
    with two_cores(), cores._idle_cores() as around:
        with cores._idle_cores() as within:
            assert within is around
        with cores._idle_cores(3) as own:
            assert own is not around
            assert [own.take() for _ in range(3)] == [True, True, False], "all but the one that is at work"
        assert [around.take() for _ in range(2)] == [True, False]
