"""Laws of the bush, one file each: torque from the history of deflection and rate."""

from plantar.models.kelvin_voigt import KelvinVoigt

__all__ = ["KelvinVoigt"]
