"""What a cluster of our own is made of, and where its workers find a place."""

from __future__ import annotations

import os
from contextlib import contextmanager
from typing import Any

import pytest

from plantar.fleet.cluster import connected, dashboard, seen_by_workers, worker_count

distributed = pytest.importorskip("distributed")


@pytest.mark.parametrize(
    ("workers", "memory", "processes", "limit"),
    [(None, None, os.cpu_count(), "auto"), (3, 10**9, 3, 10**9)],
)
def test_workers_and_memory_reach_the_cluster(
    workers: int | None, memory: int | None, processes: int, limit: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: dict[str, Any] = {}

    @contextmanager
    def cluster(**options: Any) -> Any:
        asked.update(options)
        yield "ours"

    @contextmanager
    def client(which: str, **options: Any) -> Any:
        asked["client"] = which, options
        yield "client"

    monkeypatch.setattr(distributed, "LocalCluster", cluster)
    monkeypatch.setattr(distributed, "Client", client)
    with connected(workers, None, memory) as found:
        assert found == "client"
    assert (asked["n_workers"], asked["memory_limit"]) == (processes, limit)
    assert asked["threads_per_worker"] == 1, "one log at a time in each"
    assert asked["processes"]
    assert asked["dashboard_address"].startswith("127.0.0.1:")
    assert asked["client"] == ("ours", {"set_as_default": False})


def test_paths_are_absolute_where_workers_are_elsewhere() -> None:
    assert seen_by_workers("logs", None) == "logs"
    assert seen_by_workers("logs", "tcp://10.0.0.1:8786") == os.path.abspath("logs")
    assert seen_by_workers("s3://logs", "tcp://10.0.0.1:8786") == "s3://logs"


class Cluster:
    """What a client says of its cluster."""

    dashboard_link = "http://127.0.0.1:1/status"

    def __init__(self, *threads: int) -> None:
        self.threads = threads

    def nthreads(self) -> dict[str, int]:
        return {str(place): count for place, count in enumerate(self.threads)}


def test_a_cluster_works_on_as_many_groups_as_it_has_threads() -> None:
    assert [worker_count(Cluster(*threads)) for threads in ((), (1,), (2, 3))] == [1, 1, 5]


def test_pages_that_are_not_installed_have_no_address(monkeypatch: pytest.MonkeyPatch) -> None:
    for found, link in ((None, None), ("bokeh", Cluster.dashboard_link)):
        monkeypatch.setattr("plantar.fleet.cluster.find_spec", lambda name, found=found: found)
        assert dashboard(Cluster()) == link
