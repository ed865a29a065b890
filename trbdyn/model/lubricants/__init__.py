"""Oils: viscosity against temperature and pressure.

An `Oil` knows its viscosity at every temperature; a `Lubricant` is an oil at one temperature. Oils that ship: ISO VG
32 to 460 of ordinary mineral oil, FVA3 (the measured VG 100 of the test rig), two gear oils and an ATF; others are
made from the two viscosities of a data sheet: ``Oil(nu40=68.0, nu100=8.7, density=880.0)``.
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
from trbdyn.model.lubricants.shipped import OILS, fva3, iso_vg, vg100
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
    "Dicke",
    "Lubricant",
    "Oil",
    "PressureLaw",
    "Vogel",
    "astm_d341",
    "fva3",
    "iso_vg",
    "vg100",
    "wooster",
]
