"""Measured against predicted: the ground's wrench axis by axis (eq. 2), torques joint by joint (eq. 3)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import pyarrow as pa

from plantar.conventions import Array
from plantar.notes import Note, listing
from plantar.results.dynamics import DynamicsScore
from plantar.results.scores import error_measures
from plantar.whole_body.folds import Samples
from plantar.whole_body.regularised_fit import RegularisedFit

Kind = Literal["direct", "cross"]
WORSE = 1.5  # times the URDF's error: by less unseen motions differ by chance


@dataclass(frozen=True)
class Place:
    """A row of eq. 1 and what results call it: an axis of the ground's wrench, or a joint."""

    row: int
    unit: str
    axis: str | None = None
    joint: str | None = None

    @property
    def name(self) -> str:
        return self.axis or self.joint or ""


def scored(
    fit: RegularisedFit, fitted: Sequence[Samples], unseen: Sequence[Samples], places: Sequence[Place]
) -> tuple[tuple[DynamicsScore, ...], pa.Table]:
    """Scores motion by motion and place by place, joints also all together; and the residuals, sample by sample."""
    index = [place.row for place in places]
    rows: list[DynamicsScore] = []
    tables: list[pa.Table] = []
    trivial = np.mean([[samples.measured[row].mean() for row in index] for samples in fitted], axis=0)
    kinds: tuple[tuple[Kind, Sequence[Samples]], ...] = (("direct", fitted), ("cross", unseen))
    for kind, samples in ((kind, samples) for kind, recordings in kinds for samples in recordings):
        measured = np.array([samples.measured[row] for row in index])
        predicted = fit.predict(samples)[index]
        cad = fit.equation.inverse_dynamics(samples.motion, fit.prior.cad)[index]
        for place, *parts in zip(places, measured, predicted, cad, trivial, strict=True):
            rows.append(_score(kind, samples.name, place.unit, *parts, axis=place.axis, joint=place.joint))
        if places[0].joint is not None:
            parts = [measured, predicted, cad, trivial[:, None]]
            rows.append(_score(kind, samples.name, places[0].unit, *parts, joint="all"))
        tables.append(_residuals(samples, kind, places, measured, predicted))
    return tuple(rows), pa.concat_tables(tables)


def worse_notes(scores: Sequence[DynamicsScore]) -> list[Note]:
    """A warning of unseen motions that the URDF alone predicts better: what was fitted there was no inertia."""
    worse = [one for one in scores if one.kind == "cross" and one.rms_error > WORSE * one.cad_rms_error]
    said = [f"{one.motion}: {one.axis or one.joint}: {one.rms_error:.3g} against {one.cad_rms_error:.3g} {one.unit} rms"
            for one in worse]  # fmt: skip
    text = "the URDF alone predicts unseen motions better: use its inertias, or record larger and quicker motions"
    return [Note("worse_than_urdf", "warning", f"{text} ({listing(said)})")] if said else []


def _score(
    kind: Kind,
    motion: str,
    unit: str,
    measured: Array,
    predicted: Array,
    cad: Array,
    trivial: Array | float,
    *,
    axis: str | None = None,
    joint: str | None = None,
) -> DynamicsScore:
    """Errors of one axis or joint (N,), or of all joints together (k, N)."""
    size = float(np.linalg.norm(measured))
    relative = 100 * float(np.linalg.norm(measured - predicted)) / size if size > 0 else None
    return DynamicsScore(
        kind=kind,
        motion=motion,
        unit=unit,
        cad_rms_error=float(np.sqrt(np.mean((measured - cad) ** 2))),
        samples=int(measured.shape[-1]),
        relative_error_percent=relative,
        axis=axis,
        joint=joint,
        **error_measures(measured, predicted, trivial),
    )


def _residuals(
    samples: Samples, kind: Kind, places: Sequence[Place], measured: Array, predicted: Array
) -> pa.Table:
    """Measured and predicted of every row of one motion, sample by sample."""
    count = len(samples.time)
    columns: dict[str, object] = {
        "motion": pa.array([samples.name] * count).dictionary_encode(),
        "role": pa.array(["fit" if kind == "direct" else "validate"] * count).dictionary_encode(),
        "time": samples.time,
    }
    for place, true, guess in zip(places, measured, predicted, strict=True):
        columns[f"{place.name}.measured"] = true
        columns[f"{place.name}.predicted"] = guess
    return pa.table(columns)
