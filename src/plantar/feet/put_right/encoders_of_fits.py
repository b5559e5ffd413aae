"""By how much encoders are read later than the IMU: fits of feet that stand show it, more sharply than Newton's law.

Hips and a waist may turn several times as fast as the bush: half a millisecond of their encoders is then a tenth of the
damping. Newton's law tells that of one log to within a third of a millisecond at best; what the joints' rates add to
the bush's torque, beside spring and damper, tells it to some hundredths.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from plantar.conventions import SHOWN
from plantar.feet.foot_fit import FittedFoot
from plantar.feet.internal_error import gives_up
from plantar.feet.interval_width.sensor_causes import with_late_encoders
from plantar.feet.prepare import PreparedLogs
from plantar.feet.recording import Recording, has_steps
from plantar.feet.regression.load_torque import ENCODERS_APART
from plantar.feet.regression.tangent import Tangent
from plantar.sensors.delays.refined_delays import APART, LEAST_DISTINCT

# s: of K/C = 25 1/s it is a thousandth of the damping, and where joints turn ten times as fast as the bush a hundredth.
NEGLIGIBLE = 5e-5
# Of the torque: no law of a bush on a floor is better. Free of noise, what it misses passes for a millisecond where
# the joints hardly move.
MISSED_BY_LAW = 1e-4


class Late(NamedTuple):
    """How late encoders are against the IMU [s], > 0: late, and the deviation `std` [s]."""

    value: float
    std: float

    def is_worth(self, taken: float) -> bool:
        """Whether that is clearly another delay than the one `taken` [s]."""
        return abs(self.value - taken) > max(SHOWN * self.std, NEGLIGIBLE)


def newton_told(ready: PreparedLogs) -> Late | None:
    """What Newton's law says of the encoders of feet that stand; None where it says nothing of them, or a foot steps:
    there joints alone bend the bush, and late encoders are as good as damping."""
    delay = ready.sensor_delay
    told = delay.measured and not delay.doubtful and 0.0 < delay.encoders_std < APART
    if not told or any(map(has_steps, ready.recordings)):
        return None
    return Late(delay.encoders, delay.encoders_std)


def tried_first(told: Late) -> float:
    """The delay [s] at which fits are made: none, unless encoders clearly have one. Most robots read all at once."""
    return told.value if abs(told.value) >= LEAST_DISTINCT else 0.0


def read_at(ready: PreparedLogs, late: Late) -> PreparedLogs:
    """The logs with all angles as encoders show them that are `late`, and torques as late as Newton's law has them
    beside such encoders: in most motions it tells better how far both are apart than how far either is from the IMU."""
    was = ready.sensor_delay
    more = late.value - was.encoders
    also = was.follows * more

    def read(recordings: Sequence[Recording]) -> tuple[Recording, ...]:
        return tuple(one.with_encoders_later(more).with_wrenches_later(also) for one in recordings)

    feet = {foot: value + also for foot, value in was.feet.items()}
    delay = replace(was, delay=was.delay + also, feet=feet, encoders=late.value, encoders_std=late.std)
    return replace(ready, fitted=read(ready.fitted), unseen=read(ready.unseen), sensor_delay=delay)


def retold(ready: PreparedLogs) -> PreparedLogs:
    """The logs whose note of Newton's law's delays also says at which ones they are read now."""
    delay, names = ready.sensor_delay, ready.robot.feet
    each = ", ".join(f"{name} {1e3 * delay.feet.get(name, delay.delay):+.1f}" for name in names)
    text = (
        f"{delay.note.text}; fits of the standing feet then showed encoders {1e3 * delay.encoders:+.1f} ms late beside "
        f"the IMU, and all is read so (wrenches: {each} ms)"
    )
    note = replace(delay.note, text=text)
    notes = tuple(note if one == delay.note else one for one in ready.notes)
    return replace(ready, notes=notes, sensor_delay=replace(delay, note=note))


def encoders_shown(feet: Mapping[str, FittedFoot], told: Late, taken: float) -> Late | None:
    """What Newton's law `told` and all axes of all feet, fitted with encoders `taken` as so late [s], say together.

    None where no axis shows it, or something else than a delay makes such torques.
    """
    values, variances = list[float](), list[float]()
    for one in feet.values():
        shared = one.ready.settings.shared
        for axis, fit in one.fits.items():
            with gives_up(axis, one.given_up):
                wider = with_late_encoders(Tangent.of(fit, one.thin.fitted, shared))
                if wider is None:
                    continue
                found = wider.least_squares
                if not found.singular:
                    values.append(taken + float(found.values[-1]))
                    variances.append(float(found.std[-1]) ** 2 + _missed(wider) ** 2)
    if not values:
        return None
    late, known = np.array(values), 1.0 / np.array(variances)
    mean = float(known @ late / known.sum())
    # Axes disagree by more than their noise: each bush has errors of its own.
    known /= max(1.0, float(known @ (late - mean) ** 2) / max(len(late) - 1, 1))
    known, late = np.append(known, told.std**-2.0), np.append(late, told.value)
    found_late = Late(float(known @ late / known.sum()), float(known.sum() ** -0.5))
    return found_late if abs(found_late.value) < ENCODERS_APART else None


def _missed(tangent: Tangent) -> float:
    """How late encoders look [s], the last of what is fitted, where the law misses MISSED_BY_LAW of the torque."""
    torque = np.concatenate([block.response - block.response.mean() for block in tangent.blocks])
    influence = np.concatenate([own[-1] for own in tangent.influences])
    return MISSED_BY_LAW * float(np.linalg.norm(torque) * np.linalg.norm(influence))
