"""What a robot file's numbers and the robot's sensors may be off by: the section `uncertainty`."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

Deviation = Annotated[float, Field(ge=0, allow_inf_nan=False)]


class Uncertainty(BaseModel):
    """Standard deviations, each the same in all recordings of one robot; the defaults are a careful lab's.

    A field's description holds its unit and what it stands for.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    wrench_gain: Annotated[Deviation, Field(description="share, of each channel of a force sensor")] = 0.01
    wrench_crosstalk: Annotated[Deviation, Field(description="N.m/N, and between channels of a kind")] = 0.004
    wrench_delay: Annotated[
        Deviation, Field(description="s, of the force sensors behind encoders and IMU")
    ] = 0.0075
    bush_position: Annotated[Deviation, Field(description="m, each of x, y, z")] = 0.003
    encoder_zero: Annotated[Deviation, Field(description="rad, each joint")] = 0.001
    imu_mount: Annotated[Deviation, Field(description="rad, about each axis")] = 0.01
    link_mass: Annotated[Deviation, Field(description="share, of each link's mass")] = 0.05
    total_mass: Annotated[
        Deviation, Field(description="share, of the robot's `mass` where it was weighed")
    ] = 0.005
    link_com: Annotated[Deviation, Field(description="m, of each link's centre of mass, each axis")] = 0.005
    between_recordings: Annotated[
        Deviation,
        Field(description="share by which stiffness and damping may differ from recording to recording"),
    ] = 0.0


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
