"""Residuals read back: from Parquet and from CSV, whatever names the path; a broken file is one line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from plantar.errors import PlantarError
from plantar.results.residuals import read_residuals, read_table, tracks_of
from report_samples import write_campaign


def test_csv_residuals_serve_as_well(tmp_path: Path) -> None:
    import pyarrow.csv
    import pyarrow.parquet

    write_campaign(tmp_path, seconds=2.0)
    table = pyarrow.parquet.read_table(tmp_path / "residuals.parquet")
    from_parquet = read_residuals(tmp_path / "result.json")  # what `save` returns names the folder as well
    pyarrow.csv.write_csv(table, tmp_path / "residuals.csv")
    from_csv = read_residuals(tmp_path / "residuals.csv")
    assert [(t.motion, t.foot, t.role) for t in from_csv] == [
        (t.motion, t.foot, t.role) for t in from_parquet
    ]
    for one, other in zip(from_csv, from_parquet, strict=True):
        np.testing.assert_array_equal(one.used, other.used)
        np.testing.assert_allclose(one.values["pitch.predicted"], other.values["pitch.predicted"])


def test_a_folder_a_string_and_a_table_give_the_same_tracks(tmp_path: Path) -> None:
    write_campaign(tmp_path, seconds=2.0)
    ways = [
        read_residuals(tmp_path),
        read_residuals(str(tmp_path / "residuals.parquet")),
        tracks_of(read_table(tmp_path / "residuals.parquet")),
    ]
    for tracks in ways[1:]:
        assert [(t.motion, t.foot) for t in tracks] == [(t.motion, t.foot) for t in ways[0]]
        for one, other in zip(tracks, ways[0], strict=True):
            np.testing.assert_array_equal(one.values["roll.torque"], other.values["roll.torque"])


def test_a_folder_without_residuals_and_a_broken_file_are_one_line(tmp_path: Path) -> None:
    with pytest.raises(
        PlantarError,
        match=r": holds no residuals \(valid: residuals\.parquet, "
        r"residuals\.csv, residuals\.csv\.gz\)$",
    ):
        read_residuals(tmp_path)
    (tmp_path / "residuals.csv").write_text("motion,foot,time\na,left,0.1\n")
    with pytest.raises(
        PlantarError, match=r"residuals\.csv, column 'used': is missing \(valid: motion, foot, time, used\)$"
    ):
        read_residuals(tmp_path)


@pytest.mark.parametrize("coded", [False, True])
def test_rows_in_any_order_give_the_same_tracks(coded: bool) -> None:
    """Each number of a row tells which row it is; the columns that a table may lack are empty."""
    import pyarrow as pa

    every = [
        (motion, role, foot, time, support)
        for motion, role in (("walk", "validate"), ("sway", "fit"))
        for foot in ("right", "left")
        for time, support in enumerate(("double", "single", "air", "single", "transition"))
    ]
    number = {row: float(place) for place, row in enumerate(every)}
    shuffled = [
        every[0],
        *(every[1 + place] for place in np.random.default_rng(0).permutation(len(every) - 1)),
    ]
    names = ("motion", "role", "foot", "time", "support")
    columns = {name: pa.array(cells) for name, cells in zip(names, zip(*shuffled, strict=True), strict=True)}
    columns = {
        name: cells.dictionary_encode() if coded and name != "time" else cells
        for name, cells in columns.items()
    }
    values = np.array([number[row] for row in shuffled])
    table = pa.table(
        columns | {"used": values % 2 == 0, "force_z": values, "roll.offset": -values, "other": values}
    )
    tracks = {(track.motion, track.foot): track for track in tracks_of(table)}
    assert next(iter(tracks)) == ("walk", "right"), "as the file first names them"
    assert len(tracks) == 4
    for (motion, foot), track in tracks.items():
        rows = [row for row in every if (row[0], row[2]) == (motion, foot)]
        own = np.array([number[row] for row in rows])
        assert track.role == rows[0][1]
        assert track.support.tolist() == [row[4] for row in rows]
        assert (track.time.tolist(), track.used.tolist()) == (list(range(5)), (own % 2 == 0).tolist())
        assert {name: cells.tolist() for name, cells in track.values.items()} == {
            "force_z": own.tolist(), "roll.offset": (-own).tolist()
        }  # fmt: skip
    for track in tracks_of(table.drop_columns(["role", "support"])):
        assert (track.role, track.support.tolist()) == ("", [""] * 5)
