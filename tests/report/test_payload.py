"""How samples travel inside the page."""

from __future__ import annotations

import base64
import zlib
from pathlib import Path

import numpy as np
import pytest

from plantar.report.payload import encode_motion, quantise
from plantar.results.residuals import Track, read_residuals
from report_samples import write_campaign


def decoded(track: Track, stride: int = 1) -> dict[str, np.ndarray]:
    """The payload read back, written apart from both encoder and browser code."""
    payload = encode_motion([track], stride)
    raw = zlib.decompress(base64.b64decode(payload.data))
    (header,) = payload.header["tracks"]
    n, at = header["n"], 0

    def planes(width: int) -> np.ndarray:
        nonlocal at
        part = np.frombuffer(raw, np.uint8, n * width, at).reshape(width, n).astype(np.int64)
        at += n * width
        return (part * 256 ** np.arange(width)[:, None]).sum(axis=0)

    out = {"time": header["t0"] + np.cumsum(planes(4)) * header["tick"]}
    flags = planes(1)
    out["used"], out["support"] = flags & 1, np.array(payload.header["supports"])[flags >> 1]
    for channel in header["channels"]:
        zigzag = planes(2)
        code = np.cumsum(np.where(zigzag % 2, -(zigzag + 1) // 2, zigzag // 2)) % 65536
        out[channel["key"]] = np.where(code == 0, np.nan, channel["zero"] + (code - 1) * channel["step"])
    assert at == len(raw)
    return out


def test_every_sample_reaches_the_browser(tmp_path: Path) -> None:
    campaign = write_campaign(tmp_path, seconds=20.0)
    tracks = read_residuals(campaign.directory / "residuals.parquet")
    track = next(t for t in tracks if (t.motion, t.foot) == ("tilt3", "left"))
    out = decoded(track)
    np.testing.assert_allclose(out["time"], track.time, atol=1e-6)
    np.testing.assert_array_equal(out["used"], track.used)
    np.testing.assert_array_equal(out["support"], track.support)
    for key, unit in (
        ("pitch.torque", 1.0), ("roll.predicted", 1.0), ("pitch.deflection", 1e3), ("roll.deflection", 1e3),
        ("force_z", 1.0), ("cop_x", 1e3), ("cop_y", 1e3),
    ):  # fmt: skip
        truth = unit * track.values[key]
        np.testing.assert_array_equal(np.isnan(out[key]), np.isnan(truth))
        change = np.nanmedian(np.abs(np.diff(truth)))
        assert np.nanmax(np.abs(out[key] - truth)) <= max(
            1.01 * change / 32, np.ptp(truth[~np.isnan(truth)]) / 65534
        )


@pytest.mark.parametrize(
    "values",
    [np.full(5, np.nan), np.full(5, 3.0), np.array([1.0]), np.array([]), np.array([-np.inf, 0.0, 1e308]),
     np.array([0.0, 1e-300]), np.r_[np.zeros(99), 1e6]],
)  # fmt: skip
def test_odd_channels_are_coded_without_harm(values: np.ndarray) -> None:
    codes, zero, step = quantise(values)
    back = np.where(codes == 0, np.nan, zero + (codes.astype(float) - 1) * step)
    np.testing.assert_array_equal(np.isfinite(back), np.isfinite(values))
    assert step or codes.max(initial=0) <= 1, "one number is one code"
    finite = values[np.isfinite(values)]
    if finite.size:
        np.testing.assert_allclose(back[np.isfinite(back)], finite, atol=np.ptp(finite) / 1000)


def test_of_a_long_motion_each_so_many_samples_travel() -> None:
    time = np.linspace(2.0, 3.0, 101)
    support = np.where(time < 2.5, "single", "double")
    track = Track("m", "fit", "left", time, time < 2.25, support, {"force_z": 100.0 * time})
    out = decoded(track, 7)
    np.testing.assert_allclose(out["time"], time[::7], atol=1e-6)
    np.testing.assert_array_equal(out["used"], track.used[::7])
    np.testing.assert_array_equal(out["support"], support[::7])
    np.testing.assert_allclose(out["force_z"], 100.0 * time[::7], atol=0.1)
