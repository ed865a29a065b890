"""Lubricants of the oils that ship, by name and grade."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, Final

from pydantic import BeforeValidator

from trbdyn.errors import InputError, Problem
from trbdyn.model.lubricants.lubricant import FVA3, MINERAL, SHIPPED, Lubricant, PressureLaw


def vg100(
    temperature_c: float = 60.0,
    *,
    pressure_law: PressureLaw = "dicke",
    eyring_stress: float = 5e6,
) -> Lubricant:
    """ISO VG100: the mineral oil FVA3.

    Parameters
    ----------
    temperature_c : float
        Temperature of the oil (C), -20 to 200.
    pressure_law : {'dicke', 'roelands', 'barus'}
        Law of viscosity against pressure; the measured one is Dicke's.
    eyring_stress : float
        tau0, characteristic shear stress (Pa).

    Returns
    -------
    Lubricant
        eta0(t) = 0.062 exp[1021.7/(t + 101.55)] mPa s (34.59 mPa s at 60 C), beta = 1021.7/(t + 101.55)^2 (0.0392 1/K
        at 60 C), alpha0 = slope of the Dicke law at zero pressure (1.97e-8 1/Pa at 60 C).

    Raises
    ------
    InputError
        If the temperature lies outside the range.

    Notes
    -----
    Source: Wingertszahn 2023, Lubricants 11:369.
    """
    return FVA3.at(temperature_c, pressure_law=pressure_law, eyring_stress=eyring_stress)


def iso_vg(grade: int, temperature_c: float = 60.0, *, eyring_stress: float = 5e6) -> Lubricant:
    """An ordinary mineral oil of an ISO viscosity grade.

    Parameters
    ----------
    grade : int
        ISO VG: 32, 46, 68, 100, 150, 220, 320 or 460. The measured VG 100 of the test rig is `vg100`.
    temperature_c : float
        Temperature of the oil (C), -40 to 200.
    eyring_stress : float
        tau0, characteristic shear stress (Pa).

    Returns
    -------
    Lubricant
        Viscosity by ASTM D341 from the grade at 40 C and the typical one at 100 C, alpha0 by `wooster`, law of
        Roelands.

    Raises
    ------
    InputError
        If there is no such grade, or the temperature lies outside the range.

    Examples
    --------
    >>> import trbdyn as trb
    >>> round(1e6 * trb.lubricants.iso_vg(220, 40.0).kinematic_viscosity, 6)
    220.0
    """
    if isinstance(grade, bool) or grade not in MINERAL:
        raise InputError.of("grade", grade, f"must be one of {', '.join(str(known) for known in MINERAL)}")
    return MINERAL[grade].at(temperature_c, eyring_stress=eyring_stress)


fva3 = vg100


def _named(name: str) -> Callable[..., Lubricant]:
    """A function that gives an oil that ships at a temperature (C), 60 by default; other fields are those of `Lubricant`."""
    oil = SHIPPED[name]

    def made(temperature_c: float = 60.0, **fields: Any) -> Lubricant:
        return Lubricant(oil=oil, temperature_c=temperature_c, **fields)

    made.__name__ = made.__qualname__ = name
    made.__doc__ = f"""{oil.name} at a temperature.

    Parameters
    ----------
    temperature_c : float
        Temperature of the oil (C).
    **fields
        Other fields of `Lubricant`.

    Returns
    -------
    Lubricant
    """
    return made


vg32, vg46, vg68, vg150, vg220, vg320, vg460 = (_named(f"vg{grade}") for grade in MINERAL if grade != 100)
gear_75w90, gear_80w90, atf = (_named(name) for name in ("gear_75w90", "gear_80w90", "atf"))

OILS: Final[dict[str, Callable[..., Lubricant]]] = {
    "vg100": vg100,
    "fva3": vg100,
    **{made.__name__: made for made in (vg32, vg46, vg68, vg150, vg220, vg320, vg460, gear_75w90, gear_80w90, atf)},
}
"""Oils that ship, by name: each takes ``temperature_c`` (60 by default)."""


def _by_name(given: Any) -> Any:
    if not isinstance(given, str):
        return given
    if given.lower() not in OILS:
        limit = f"must be one of {', '.join(OILS)}, a Lubricant, or an Oil at a temperature: oil.at(60.0)"
        raise InputError([Problem((), given, limit)])
    return OILS[given.lower()]()


AnyLubricant = Annotated[Lubricant, BeforeValidator(_by_name)]
"""A field that takes a lubricant, or the name of an oil that ships, which stands for it at 60 C."""
