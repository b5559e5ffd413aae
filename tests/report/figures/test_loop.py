"""The figure of torque over angle: what is drawn of which motion, and one line each in the legend."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plantar.errors import DataError
from plantar.report.figures.loop import plot_torque
from plantar.results.feet import FeetResult
from plantar.results.residuals import tracks_of
from report_samples import write_campaign

pytest.importorskip("matplotlib")


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> FeetResult:
    folder = tmp_path_factory.mktemp("campaign")
    write_campaign(folder, seconds=2.0)
    return FeetResult.load(folder)


def test_used_samples_of_all_motions_are_drawn_measured_under_modelled(result: FeetResult) -> None:
    assert result.residuals is not None
    tracks = [t for t in tracks_of(result.residuals) if t.foot == "left" and t.used.any()]
    axes = plot_torque(result, "left", "roll")
    assert len(tracks) > 1
    assert len(axes.lines) == 2 * len(tracks)
    for place, track in enumerate(tracks):
        for line, what in zip(axes.lines[2 * place : 2 * place + 2], ("torque", "predicted"), strict=True):
            x, y = (np.asarray(values, dtype=float) for values in line.get_data())
            np.testing.assert_allclose(x[track.used], 1e3 * track.values["roll.deflection"][track.used])
            np.testing.assert_array_equal(
                np.isfinite(x), track.used & np.isfinite(track.values["roll.deflection"])
            )
            np.testing.assert_allclose(y, track.values[f"roll.{what}"])


def test_the_legend_names_each_colour_once(result: FeetResult) -> None:
    axes = plot_torque(result, "right", "pitch")
    legend = axes.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["measured", "model"]
    assert axes.get_xlabel() == "right pitch [mrad]"
    assert axes.get_ylabel() == "torque [N·m]"


def test_one_motion_by_its_name_into_axes_of_ones_own(result: FeetResult) -> None:
    from matplotlib.figure import Figure

    mine = Figure().subplots()
    assert plot_torque(result, "left", "pitch", motions="tilt3", axes=mine) is mine
    assert len(mine.lines) == 2
    with pytest.raises(DataError, match="no_such"):
        plot_torque(result, "left", "pitch", motions="no_such")


def test_what_cannot_be_drawn_is_refused_with_what_can(result: FeetResult) -> None:
    with pytest.raises(DataError, match=r"^value 'middle': no foot has that name \(valid: left, right\)$"):
        plot_torque(result, "middle", "pitch")
    with pytest.raises(DataError, match=r"^value 'yaw': no axis has that name \(valid: pitch, roll\)$"):
        plot_torque(result, "left", "yaw")
    with pytest.raises(
        DataError,
        match=r"^the result holds no residuals to draw \(valid: a result of identify_feet, or "
        r"FeetResult\.load of a folder with residuals\.parquet\)$",
    ):
        plot_torque(replace(result, residuals=None), "left", "pitch")
    table = result.residuals
    assert table is not None
    right = [foot == "right" for foot in table["foot"].to_pylist()]
    unused = table.set_column(table.column_names.index("used"), "used", [right])
    with pytest.raises(DataError, match=r"no sample of the left foot was used \(valid: other motions\)"):
        plot_torque(replace(result, residuals=unused), "left", "pitch")
