"""One set of assumptions for every measurement. Nothing in it but the supply of oil is fitted to a measured number.

- Bearings as the sources give them (`BEARINGS`). Where a source gives no profile, the rollers have that of ISO 16281; where
  it gives no roller diameter, rollers take 0.85 of the pitch circle; where no pitch diameter, it is the mean of bore and outside
  diameter.
- The scene's temperature is that of films. Sources give that of the ring: films are as warm or warmer, from 3 K below (the
  thermocouple) to 10 K above. Of the 32008 the source gives the temperature of the supplied oil: films are 10 K warmer, 0 to
  25 K.
- Supply of oil: `Effects.supply` of the state of lubrication. That of a bath, 0.83, was fitted to torques of the 32216 and the
  LM12700, so that the error that is quoted for a bearing is that with the supply fitted without it. Drag by the oil fill of the
  state.
- HM801349: the source tells the number of rollers, the pitch circle and the angle of the cup; the rest is estimated from the
  dimensions and C as of any catalogue bearing. Its oil is a SAE 75W-90, with the typical values that ship. Its torque is that of
  two bearings on the shaft of a pinion, less an estimate for the seal.
- Bands are those of `trbdyn.uncertainty` (`open_inputs`), the same that a user gets; what a source leaves open of a point beside
  them is in `own_bands`: load of the LM12700 2.8 to 3.8 kN, of the HM801349 a fifth either way; cup angle of the 32216 13.7 deg
  (the load zone of the source) to 15.7 deg (catalogues); temperature of the oil of the 32008 and the 32208 (FVA3 at 40 to 80 C).
- The band of a torque goes from the lowest to the highest of the laws of rolling resistance that can be defended
  (`trbdyn.run.torque_laws`).

The default is not chosen by these torques. Rolling resistance and heat follow numerical solutions of the contact
(docs/theory/lubrication.md). Boundary friction at ribs is that by which a maker gives starting torques, 0.2, and the rib's film
the formula for contacts that are long along rolling, which this one is. Other `OPTIONS` are beside it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

import trbdyn as trb
from trbdyn.extras.study import Band, open_inputs
from trbdyn.model.lubricants import REPLENISHMENT
from validation.measured import Measurement

SAMPLES, SEED = 32, 0
TURNS = 1.0
SLOWEST = 1000.0
"""Smallest speed of the points of the first table of errors (rpm)."""
FILL: Final = 0.85

CATALOGUE: Final = {
    "32216": {"bore": 0.080, "outside": 0.140, "Y": 1.4, "series": "322"},
    "32008": {"bore": 0.040, "outside": 0.068, "Y": 1.6, "series": "320X"},
    "LM12700": {"bore": 0.02199, "outside": 0.04524, "Y": 1.96, "series": "LM"},
    "HM801349": {"bore": 0.0381, "outside": 0.08255, "Y": 1.1, "series": "HM"},
}
"""Boundary dimensions (m) and axial factor Y, from catalogues."""


def _made(
    name: str, count: int, angle: float, pitch: float, diameter: float, length: float, **more: Any
) -> trb.Bearing:
    roller = trb.Roller(diameter=diameter, effective_length=length, **more.pop("roller", {}))
    return trb.Bearing(
        name=name, n_rollers=count, cup_half_angle_deg=angle, pitch_diameter=pitch, roller=roller, **more
    )


def _lm12700() -> trb.Bearing:
    pitch = 0.5 * (0.02199 + 0.04524)
    return _made("LM12700", 17, 11.533, pitch, FILL * math.pi * pitch / 17, 10.8e-3)


BEARINGS: Final[dict[str, Callable[[], trb.Bearing]]] = {
    "32216": trb.cases.bearing_32216,
    "32008": lambda: _made("32008", 23, math.degrees(0.2473), 54e-3, 0.5 * (6.131e-3 + 6.846e-3), 13.66e-3),
    "LM12700": _lm12700,
    "HM801349": lambda: trb.Bearing.from_catalogue(
        name="HM801349",
        bore=0.0381,
        outside=0.08255,
        width=0.02937,
        C=88e3,
        e=0.55,
        n_rollers=19,
        pitch_diameter=61.5e-3,
    ),
    "32208": lambda: _made(
        "32208", 17, 14.0, 60e-3, 0.5 * (9.46e-3 + 10.63e-3), 17e-3, ribs=trb.Ribs(edge_high=2.706e-3)
    ),
}

LAWS: Final = ("line_solution", "biboulet_houpert", "zhou_hoeprich", "goksem_hargreaves", "aihara", "matsuyama")
RIBS: Final[dict[str, dict[str, Any]]] = {
    "ribs: power, needle, 0.2": {},
    "ribs: power, pe, 0.2": {"rib_film": "pe"},
    "ribs: power, pe, 0.1": {"rib_film": "pe", "friction.rib_boundary_limit": 0.1},
    "ribs: asperities, needle, 0.2": {"mixed_law": "exponential"},
    "ribs: asperities, pe, 0.2": {"mixed_law": "exponential", "rib_film": "pe"},
}
"""Mixed friction at ribs: power of the film parameter, or asperities' share; film of a needle contact or of any ellipse; boundary
friction."""
OWN, FULL = "supply of the state", "full supply"
OPTIONS: Final[dict[str, dict[str, Any]]] = {
    **{f"{law}, {OWN}": {"rolling_law": law} for law in LAWS},
    **{f"{law}, {FULL}": {"rolling_law": law, "supply": 1.0} for law in LAWS},
    **{f"{LAWS[0]}, {OWN}, {name}": changes for name, changes in RIBS.items() if changes},
    f"{LAWS[0]}, {OWN}, heat by gupta": {"thermal_law": "gupta"},
    f"{LAWS[0]}, SKF's replenishment": {"supply": 1.0, "replenished": True},
}
"""Laws, supply of oil and friction of ribs beside each other."""
DEFAULT: Final = f"{LAWS[0]}, {OWN}"
PAPER: Final = "Effects.paper()"
OPTIONS[PAPER] = {
    name: getattr(trb.Effects.paper(), name)
    for name in (
        *("rolling_law", "rolling_load", "supply", "thermal_law", "rolling_pressure_force", "rib_film"),
        *("damping", "quadrature", "n_slices"),
    )
} | {"friction.rib_boundary_limit": 0.1}


def oil_of(point: Measurement) -> trb.Lubricant:
    """Oil of a measurement at the temperature of its films."""
    if point.bearing == "LM12700":  # SAE 75W; its viscosity is assumed
        return trb.lubricants.Oil(nu40=26.0, nu100=5.0, density=870.0).at(point.temperature_c)
    if point.bearing == "HM801349":  # SAE 75W-90; typical values
        return trb.lubricants.gear_75w90(point.temperature_c)
    if point.bearing == "32008":  # FVA3A
        return trb.lubricants.Oil(nu40=90.02, nu100=10.41, density=880.0).at(point.temperature_c + 10.0)
    return trb.lubricants.vg100(60.0 if math.isnan(point.temperature_c) else point.temperature_c)


def scene_of(point: Measurement, option: dict[str, Any]) -> trb.Scene:
    """The scene of a measurement, every open input at its value; `option` is one of `OPTIONS`."""
    changes = dict(option)
    fill = "oil_air" if point.supply == "jet" else point.supply
    state: dict[str, Any] = {"oil_fill": fill, "supply": "flooded" if point.supply == "flooded" else "bath"}
    if changes.pop("replenished", False):
        state["replenishment"] = REPLENISHMENT[point.supply].value
    return trb.Scene(
        BEARINGS[point.bearing](),
        speed_rpm=point.speed_rpm,
        axial_load=point.axial_load,
        radial_load=point.radial_load,
        radial_direction_deg=-90.0,
        lubricant=oil_of(point),
        effects=trb.Effects().replace(state | changes),
    )


def own_bands(point: Measurement, scene: trb.Scene) -> tuple[Band, ...]:
    """What the source of a point leaves open beside `open_inputs`, or in place of them."""
    t = scene.lubricant.temperature_c
    found = []
    load = point.axial_load
    for bearing, path, low, high, source in (
        ("32216", "bearing.cup_half_angle_deg", 13.7, 15.7, "load zone and catalogues"),
        ("LM12700", "scene.axial_load", 2800.0, 3800.0, "back-calculated"),
        ("HM801349", "scene.axial_load", 0.8 * load, 1.2 * load, "from the starting torque"),
        ("32008", "lubricant.temperature_c", t - 10.0, t + 15.0, "films over the oil that is supplied"),
        ("32208", "lubricant.temperature_c", t - 20.0, t + 20.0, "not given"),
    ):
        if bearing == point.bearing:
            found.append(Band(path=path, low=low, high=high, source=source))
    return tuple(found)


def bands_of(point: Measurement, scene: trb.Scene) -> tuple[Band, ...]:
    """Bands of the open inputs: those of a user, and those of the source."""
    own = own_bands(point, scene)
    return (*(band for band in open_inputs(scene) if band.path not in {one.path for one in own}), *own)
