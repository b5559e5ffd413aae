"""The zero of the yaw torque, which roll's torque, cos(pitch)·τ_x - sin(pitch)·τ_z, does not take for a constant."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from plantar.conventions import Array
from plantar.estimation import Block, fit_blocks
from plantar.feet.interval_width.cause import Cause
from plantar.feet.regression.regression_data import all_beside
from plantar.feet.regression.tangent import Tangent


class YawZeros(NamedTuple):
    """What a unit of each recording's zero adds to roll's torque, `columns` (n, recordings) of each block, and the
    `usual` zero [N·m]: as large as the others' are, which offsets hold."""

    columns: list[Array]
    usual: float


def yaw_zeros(tangent: Tangent) -> YawZeros | None:
    """Of the recordings of each block; None about pitch, and of feet that step, whose zeros were read in the air."""
    fit = tangent.fit
    if fit.axis != "roll" or tangent.steps:
        return None
    pitch = tangent.rows(lambda one: one.bushes[fit.foot].deflection[:, 0])
    columns = [np.outer(np.sin(angle), own) for angle, own in zip(pitch, np.eye(len(pitch)), strict=True)]
    return YawZeros(columns, float(np.sqrt(np.mean(np.square(list(fit.offsets.values()))))))


def yaw_torque_zero(zeros: YawZeros, tangent: Tangent) -> Cause:
    """What the zeros may do to the fit: motions that show them smaller than is usual are believed."""
    count, usual = len(tangent.blocks), zeros.usual
    found, size = tangent.beside(zeros.columns).least_squares, np.full(count, usual)
    if usual and not found.singular:
        told, unsure = found.values[-count:], found.std[-count:]
        keeps = usual**2 / (usual**2 + unsure**2)
        size = np.minimum(np.hypot(keeps * told, np.sqrt(keeps) * unsure), usual)
    return Cause("yaw torque zero", np.linalg.norm(tangent.effect(zeros.columns) * size, axis=1), 1.0)


def fit_beside(zeros: YawZeros | None, blocks: Sequence[Block]) -> tuple[Array, Array]:
    """Values (k,) of the blocks' fit and their covariance (k, k), the zeros as free as is usual.

    A fit beside zeros of which nothing is known, updated with what is known of them before: their mean is none.
    """
    size = blocks[0].regressor.shape[1]
    if zeros is not None and zeros.usual:
        found = fit_blocks(all_beside(blocks, zeros.columns))
        if not found.singular:
            own = slice(size, len(found.values))
            covariance = found.covariance[: own.stop, : own.stop]  # without the offsets'
            spread = covariance[own, own] + zeros.usual**2 * np.eye(len(blocks))
            gain = np.linalg.solve(spread, covariance[own]).T
            values, covariance = (each - gain @ each[own] for each in (found.values, covariance))
            return values[:size], covariance[:size, :size]
    found = fit_blocks(blocks)
    return found.values[:size], found.covariance[:size, :size]
