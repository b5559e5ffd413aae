"""Bush models, one file each: torque from the history of deflection and rate."""

from plantar.models.bouc_wen import BoucWen
from plantar.models.bush_model import BESIDE, BushModel, BushMotion, reach
from plantar.models.coulomb import Coulomb
from plantar.models.coupled import Coupled
from plantar.models.elastoplastic import Elastoplastic
from plantar.models.hardening import Hardening
from plantar.models.hardening_elastoplastic import HardeningElastoplastic
from plantar.models.iwan import Iwan
from plantar.models.kelvin_voigt import KelvinVoigt
from plantar.models.standard_linear_solid import StandardLinearSolid

MODELS: dict[str, BushModel] = {
    model.name: model
    for model in (
        KelvinVoigt(),
        Hardening(),
        Coulomb(),
        Elastoplastic(),
        HardeningElastoplastic(),
        Iwan(),
        BoucWen(),
        StandardLinearSolid(),
        Coupled(),
    )
}

__all__ = [
    "BESIDE",
    "MODELS",
    "BoucWen",
    "BushModel",
    "BushMotion",
    "Coulomb",
    "Coupled",
    "Elastoplastic",
    "Hardening",
    "HardeningElastoplastic",
    "Iwan",
    "KelvinVoigt",
    "StandardLinearSolid",
    "reach",
]
