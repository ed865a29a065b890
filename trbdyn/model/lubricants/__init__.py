"""Oils: viscosity against temperature and pressure.

An `Oil` knows its viscosity at every temperature; a `Lubricant` is an oil at one temperature. Oils that ship: ISO VG
32 to 460 of ordinary mineral oil, FVA3 (the measured VG 100 of the test rig), two gear oils and an ATF; others are
made from the two viscosities of a data sheet: ``Oil(nu40=68.0, nu100=8.7, density=880.0)``. Each has a function by its
name that takes the temperature: ``trb.lubricants.vg68(70.0)``. Names are imported when they are first used.
"""

# ruff: isort: skip_file
from __future__ import annotations

from typing import TYPE_CHECKING

from trbdyn.base.lazy import lazy_names

if TYPE_CHECKING:
    from trbdyn.model.lubricants.lubricant import ATF as ATF, FVA3 as FVA3, MINERAL as MINERAL
    from trbdyn.model.lubricants.lubricant import GEAR_75W90 as GEAR_75W90, GEAR_80W90 as GEAR_80W90
    from trbdyn.model.lubricants.lubricant import HIGHEST_TEMPERATURE_C as HIGHEST_TEMPERATURE_C
    from trbdyn.model.lubricants.lubricant import LOWEST_MEASURED_C as LOWEST_MEASURED_C
    from trbdyn.model.lubricants.lubricant import LOWEST_TEMPERATURE_C as LOWEST_TEMPERATURE_C
    from trbdyn.model.lubricants.lubricant import TEMPERATURES as TEMPERATURES
    from trbdyn.model.lubricants.lubricant import Lubricant as Lubricant, Oil as Oil, PressureLaw as PressureLaw
    from trbdyn.model.lubricants.shipped import OILS as OILS, iso_vg as iso_vg
    from trbdyn.model.lubricants.shipped import vg32 as vg32, vg46 as vg46, vg68 as vg68, vg100 as vg100, vg150 as vg150
    from trbdyn.model.lubricants.shipped import vg220 as vg220, vg320 as vg320, vg460 as vg460, fva3 as fva3
    from trbdyn.model.lubricants.shipped import gear_75w90 as gear_75w90, gear_80w90 as gear_80w90, atf as atf
    from trbdyn.model.lubricants.supply import OIL_SUPPLIES as OIL_SUPPLIES, OilSupply as OilSupply
    from trbdyn.model.lubricants.supply import REPLENISHMENT as REPLENISHMENT, Replenishment as Replenishment
    from trbdyn.model.lubricants.supply import ROLLING_SUPPLY as ROLLING_SUPPLY, RollingSupply as RollingSupply
    from trbdyn.model.lubricants.supply import bath_fill as bath_fill, supply_of as supply_of
    from trbdyn.model.lubricants.supply import rolling_supply_of as rolling_supply_of
    from trbdyn.model.lubricants.supply import replenishment_decline as replenishment_decline
    from trbdyn.model.lubricants.viscosity import Dicke as Dicke, Vogel as Vogel
    from trbdyn.model.lubricants.viscosity import astm_d341 as astm_d341, wooster as wooster

__all__, __getattr__, __dir__ = lazy_names(__name__, __file__)
