"""Play between an encoder and the foot, in a gear that carries the foot's torque.

The angle jumps wherever that changes its sign: torque = K·(angle - play/2·sign(torque)) + C·rate + offset. It bends
every other model: taken for hardening or for a memory, it makes the spring too soft. Play in an encoder's own drive is
`misread_joints`'.
"""

from __future__ import annotations

import numpy as np

from plantar.conventions import ROTATIONAL_AXES, SURE, Array
from plantar.estimation import fit_blocks
from plantar.feet.place.misread_joints import BETTER, SOFT
from plantar.feet.recording import Recording
from plantar.feet.regression.axis import AxisFit
from plantar.feet.regression.regression_data import all_beside, blocks_of
from plantar.feet.regression.tangent import Tangent
from plantar.notes import Note

CODE = "play"


def play_notes(tangent: Tangent, wide: AxisFit) -> list[Note]:
    """A warning where play explains a standing foot's torque far better than the model that was found, and moves
    stiffness or damping out of the interval of `wide`.
    """
    if tangent.steps:
        return []
    blocks = blocks_of(tangent.recordings, wide.foot, wide.axis, drift=not tangent.shared)
    column = ROTATIONAL_AXES.index(wide.axis)
    signs = [_sign(one, wide.foot, column)[:, None] for one in tangent.recordings]
    found = fit_blocks(all_beside(blocks, signs), shared_offset=tangent.shared)
    stiffness, loss = float(found.values[0]), -float(found.values[2])
    if stiffness <= 0 or loss < SURE * float(found.std[2]):
        return []
    usual = tangent.least_squares
    if usual.squares < BETTER * found.squares or wide.holds(found.values[:2] - usual.values[:2]):
        return []
    text = (
        f"{wide.foot} {wide.axis}: the angle jumps by {2e3 * loss / stiffness:.2g} mrad where the torque changes its "
        "sign: play between an encoder and the foot, which makes the spring look softer (valid: encoders on the foot's "
        "side of every gear; or keep the torque on one side of zero)"
    )
    return [Note(CODE, "warning", text)]


def _sign(recording: Recording, foot: str, column: int) -> Array:
    """The sign of the torque at the rows of a fit, (n,), smooth about zero."""
    torque = recording.bushes[foot].torque[recording.rows(foot), column]
    return np.asarray(np.tanh(torque / max(SOFT * float(np.std(torque)), 1e-12)))
