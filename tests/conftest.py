"""What every test may ask for."""

from __future__ import annotations

import os

# Small problems on few cores: threads inside threads only get in each other's way.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(variable, "1")

# Each of several processes of tests has a core: copies that share work would only be in the other one's way.
if (worker := os.environ.get("PYTEST_XDIST_WORKER", "")) and hasattr(os, "sched_setaffinity"):
    usable = sorted(os.sched_getaffinity(0))
    if int(os.environ["PYTEST_XDIST_WORKER_COUNT"]) >= len(usable):
        os.sched_setaffinity(0, {usable[int(worker.removeprefix("gw")) % len(usable)]})

from collections.abc import Iterator
from pathlib import Path

import pytest

from biped_robot import make_robot
from plantar.robot.model import RobotModel

# The longest files, which come first: one process would be at work on them alone when all else is done.
LONGEST = (
    "tests/docs/test_pages.py",
    "tests/campaign/test_demo.py",
    "tests/comparison/test_compare.py",
    "tests/whole_body/test_joints.py",
    "tests/online/test_library.py",
    "tests/test_front_door.py",
    "tests/whole_body/test_inertia.py",
    "tests/twin/simulation/test_rollout.py",
)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    items.sort(key=lambda item: not item.nodeid.startswith(LONGEST))


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """The folder of real recordings, which is no part of the project: PLANTAR_SHARED_DATA, or beside the repository."""
    beside = Path(__file__).resolve().parents[2] / "shared" / "data"
    folder = Path(os.environ.get("PLANTAR_SHARED_DATA", beside))
    if not folder.is_dir():
        pytest.skip(f"real recordings not found at {folder} (set PLANTAR_SHARED_DATA)")
    return folder


@pytest.fixture(scope="session", autouse=True)
def one_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """What the twin plans and plays is kept for this session, for all its processes; nobody's own cache is touched."""
    folder = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        folder = folder.parent
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PLANTAR_CACHE", str(folder / "twin-cache"))
        yield


@pytest.fixture(scope="session", autouse=True)
def no_power_cut() -> Iterator[None]:
    """What tests write need not be on the disk before they go on: that takes milliseconds a file."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", lambda _: None)
        yield


@pytest.fixture(scope="module")
def contact_at_one_step() -> Iterator[None]:
    """An exported contact is looked at with one step alone, which takes a third of the time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("plantar.exporters.contact.fit.STEPS", (0.001,))
        yield


@pytest.fixture(scope="session")
def robot(tmp_path_factory: pytest.TempPathFactory) -> RobotModel:
    """The test biped in its usual mounting."""
    return make_robot(tmp_path_factory.mktemp("biped"))
