"""Oils: viscosity against temperature and pressure.

An `Oil` knows its viscosity at every temperature; a `Lubricant` is an oil at one temperature. Oils that ship: ISO VG
32 to 460 of ordinary mineral oil, FVA3 (the measured VG 100 of the test rig), two gear oils and an ATF; others are
made from the two viscosities of a data sheet: ``Oil(nu40=68.0, nu100=8.7, density=880.0)``. Each has a function by its
name that takes the temperature: ``trb.lubricants.vg68(70.0)``.
"""

from trbdyn.model.lubricants.lubricant import (
    ATF,
    FVA3,
    GEAR_75W90,
    GEAR_80W90,
    HIGHEST_TEMPERATURE_C,
    LOWEST_MEASURED_C,
    LOWEST_TEMPERATURE_C,
    MINERAL,
    Lubricant,
    Oil,
    PressureLaw,
)
from trbdyn.model.lubricants.shipped import (
    OILS,
    atf,
    fva3,
    gear_75w90,
    gear_80w90,
    iso_vg,
    vg32,
    vg46,
    vg68,
    vg100,
    vg150,
    vg220,
    vg320,
    vg460,
)
from trbdyn.model.lubricants.supply import (
    OIL_SUPPLIES,
    REPLENISHMENT,
    OilSupply,
    Replenishment,
    bath_fill,
    replenishment_decline,
    supply_of,
)
from trbdyn.model.lubricants.viscosity import Dicke, Vogel, astm_d341, wooster

__all__ = [
    "ATF",
    "FVA3",
    "GEAR_75W90",
    "GEAR_80W90",
    "HIGHEST_TEMPERATURE_C",
    "LOWEST_MEASURED_C",
    "LOWEST_TEMPERATURE_C",
    "MINERAL",
    "OILS",
    "OIL_SUPPLIES",
    "REPLENISHMENT",
    "Dicke",
    "Lubricant",
    "Oil",
    "OilSupply",
    "PressureLaw",
    "Replenishment",
    "Vogel",
    "astm_d341",
    "atf",
    "bath_fill",
    "fva3",
    "gear_75w90",
    "gear_80w90",
    "iso_vg",
    "replenishment_decline",
    "supply_of",
    "vg32",
    "vg46",
    "vg68",
    "vg100",
    "vg150",
    "vg220",
    "vg320",
    "vg460",
    "wooster",
]

for _module in ("lubricant", "shipped", "viscosity"):
    globals().pop(_module, None)  # files of this package, not names for users; `import` goes on to find them


def __dir__() -> list[str]:
    return sorted(__all__)
