"""A recording of one foot made of arrays: what comes before the fit is left out, so a test knows every number."""

from __future__ import annotations

import numpy as np

from plantar.contact.deflection import BushState
from plantar.contact.phases import FootContact
from plantar.contact.stances import Stances
from plantar.feet.recording import Recording, Role
from plantar.feet.regression.prediction import Prediction
from plantar.logs.motion_log import MotionLog
from plantar.sensors.attitude_scale import AttitudeScale

PERIOD = 0.01
FOOT = "left"
LOAD = 300.0  # N


def predicted_torque(torque: np.ndarray) -> Prediction:
    """A prediction (N,) of the bush alone, every sample scored."""
    return Prediction(torque, torque, np.zeros(len(torque)), np.ones(len(torque), dtype=bool))


def made_recording(
    name: str,
    deflection: np.ndarray,
    torque: np.ndarray,
    *,
    rate: np.ndarray | None = None,
    role: Role = "fit",
    stances: Stances | None = None,
    cutoff: float = 5.0,
) -> Recording:
    """Pitch and roll alike, (N,): `deflection` [rad], `rate` [rad/s] (differences where left out), `torque` [N·m]."""
    count = len(deflection)
    rate = np.gradient(deflection, PERIOD) if rate is None else rate
    wrench = np.zeros((count, 6))
    wrench[:, 2] = LOAD
    state = BushState(
        deflection=np.column_stack([deflection, deflection]),
        rate=np.column_stack([rate, rate]),
        wrench=wrench,
        torque=np.column_stack([torque, torque]),
        force_z=np.full(count, LOAD),
        cop=np.zeros((count, 2)),
        sole_position=np.zeros((count, 3)),
        heading=np.zeros(count),
    )
    contact = FootContact(np.zeros(count, dtype=np.int8), np.zeros(count, dtype=np.int8))
    return Recording(
        log=MotionLog(name, PERIOD * np.arange(count), {}),
        role=role,
        cutoff=cutoff,
        raw={FOOT: state},
        bushes={FOOT: state},
        contacts={FOOT: contact},
        stances={FOOT: stances},
        noise={FOOT: np.zeros((2, 2))},
        places={FOOT: np.zeros((count, 2))},
        notes=(),
        zeros=(),
        imu_turns={},
        encoder_rates={},
        attitude_scale=AttitudeScale(),
    )


def swayed(count: int = 3000, amplitude: float = 0.03, seed: int = 0) -> np.ndarray:
    """A deflection (N,) [rad] of two sines, of other phases for each seed."""
    first, second = np.random.default_rng(seed).uniform(0, 2 * np.pi, 2)
    time = PERIOD * np.arange(count)
    slow, fast = np.sin(2 * np.pi * 0.3 * time + first), np.sin(2 * np.pi * 0.9 * time + second)
    return np.asarray(amplitude * slow + 0.3 * amplitude * fast)
