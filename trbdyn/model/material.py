"""Elasticity of a bearing's parts, and roughness of their surfaces."""

from __future__ import annotations

from typing import Annotated, ClassVar, Self

from trbdyn.base.validation import Model, Number
from trbdyn.model.core_table import parameter


class Material(Model):
    """Elasticity of a body.

    Parameters
    ----------
    youngs_modulus : float
        Young's modulus (Pa).
    poisson_ratio : float
        Poisson's ratio (1).
    """

    _assumed: ClassVar[bool] = True

    youngs_modulus: Annotated[Number, parameter("youngs_modulus")] = 206e9
    poisson_ratio: Annotated[Number, parameter("poisson_ratio")] = 0.3

    @classmethod
    def steel(cls) -> Self:
        """Bearing steel: 206 GPa, 0.3."""
        return cls(youngs_modulus=206e9, poisson_ratio=0.3)

    @classmethod
    def silicon_nitride(cls) -> Self:
        """Silicon nitride of rollers: 310 GPa, 0.26; give the rollers a density of 3200 kg/m3."""
        return cls(youngs_modulus=310e9, poisson_ratio=0.26)

    @classmethod
    def polyamide(cls) -> Self:
        """Polyamide 66 with a quarter of glass fibre at 60 C, conditioned: 3.5 GPa, 0.4; such a cage weighs a sixth of
        steel.
        """
        return cls(youngs_modulus=3.5e9, poisson_ratio=0.4)

    @classmethod
    def brass(cls) -> Self:
        """Brass of machined cages: 100 GPa, 0.34."""
        return cls(youngs_modulus=100e9, poisson_ratio=0.34)


class Roughness(Model):
    """Composite rms roughness of the rolling contacts.

    Parameters
    ----------
    raceway : float
        Roller and raceway (m).
    rib : float
        Roller end and back-face rib (m).
    """

    _assumed: ClassVar[bool] = True

    raceway: Annotated[Number, parameter("roughness_raceway")] = 0.16e-6
    rib: Annotated[Number, parameter("roughness_rib")] = 0.24e-6
