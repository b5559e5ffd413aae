"""Where the work is done: workers on this machine, or a Dask cluster that runs already."""

from __future__ import annotations

import asyncio
import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any, Final

from plantar.errors import PlantarError, needs
from plantar.fleet.places import is_remote

CONNECT: Final = 30  # s to wait for a scheduler

SMALL: Final = {
    "distributed.worker.profile.enabled": False,  # a call tree a second, kept for an hour
    "distributed.admin.log-length": 100,
    "distributed.admin.low-level-log-length": 100,
    "distributed.admin.system-monitor.gil.enabled": False,
}
"""Settings of Dask without which workers and driver grow with the time that they run."""


@contextmanager
def connected(workers: int | None, scheduler: str | None, memory: int | None) -> Iterator[Any]:
    """A `distributed.Client`, closed with the block.

    Args:
        workers: processes on this machine, one thread each; as many as there are cores where None.
        scheduler: the address of a running cluster, such as tcp://10.0.0.1:8786, instead of workers of our own.
        memory: bytes that a worker of our own may take before it is started again.

    Raises:
        MissingExtra: Dask is not installed. PlantarError: the scheduler does not answer.
    """
    with needs("distributed", "fleet", "plantar fleet run"):
        import dask
        from distributed import Client, LocalCluster
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # what matters of it is said in one line
    with dask.config.set(SMALL):
        if scheduler is not None:
            try:
                # A client that finds nobody is never closed: thrown away later, it may stop a new one's start.
                asyncio.run(_answer(scheduler))
            except (OSError, ValueError) as error:
                valid = "the address that `dask scheduler` prints, such as tcp://10.0.0.1:8786"
                raise PlantarError("no scheduler answers", value=scheduler, valid=valid) from error
            with Client(scheduler, timeout=CONNECT, set_as_default=False) as client:
                yield client
            return
        with (
            LocalCluster(
                n_workers=workers or os.cpu_count() or 1,
                threads_per_worker=1,
                processes=True,
                memory_limit="auto" if memory is None else memory,
                dashboard_address="127.0.0.1:0",
                silence_logs=logging.CRITICAL,
            ) as cluster,
            Client(cluster, set_as_default=False) as client,
        ):
            yield client


def seen_by_workers(place: str, scheduler: str | None) -> str:
    """A place as workers find it: those of a running cluster work in folders of their own, so paths are absolute."""
    return place if scheduler is None or is_remote(place) else os.path.abspath(place)


async def _answer(scheduler: str) -> None:
    """Open and close a connection. Raises OSError or ValueError where nobody is at that address."""
    from distributed.comm import connect

    connection = await connect(scheduler, timeout=CONNECT)
    await connection.close()


def worker_count(client: Any) -> int:
    """How many groups the cluster works on at a time now."""
    threads: dict[str, int] = client.nthreads()
    return max(1, sum(threads.values()))


def dashboard(client: Any) -> str | None:
    """Where Dask shows what it does; None where its pages are not installed."""
    link: str | None = client.dashboard_link
    return link if link and find_spec("bokeh") else None
