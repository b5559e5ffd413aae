"""By how much the IMU is turned in its mount: steps show it, those of a robot that turns best.

While a robot steps, its hips turn the ankles beside the IMU: of a mount turned by ε each bush's angles are off by ε as
that ankle sees it then, which no spring explains. All axes of all feet tell of the same ε.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from plantar.conventions import SHOWN
from plantar.feet.foot_fit import FittedFoot
from plantar.feet.internal_error import gives_up
from plantar.feet.place.imu_mount import ImuTurn, Told, turn_told, with_turns
from plantar.feet.prepare import PreparedLogs
from plantar.feet.recording import Recording
from plantar.feet.regression.tangent import Tangent
from plantar.notes import Note, Severity


def turn_shown(feet: Mapping[str, FittedFoot], found: ImuTurn, mount: float) -> ImuTurn | None:
    """What steps that are fitted show of the turn in all, beside what was `found` and put right before.

    mount: deviation of the robot file's [rad], a prior of each angle. None where no foot steps, or none shows any.
    """
    shown: list[Told] = []
    for foot, one in feet.items():
        for axis, fit in one.fits.items():
            if axis not in one.given_up and any(each.stances[foot] is not None for each in one.thin.fitted):
                with gives_up(axis, one.given_up):
                    tangent, about = with_turns(Tangent.of(fit, one.thin.fitted, False), mount)
                    shown += turn_told(tangent.least_squares, about)
    if not shown or not mount:
        return None
    before, known = np.array(found.angles), np.eye(3) / mount**2
    normal = known + np.sum([each.information for each in shown], axis=0)
    told = np.sum([each.information @ (before + each.angles) for each in shown], axis=0)
    angles = np.linalg.solve(normal, told)
    # Axes disagree by more than their noise: each bush has errors of its own.
    apart = [before + each.angles - angles for each in shown]
    missed = sum(float(own @ each.information @ own) for own, each in zip(apart, shown, strict=True))
    misfit = max(1.0, missed / max(3 * len(shown) - 3, 1))
    x, y, z = angles.tolist()
    return ImuTurn((x, y, z), np.linalg.inv((normal - known) / misfit + known))


def is_worth(shown: ImuTurn, found: ImuTurn) -> bool:
    """Whether the turn shown is clearly another one than that which was found before."""
    apart = np.abs(np.array(shown.angles) - found.angles)
    return bool((apart > SHOWN * np.sqrt(np.diag(shown.covariance))).any())


def put_right(ready: PreparedLogs, shown: ImuTurn) -> PreparedLogs:
    """The logs with all angles as an IMU that is turned so has seen them."""
    x, y, z = (np.array(shown.angles) - ready.imu_turn.angles).tolist()

    def right(recordings: Sequence[Recording]) -> tuple[Recording, ...]:
        return tuple(recording.with_imu_turned((x, y, z)) for recording in recordings)

    return replace(ready, fitted=right(ready.fitted), unseen=right(ready.unseen), imu_turn=shown)


def imu_turn_notes(turn: ImuTurn, mount: float) -> list[Note]:
    """What the IMU is turned by, where angles were put right by the opposite turn."""
    if not any(turn.angles):
        return []
    far = max(abs(angle) for angle in turn.angles) > SHOWN * mount
    severity: Severity = "warning" if far else "info"
    degrees, std = np.degrees(turn.angles), np.degrees(np.sqrt(np.diag(turn.covariance)))
    told = ", ".join(
        f"{axis} {-angle:+.2f} ± {2 * own:.2f}" for axis, angle, own in zip("xyz", degrees, std, strict=True)
    )
    text = (
        f"steps show that the IMU is turned beside the robot file's rpy, about its own axes by {told} deg (95 %): "
        "angles are put right"
    )
    return [Note("imu_turn", severity, text)]
