"""Residuals read back: from Parquet and from CSV, whatever names the path; a broken file is one line."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from plantar.results.residuals import read_residuals
from report_samples import write_campaign


def test_csv_residuals_serve_as_well(tmp_path: Path) -> None:
    import pyarrow.csv
    import pyarrow.parquet

    write_campaign(tmp_path, seconds=2.0)
    table = pyarrow.parquet.read_table(tmp_path / "residuals.parquet")
    from_parquet = read_residuals(tmp_path / "residuals.parquet")
    pyarrow.csv.write_csv(table, tmp_path / "residuals.csv")
    from_csv = read_residuals(tmp_path / "residuals.csv")
    assert [(t.motion, t.foot, t.role) for t in from_csv] == [
        (t.motion, t.foot, t.role) for t in from_parquet
    ]
    for one, other in zip(from_csv, from_parquet, strict=True):
        np.testing.assert_array_equal(one.used, other.used)
        np.testing.assert_allclose(one.values["pitch.predicted"], other.values["pitch.predicted"])
