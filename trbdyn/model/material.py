"""What a bearing's parts are made of, and roughness of their surfaces."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Final, Self

from pydantic import model_validator

from trbdyn.base.validation import Model, Number, unit
from trbdyn.model.core_table import parameter

STEEL: Final = {
    "youngs_modulus": 206e9,
    "poisson_ratio": 0.3,
    "density": 7810.0,
    "expansion": 12e-6,
    "damping_ratio": 0.002,
}


class Material(Model):
    """Elasticity, density, thermal expansion and damping of a material. ``Material()`` is bearing steel. Where anything is given,
    the last three are not assumed: what needs one that is missing asks for it.

    Parameters
    ----------
    youngs_modulus : float
        Young's modulus (Pa).
    poisson_ratio : float
        Poisson's ratio (1).
    density : float, optional
        Density (kg/m3).
    expansion : float, optional
        Coefficient of linear thermal expansion (1/K).
    damping_ratio : float, optional
        Damping of a mode of vibration over the critical one, half of the loss factor (1).

    Examples
    --------
    >>> import trbdyn as trb
    >>> trb.Material.polyamide().density, trb.Material(youngs_modulus=70e9, poisson_ratio=0.33).density
    (1320.0, None)
    """

    _assumed: ClassVar[bool] = True

    youngs_modulus: Annotated[Number, parameter("youngs_modulus")] = STEEL["youngs_modulus"]
    poisson_ratio: Annotated[Number, parameter("poisson_ratio")] = STEEL["poisson_ratio"]
    density: Annotated[Number | None, unit("kg/m3", ge=100, le=25e3)] = None
    expansion: Annotated[Number | None, unit("1/K", ge=0, le=1e-3)] = None
    damping_ratio: Annotated[Number | None, unit("1", ge=0, le=0.5)] = None

    @model_validator(mode="before")
    @classmethod
    def _steel_unless_given(cls, values: Any) -> Any:
        return dict(STEEL) if isinstance(values, Mapping) and not values else values

    @classmethod
    def steel(cls) -> Self:
        """Bearing steel: 206 GPa, 0.3, 7810 kg/m3, 12e-6 1/K (Harris, Rolling Bearing Analysis). Damping ratio 0.002: assumed, a
        part without joints; 0.0005 to 0.005 are found.
        """
        return cls(**STEEL)

    @classmethod
    def silicon_nitride(cls) -> Self:
        """Silicon nitride of rollers: 310 GPa, 0.26, 3200 kg/m3, 3.2e-6 1/K (Harris). Damping ratio 0.001: assumed."""
        return cls(youngs_modulus=310e9, poisson_ratio=0.26, density=3200.0, expansion=3.2e-6, damping_ratio=0.001)

    @classmethod
    def polyamide(cls) -> Self:
        """PA66-GF25, polyamide 66 with a quarter of glass fibre, at 60 C and conditioned: 3.5 GPa, 0.4, 1320 kg/m3. Makers
        of such grades give 25 to 35e-6 1/K along the flow of injection and 60 to 70e-6 across it: 50e-6 1/K is between them. The
        damping ratio 0.03 is assumed; 0.02 to 0.05 are found near 60 C, where the glass transition of moist polyamide lies.
        """
        return cls(youngs_modulus=3.5e9, poisson_ratio=0.4, density=1320.0, expansion=50e-6, damping_ratio=0.03)

    @classmethod
    def peek(cls) -> Self:
        """PEEK without fibres: 4.1 GPa, 1320 kg/m3, 47e-6 1/K below 143 C (Cerobear, cages of plastic). Poisson's ratio 0.4
        and the damping ratio 0.01 are assumed.
        """
        return cls(youngs_modulus=4.1e9, poisson_ratio=0.4, density=1320.0, expansion=47e-6, damping_ratio=0.01)

    @classmethod
    def brass(cls) -> Self:
        """Brass of machined cages, CuZn40Pb: 100 GPa, 0.34, 8400 kg/m3, 20.5e-6 1/K (EN 12164 grades, makers' sheets).
        Damping ratio 0.003: assumed.
        """
        return cls(youngs_modulus=100e9, poisson_ratio=0.34, density=8400.0, expansion=20.5e-6, damping_ratio=0.003)

    @classmethod
    def aluminium(cls) -> Self:
        """Aluminium of cast housings, AlSi: 72 GPa, 0.33, 2700 kg/m3; 23.5e-6 1/K, of AlSi10Mg 21 to 22e-6 (EN 1706). Damping
        ratio 0.002: assumed.
        """
        return cls(youngs_modulus=72e9, poisson_ratio=0.33, density=2700.0, expansion=23.5e-6, damping_ratio=0.002)

    @classmethod
    def grey_iron(cls) -> Self:
        """Grey cast iron of housings, EN-GJL-250: 110 GPa, 0.26, 7200 kg/m3, 11.7e-6 1/K (EN 1561, annex). Damping ratio
        0.005: assumed.
        """
        return cls(youngs_modulus=110e9, poisson_ratio=0.26, density=7200.0, expansion=11.7e-6, damping_ratio=0.005)


class Roughness(Model):
    """Composite rms roughness of the rolling contacts.

    Parameters
    ----------
    raceway : float
        Roller and raceway (m).
    rib : float
        Roller end and back-face rib (m).
    pocket : float
        Roller and bar of the cage (m); the film between them (`Effects.pocket_film`) is no thinner.
    """

    _assumed: ClassVar[bool] = True

    raceway: Annotated[Number, parameter("roughness_raceway")] = 0.16e-6
    rib: Annotated[Number, parameter("roughness_rib")] = 0.24e-6
    pocket: Annotated[Number, parameter("roughness_pocket")] = 1e-6
