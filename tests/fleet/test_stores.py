"""Logs, robot files and results in an S3-compatible store, and two machines that share nothing else."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pyarrow.parquet as pa_parquet
import pytest

from command_line import run
from fleet_samples import broken_logs, make_logs, small_fleet, write_manifest
from plantar.errors import PlantarError
from plantar.feet.settings import FeetSettings
from plantar.fleet.cluster import connected
from plantar.fleet.manifest import read_manifest
from plantar.fleet.places import PlaceError, Store, stamp_of
from plantar.fleet.robots import robot_at
from plantar.fleet.run import run_fleet

pytest.importorskip("s3fs")
moto_server = pytest.importorskip("moto.server")

BUCKET = "s3://fleet"
SETTINGS = FeetSettings(model="kelvin_voigt", wrench_delay=0.0)


@pytest.fixture(scope="module")
def store() -> Iterator[Any]:
    """A store on this machine, and an environment in which every process finds it."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = moto_server.ThreadedMotoServer(ip_address="127.0.0.1", port=port, verbose=False)
    server.start()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("AWS_ENDPOINT_URL", f"http://127.0.0.1:{port}")
        for name in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY"):
            patch.setenv(name, "testing")
        patch.setenv("AWS_DEFAULT_REGION", "us-east-1")
        import s3fs

        system = s3fs.S3FileSystem()
        system.mkdir("fleet")
        yield system
    server.stop()


@pytest.fixture(scope="module")
def client(store: Any) -> Iterator[Any]:
    """A worker that finds the store."""
    with connected(1, None, None) as found:
        yield found


def test_a_store_gives_what_a_folder_gives(store: Any, client: Any, tmp_path: Path) -> None:
    local = small_fleet(tmp_path, 3)
    broken_logs(tmp_path)
    run_fleet(read_manifest(local), Store(str(tmp_path / "out")), SETTINGS, client)
    for name in os.listdir(tmp_path):
        if (tmp_path / name).is_file():
            store.put(str(tmp_path / name), f"fleet/lab/{name}")
    text = local.read_text().replace("robot.yaml", f"{BUCKET}/lab/robot.yaml")
    remote = tmp_path / "remote.csv"
    remote.write_text(text.replace("log_", f"{BUCKET}/lab/log_"))
    there = Store(f"{BUCKET}/results")
    assert run_fleet(read_manifest(remote), there, SETTINGS, client).written.finished == 3
    assert there.read("results.parquet") == (tmp_path / "out" / "results.parquet").read_bytes()
    assert run_fleet(read_manifest(remote), there, SETTINGS, client).reused == 3
    assert sorted(name[:6] for name in there.names("units")) == ["units/"] * 3
    assert run("fleet", "report", f"{BUCKET}/results", "--quiet") == 0
    assert b"Stiffness of each robot" in (there.read("fleet.html") or b"")


def test_broken_and_missing_objects_are_told_by_their_url(store: Any, client: Any, tmp_path: Path) -> None:
    make_logs(tmp_path, 0)
    for file in tmp_path.iterdir():
        store.put(str(file), f"fleet/broken/{file.name}")
    store.pipe_file("fleet/broken/cut.parquet", b"PAR1")
    rows = [
        (name, f"{BUCKET}/broken/robot.yaml", f"{BUCKET}/broken/{name}.parquet", "", "", "")
        for name in ("cut", "gone")
    ]
    manifest = write_manifest(tmp_path / "fleet.csv", rows)
    out = Store(str(tmp_path / "out"))
    assert run_fleet(read_manifest(manifest), out, SETTINGS, client).written.failed == 2
    cut, gone = pa_parquet.read_table(tmp_path / "out" / "failures.parquet").to_pylist()
    assert cut["error"].startswith(f"{BUCKET}/broken/cut.parquet: is not a readable Parquet file")
    assert gone["error"] == f"{BUCKET}/broken/gone.parquet: does not exist"


def test_two_machines_with_a_store_between_them_give_what_one_gives(
    store: Any, client: Any, tmp_path: Path
) -> None:
    """Each machine has its own copies of some logs; results meet in the store. The second finds the first's work."""
    machines = [tmp_path / "first", tmp_path / "second"]
    manifests = []
    for machine in machines:
        machine.mkdir()
        manifests.append(small_fleet(machine, 4))
    there = Store(f"{BUCKET}/shared")
    half = machines[0] / "half.csv"
    half.write_text("".join(manifests[0].read_text().splitlines(keepends=True)[:3]))
    assert run_fleet(read_manifest(half), there, SETTINGS, client).reused == 0
    outcome = run_fleet(read_manifest(manifests[1]), there, SETTINGS, client)
    assert (outcome.reused, outcome.done) == (2, 2)
    alone = Store(str(tmp_path / "alone"))
    run_fleet(read_manifest(manifests[0]), alone, SETTINGS, client)
    assert there.read("results.parquet") == alone.read("results.parquet")


def test_logs_in_a_store_are_planned(store: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    make_logs(tmp_path, 0)
    for name in ("a_2026-05-04.mcap", "b_2026-05-04.mcap", "notes.txt~"):
        store.pipe_file(f"fleet/plan/{name}", b"")
    assert run("fleet", "plan", f"{BUCKET}/plan/*", "--robot", tmp_path / "robot.yaml", "--quiet") == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(",")[2] for line in lines[1:]] == [
        f"{BUCKET}/plan/{name}_2026-05-04.mcap" for name in "ab"
    ]
    assert "2026-05-04T00:00:00Z" in lines[1]


def test_a_robot_file_in_a_store_is_checked(store: Any) -> None:
    store.pipe_file("fleet/odd/outside.yaml", b"name: r\nurdf: ../../r.urdf\nbase: fixed\n")
    with pytest.raises(
        PlantarError, match=r"^s3://fleet/odd/outside\.yaml, column 'urdf': names a URDF outside"
    ):
        robot_at(f"{BUCKET}/odd/outside.yaml")
    store.pipe_file("fleet/odd/unknown.yaml", b"nam: r\n")
    with pytest.raises(PlantarError, match=r"^s3://fleet/odd/unknown\.yaml"):
        robot_at(f"{BUCKET}/odd/unknown.yaml")


def test_a_store_that_is_not_there_is_one_line(store: Any, tmp_path: Path) -> None:
    with pytest.raises(PlaceError, match="s3://nowhere/x/units"):
        Store("s3://nowhere/x").write("units/a", b"")
    with pytest.raises(PlantarError, match=r"s3://nowhere/x\.csv: does not exist"):
        stamp_of("s3://nowhere/x.csv")
    with pytest.raises(PlantarError, match="nosuch://x"):
        stamp_of("nosuch://x/y.csv")
