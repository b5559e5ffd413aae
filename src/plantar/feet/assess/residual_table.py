"""Every sample of every foot beside what the model says of it: the table behind the report's plots."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from plantar.contact.phases import SUPPORTS
from plantar.conventions import ROTATIONAL_AXES, Array, Axis
from plantar.feet.recording import Recording
from plantar.feet.regression.prediction import Prediction

if TYPE_CHECKING:
    import pyarrow as pa

Predictions = dict[tuple[str, str, Axis], Prediction]  # by motion, foot and axis


def residual_table(
    recordings: Sequence[Recording], predictions: Mapping[tuple[str, str, Axis], Prediction]
) -> pa.Table:
    """One row a sample, foot and motion; predicted torque, and what of it is not the bush's, are NaN where nothing was
    predicted."""
    import pyarrow as pa  # it costs start-up

    parts = [_one(recording, foot, predictions) for recording in recordings for foot in recording.bushes]
    return pa.concat_tables(parts)


def _one(
    recording: Recording, foot: str, predictions: Mapping[tuple[str, str, Axis], Prediction]
) -> pa.Table:
    import pyarrow as pa

    bush, contact, count = recording.bushes[foot], recording.contacts[foot], len(recording.time)

    def repeated(text: str) -> pa.Array:
        return pa.DictionaryArray.from_arrays(pa.array(np.zeros(count, dtype=np.int8)), [text])

    def single(values: Array) -> pa.Array:
        return pa.array(values.astype(np.float32))

    columns = {
        "motion": repeated(recording.name),
        "role": repeated(recording.role),
        "foot": repeated(foot),
        "time": pa.array(recording.time),
        "used": pa.array(contact.used),
        "support": pa.DictionaryArray.from_arrays(pa.array(contact.support), list(SUPPORTS)),
        "force_z": single(bush.force_z),
        "cop_x": single(bush.cop[:, 0]),
        "cop_y": single(bush.cop[:, 1]),
    }
    for column, axis in enumerate(ROTATIONAL_AXES):
        predicted = predictions.get((recording.name, foot, axis))
        columns[f"{axis}.deflection"] = pa.array(bush.deflection[:, column])
        columns[f"{axis}.rate"] = pa.array(bush.rate[:, column])
        columns[f"{axis}.torque"] = pa.array(bush.torque[:, column])
        nothing = np.full(count, np.nan)
        columns[f"{axis}.predicted"] = pa.array(nothing if predicted is None else predicted.torque)
        columns[f"{axis}.offset"] = pa.array(
            nothing if predicted is None else predicted.torque - predicted.bush
        )
    return pa.table(columns)
