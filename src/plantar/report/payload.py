"""Full-resolution data for the browser, small enough to travel inside the page.

Each channel is rounded to a sixteenth of its median change from sample to sample (never coarser than a 1023rd
of its range, never finer than a 65534th), which no plot can show. The 16-bit codes are written as
differences, low and high bytes apart, deflated and base64-encoded; `templates/payload.js` undoes it.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from plantar.contact.phases import SUPPORTS
from plantar.conventions import Array
from plantar.results.residuals import Track
from plantar.signals.medians import median

SIZE_LIMIT: Final = 4_000_000
"""What all motions together may take in the page [characters]; a longer campaign is thinned and says so."""

CODES: Final = 65534
COARSEST: Final = 1023
TICK: Final = 1e-6
EFFORT: Final = 2
"""Of deflating, of 9: noise is most of what there is, and twice the time would save a twentieth of the room."""


@dataclass(frozen=True)
class Payload:
    """One motion: `header` says how to read `data` (base64 of deflated bytes)."""

    header: dict[str, Any]
    data: str


def encode(motions: Sequence[Sequence[Track]], limit: int = SIZE_LIMIT) -> tuple[list[Payload], int]:
    """The motions' payloads and the stride: each `stride`-th sample is kept, 1 unless `limit` forces more."""
    stride = 1
    while True:
        payloads = [encode_motion(tracks, stride) for tracks in motions]
        size = sum(len(payload.data) for payload in payloads)
        if size <= limit or all(track.time.size <= stride for tracks in motions for track in tracks):
            return payloads, stride
        stride = max(stride + 1, round(stride * size / limit))


def encode_motion(tracks: Sequence[Track], stride: int) -> Payload:
    """All feet of one motion in one block, track after track: time, flags, then the channels."""
    blocks: list[bytes] = []
    headers: list[dict[str, Any]] = []
    for track in tracks:
        time = track.time[::stride]
        span = float(time[-1] - time[0])
        tick = max(TICK, span / 2**31)
        ticks = np.round((time - time[0]) / tick).astype(np.uint32)
        blocks.append(_planes(np.diff(ticks, prepend=np.uint32(0)), 4))
        blocks.append(_flags(track)[::stride].tobytes())
        channels = []
        for key, values in _channels(track).items():
            codes, zero, step = quantise(values[::stride])
            blocks.append(_planes(differences(codes), 2))
            channels.append({"key": key, "zero": zero, "step": step})
        start = {"n": int(time.size), "t0": float(time[0]), "tick": tick}
        headers.append({"foot": track.foot, **start, "channels": channels})
    data = base64.b64encode(zlib.compress(b"".join(blocks), EFFORT)).decode("ascii")
    return Payload({"tracks": headers, "supports": list(SUPPORTS)}, data)


def quantise(values: Array) -> tuple[NDArray[np.uint16], float, float]:
    """Codes, zero and step with `values ≈ zero + (codes - 1)·step`; code 0 is a value that is not finite."""
    finite = np.isfinite(values)
    if not finite.any():
        return np.zeros(values.shape, dtype=np.uint16), 0.0, 0.0
    known = values[finite]
    zero, span = float(known.min()), float(np.ptp(known))
    change = float(median(np.abs(np.diff(known)))) if known.size > 1 else 0.0
    step = min(max(change / 16, span / CODES), span / COARSEST)
    codes = np.zeros(values.shape, dtype=np.uint16)
    if step > 0 and np.isfinite(step):
        codes[finite] = 1 + np.minimum(np.round((known - zero) / step), CODES)
    else:
        codes[finite] = 1
    return codes, zero, step


def differences(codes: NDArray[np.uint16]) -> NDArray[np.uint16]:
    """Changes from code to code (modulo 2^16), small ones of either sign as small numbers: 0 -1 1 -2 -> 0 1 2
    3.
    """
    change = np.diff(codes, prepend=np.uint16(0)).astype(np.int16)
    zigzag: NDArray[np.uint16] = ((change << 1) ^ (change >> 15)).astype(np.uint16)
    return zigzag


def _channels(track: Track) -> Mapping[str, Array]:
    """What is drawn, angles in mrad and lengths in mm so that a step of the code suits the axis."""
    channels = {}
    for axis in track.axes:
        channels[f"{axis}.deflection"] = track.values[f"{axis}.deflection"] * 1e3
        channels[f"{axis}.torque"] = track.values[f"{axis}.torque"]
        if f"{axis}.predicted" in track.values:
            channels[f"{axis}.predicted"] = track.values[f"{axis}.predicted"]
    for key, factor in (("force_z", 1.0), ("cop_x", 1e3), ("cop_y", 1e3)):
        if key in track.values:
            channels[key] = factor * track.values[key]
    return channels


def _flags(track: Track) -> NDArray[np.uint8]:
    """Bit 0: used; the bits above: the support's number; any other name counts as a transition."""
    support = np.full(track.time.size, len(SUPPORTS) - 1, dtype=np.uint8)
    for code, name in enumerate(SUPPORTS):
        support[track.support == name] = code
    return (track.used.astype(np.uint8) | (support << 1)).astype(np.uint8)


def _planes(numbers: NDArray[np.unsignedinteger[Any]], width: int) -> bytes:
    """The numbers' lowest bytes, then their next bytes, ...: long runs of alike bytes deflate well."""
    little = numbers.astype(f"<u{width}")
    return little.view(np.uint8).reshape(-1, width).T.tobytes()
