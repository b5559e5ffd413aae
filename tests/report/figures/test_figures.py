"""The paper's figures as pictures: what is drawn, in which colours, in files that stay the same."""

from __future__ import annotations

import re
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from plantar.errors import DataError, MissingExtra
from plantar.results.residuals import Track, read_residuals
from report_samples import HOSTILE, write_campaign

pytest.importorskip("matplotlib", reason="matplotlib (extra 'figures') is not installed")

from plantar.report.figures import plots
from plantar.report.figures.paper import plates, write_figures

FIT = ["manual_right_roll", "manual_right_pitch", "manual_left_roll", "manual_left_pitch", "tilt3"]


@pytest.fixture(scope="module")
def directory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_campaign(tmp_path_factory.mktemp("figures"), seconds=4.0).directory


@pytest.fixture(scope="module")
def tracks(directory: Path) -> tuple[Track, ...]:
    return read_residuals(directory / "residuals.parquet")


def test_bush_angles_are_red_right_and_blue_left(tracks: tuple[Track, ...]) -> None:
    drawing = plots.bush_angles(tracks, "tilt3")
    for panel, axis in zip(drawing.axes, ("pitch", "roll"), strict=True):
        assert panel.get_ylabel() == f"{axis} [mrad]"
        for line in panel.lines:
            track = next(t for t in tracks if (t.motion, t.foot) == ("tilt3", line.get_label()))
            np.testing.assert_allclose(line.get_ydata(), 1e3 * track.values[f"{axis}.deflection"])
            assert line.get_color() == {"right": plots.RED, "left": plots.BLUE}[track.foot]


def test_composed_motions_follow_each_other(tracks: tuple[Track, ...]) -> None:
    drawing = plots.torques(tracks, FIT)
    assert len(drawing.axes) == 4
    for panel in drawing.axes:
        sensor = [line for line in panel.lines if line.get_color() == plots.RED and len(line.get_xdata())]
        assert len(sensor) == len(FIT)
        starts = [line.get_xdata()[0] for line in sensor]
        np.testing.assert_allclose(starts, 3.995 * np.arange(len(FIT)))


def test_a_motion_begins_with_the_foot_that_was_seen_first(tracks: tuple[Track, ...]) -> None:
    left, right = (
        next(t for t in tracks if (t.motion, t.foot) == ("tilt3", foot)) for foot in ("left", "right")
    )
    later = replace(right, time=right.time + 2.0)
    panels = plots.torques([left, later], ["tilt3"]).axes[:2]
    starts = [panel.lines[0].get_xdata()[0] for panel in panels]
    np.testing.assert_allclose(starts, [0.0, 2.0], atol=1e-9)


def test_what_was_left_out_is_grey(tracks: tuple[Track, ...]) -> None:
    (track,) = (t for t in tracks if (t.motion, t.foot) == ("tilt3", "left"))
    used = np.ones(track.time.size, bool)
    used[100:300] = False  # half a second and more
    used[500] = False  # a single sample is no band
    one = replace(track, used=used)
    assert plots.left_out(one) == [(pytest.approx(track.time[100]), pytest.approx(track.time[299]))]
    panel = plots.torques([one], ["tilt3"]).axes[0]
    (band,) = panel.patches
    assert band.get_x() == pytest.approx(track.time[100] - track.time[0])
    assert band.get_width() == pytest.approx(track.time[299] - track.time[100])


def test_the_zmp_lies_with_forward_up_and_left_on_the_left() -> None:
    points = np.array([[0.0, 0.0], [np.nan, np.nan], [0.1, 0.02]])
    foot = np.array([[0.1, 0.05], [-0.1, 0.05], [-0.1, -0.05], [0.1, -0.05]])
    drawing = plots.zmp(points, {"left": foot + [0, 0.1]}, foot)
    (panel,) = drawing.axes
    outline, _, path = panel.lines
    assert [line.get_color() for line in panel.lines] == ["black", plots.BLUE, plots.RED]
    np.testing.assert_array_equal(path.get_xdata(), points[:, 1])
    np.testing.assert_array_equal(path.get_ydata(), points[:, 0])
    assert len(outline.get_xdata()) == 5
    assert panel.xaxis_inverted()


def test_an_envelope_keeps_peaks_and_gaps() -> None:
    rng = np.random.default_rng(1)
    time = np.arange(50_000) / 200
    values = rng.normal(size=time.size)
    values[12_345] = 99.0
    values[30_001] = -77.0
    values[40_000:41_000] = np.nan
    kept_time, kept = plots.envelope(time, values, 300)
    assert kept.size <= 5 * 300
    assert np.all(np.diff(kept_time) > 0)
    assert {99.0, -77.0} <= set(kept)
    assert np.isnan(kept[(kept_time > 200.5) & (kept_time < 204.5)]).any()
    for low in range(0, 300):
        part = slice(*np.linspace(0, time.size, 301).astype(int)[low : low + 2])
        if not np.isnan(values[part]).any():
            assert {values[part].min(), values[part].max()} <= set(kept)


def test_plates_carry_the_papers_numbers(tracks: tuple[Track, ...]) -> None:
    made = plates(tracks)
    numbered = {plate.number: plate.name for plate in made if plate.number is not None}
    assert numbered == {
        7: "figure07_angles_tilt3",
        8: "figure08_angles_manual_left_roll",
        9: "figure09_direct",
        10: "figure10_cross_tilt1",
        11: "figure11_cross_squat",
        12: "figure12_cross_myrand4",
    }
    assert {plate.number for plate in plates(tracks, only_paper=True)} == set(numbered)
    names = [plate.name for plate in made]
    assert len(set(names)) == len(names)
    assert all(re.fullmatch(r"[A-Za-z0-9_-]+", name) for name in names)
    assert any(HOSTILE in plate.title for plate in made)


def test_motions_with_the_same_safe_name_do_not_overwrite_each_other(tracks: tuple[Track, ...]) -> None:
    from dataclasses import replace

    twins = [replace(tracks[0], motion=name) for name in ("a b", "a/b", "a-b", "A-B")]
    names = [plate.name for plate in plates(twins)]
    assert len({name.casefold() for name in names}) == len(names), "some disks tell A from a no more"


def test_files_are_written_and_stay_the_same(
    directory: Path, tracks: tuple[Track, ...], tmp_path: Path
) -> None:
    written = write_figures(directory, tmp_path / "all", formats=("svg",), only_paper=True)
    assert [path.suffix for path in written] == [".svg"] * 6
    assert all(path.read_bytes().startswith(b"<?xml") for path in written)
    twice = [
        plots.save(plots.bush_angles(tracks, "tilt3"), tmp_path / place, "angles") for place in ("one", "two")
    ]
    for one, two in zip(*twice, strict=True):
        assert one.read_bytes() == two.read_bytes()
        assert one.read_bytes()[:4] in (b"<?xm", b"%PDF")


def test_a_plate_becomes_a_picture_of_the_report(tracks: tuple[Track, ...]) -> None:
    picture = plates(tracks, only_paper=True)[0].picture()
    assert picture.content[:4] == b"\x89PNG"
    assert picture.data_uri.startswith("data:image/png;base64,")
    assert picture.title == "Figure 7. Bush angles in tilt3."


def test_what_is_missing_is_said(
    tracks: tuple[Track, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(DataError, match=r"^the residuals hold no motion 'tilt9'$"):
        plots.bush_angles(tracks, "tilt9")
    with pytest.raises(
        DataError,
        match=r"test_what_is_missing_is_said0: holds no residuals \(valid: the directory of a "
        r"result\.json\)$",
    ):
        write_figures(tmp_path, tmp_path)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(
        MissingExtra,
        match=r"^drawing figures needs the package 'matplotlib': pip install 'plantar\[figures\]'$",
    ):
        plots.bush_angles(tracks, "tilt3")
