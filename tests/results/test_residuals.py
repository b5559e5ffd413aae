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
    with pytest.raises(PlantarError, match=r"holds no residuals .*residuals\.csv\.gz"):
        read_residuals(tmp_path)
    (tmp_path / "residuals.csv").write_text("motion,foot,time\na,left,0.1\n")
    with pytest.raises(PlantarError, match=r"residuals\.csv, column 'used': is missing"):
        read_residuals(tmp_path)
