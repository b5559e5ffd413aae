"""What a robot file's numbers and the robot's sensors may be off by: the section `uncertainty`."""

from __future__ import annotations

from dataclasses import dataclass, field, replace


def _deviation(default: float, meaning: str) -> float:
    """A field whose `meaning` holds its unit and what it stands for."""
    return field(default=default, metadata={"meaning": meaning})


@dataclass(frozen=True)
class Uncertainty:
    """Standard deviations, each the same in all recordings of one robot; the defaults are a careful lab's."""

    wrench_gain: float = _deviation(0.01, "share, of each channel of a force sensor")
    wrench_crosstalk: float = _deviation(0.004, "N.m/N, and between channels of a kind")
    wrench_delay: float = _deviation(0.0075, "s, of the force sensors behind encoders and IMU")
    bush_position: float = _deviation(0.003, "m, each of x, y, z")
    encoder_zero: float = _deviation(0.001, "rad, each joint")
    joint_compliance: float = _deviation(
        0.0, "rad/N.m, by which each joint bends beyond its encoder: one before a gear sees none of it"
    )
    imu_mount: float = _deviation(0.01, "rad, about each axis")
    link_mass: float = _deviation(0.05, "share, of each link's mass")
    total_mass: float = _deviation(0.005, "share, of the robot's `mass` where it was weighed")
    link_com: float = _deviation(0.005, "m, of each link's centre of mass, each axis")
    between_recordings: float = _deviation(
        0.0, "share by which stiffness and damping may differ from recording to recording"
    )

    @property
    def exact(self) -> bool:
        """Whether the robot is exactly what its file says, as a simulated one is; what its logs show aside."""
        return self == replace(
            EXACT, wrench_delay=self.wrench_delay, between_recordings=self.between_recordings
        )


# Of a robot that is exactly what its file says, as a simulated one is. Its sensors may be late all the same.
EXACT = Uncertainty(
    wrench_gain=0.0,
    wrench_crosstalk=0.0,
    bush_position=0.0,
    encoder_zero=0.0,
    imu_mount=0.0,
    link_mass=0.0,
    total_mass=0.0,
    link_com=0.0,
)
