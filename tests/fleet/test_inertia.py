"""Eq. 2 over many logs, added up by a tree, is eq. 2 of one process."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import small_biped
from command_line import refused, run
from fleet_samples import write_manifest
from plantar.errors import DataError, RobotError
from plantar.fleet.inertia import inertia_over
from plantar.logs.save import save_log
from plantar.results.dynamics import DynamicsResult
from plantar.whole_body.inertia import identify_inertia
from plantar.whole_body.settings import DynamicsSettings

LOGS = 9  # more than one branch of the tree


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A robot and logs of it, with other inertias than its URDF says."""
    made = tmp_path_factory.mktemp("inertia")
    robot = small_biped.robot(made)
    real = small_biped.truth(robot.floating_model, 1)
    for seed in range(LOGS):
        save_log(small_biped.record(robot, real, f"log_{seed}", seed, 4.0, 0.5), made / f"log_{seed}.parquet")
    return made


def logs(folder: Path) -> list[str]:
    return [str(folder / f"log_{seed}.parquet") for seed in range(LOGS)]


def assert_same(found: DynamicsResult, alone: DynamicsResult) -> None:
    """To 1e-10 of the largest value, as far as one process goes."""
    for rows, expected in (
        (found.inertial_parameters, alone.inertial_parameters),
        (found.base_parameters, alone.base_parameters),
    ):
        values, others = (np.array([row.value for row in some]) for some in (rows, expected))
        assert np.abs(values - others).max() < 1e-10 * np.abs(others).max()
    for row, other in zip(found.base_parameters, alone.base_parameters, strict=True):
        assert row.std == pytest.approx(other.std, rel=1e-6)
        assert row.interval95 == pytest.approx(other.interval95, rel=1e-6, abs=1e-9)
    assert found.settings["strength"] == alone.settings["strength"]
    assert found.settings["weights"] == pytest.approx(alone.settings["weights"], rel=1e-10)
    assert (found.rank, found.urdf[:500]) == (alone.rank, alone.urdf[:500])


@pytest.mark.parametrize(("count", "settings"), [(1, DynamicsSettings(cutoff=2.0)), (LOGS, None)])
def test_the_sum_of_factors_is_what_one_process_finds(
    client: Any, folder: Path, count: int, settings: DynamicsSettings | None
) -> None:
    robot, some = folder / "biped.yaml", logs(folder)[:count]
    found = inertia_over(client, str(robot), some, settings, progress=lambda _: None)
    assert len(found.inputs) == count
    assert_same(found, identify_inertia(robot, some, settings=settings))


def test_a_broken_log_is_told_and_left_out(client: Any, folder: Path) -> None:
    broken = folder / "broken.parquet"
    broken.write_bytes(b"PAR1")
    found = inertia_over(
        client,
        str(folder / "biped.yaml"),
        [str(broken), *logs(folder)[:2]],
        settings=None,
        progress=lambda _: None,
    )
    assert [Path(entry.path).name for entry in found.inputs] == ["log_0.parquet", "log_1.parquet"]
    (note,) = (note for note in found.notes if note.code == "log_left_out")
    assert note.text.startswith(f"{broken}: is not a readable Parquet file")
    other = folder / "other.parquet"
    other.write_bytes(b"PAR1")
    with pytest.raises(DataError, match=r"none of the first 2 logs can be used: .*broken\.parquet"):
        inertia_over(
            client,
            str(folder / "biped.yaml"),
            [str(broken), str(other)],
            settings=None,
            progress=lambda _: None,
        )


def test_the_command_writes_what_identify_inertia_writes(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = [("g", "biped.yaml", Path(log).name, "", "", "") for log in logs(folder)[:2]]
    unseen = ("g", "biped.yaml", "log_2.parquet", "validate", "", "")  # takes no part
    manifest, out = write_manifest(folder / "fleet.csv", [*rows, unseen]), folder / "out"
    assert run("fleet", "inertia", manifest, "--out", out, "--workers", "1") == 0
    assert capsys.readouterr().out.split()[-3:] == [
        str(out / name) for name in ("result.json", "identified.urdf", "report.html")
    ]
    assert_same(DynamicsResult.load(out), identify_inertia(folder / "biped.yaml", logs(folder)[:2]))
    assert (out / "identified.urdf").is_file()
    assert (out / "report.html").is_file()
    two = write_manifest(folder / "two.csv", [*rows, ("h", "arm.yaml", "log_2.parquet", "", "", "")])
    assert "names 2 robot files" in refused(capsys, "fleet", "inertia", two, "--out", out)


def test_what_cannot_be_is_refused(client: Any, folder: Path) -> None:
    (folder / "arm.yaml").write_text("name: arm\nurdf: biped.urdf\nbase: fixed\n")
    with pytest.raises(
        RobotError,
        match=r"arm\.yaml: a fixed base has no base rows to identify from \(valid: a floating one\)$",
    ):
        inertia_over(client, str(folder / "arm.yaml"), logs(folder), settings=None, progress=lambda _: None)
    with pytest.raises(DataError, match=r"^no logs to fit \(valid: at least one\)$"):
        inertia_over(client, str(folder / "biped.yaml"), [], settings=None, progress=lambda _: None)
