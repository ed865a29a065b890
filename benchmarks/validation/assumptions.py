"""One set of assumptions for every measurement, written down before the runs. Nothing in it is fitted to a measured number.

- Bearings as the sources give them (`BEARINGS`). Where a source gives no profile, the rollers have that of ISO/TS 16281; where
  it gives no roller diameter, rollers take 0.85 of the pitch circle; where no pitch diameter, it is the mean of bore and outside
  diameter.
- The scene's temperature is that of films. Sources give that of the ring: films are as warm or warmer, from 3 K below (the
  thermocouple) to 10 K above. Of the 32008 the source gives the temperature of the supplied oil: films are 10 K warmer, 0 to
  25 K.
- Supply of oil: SKF's replenishment of the state of lubrication, with the band of that state. Drag by the oil fill of that
  state.
- Roughness 0.7 to 1.5 times the default, boundary friction 0.07 to 0.2 (raceways), 0.1 to 0.2 (ribs).
- An assumed profile's a_p from 0 (straight) to 0.0005; load of the LM12700 2.8 to 3.8 kN; cup angle of the 32216 13.7 deg (the
  load zone of the source) to 15.7 deg (catalogues); oil of the 32208 FVA3 at 40 to 80 C.
- The band of a torque goes from the lowest to the highest of the laws of rolling resistance that can be defended
  (`trbdyn.run.torque_laws`).

The rule by which the default is chosen, written down before the runs: of all `OPTIONS`, in which the torques of both rings
agree, the one with the smallest mean absolute error over all measured torques at 1000 rpm and above. The runner-up is named.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import Any, Final

import trbdyn as trb
from trbdyn.model.lubricants import OIL_SUPPLIES, REPLENISHMENT
from trbdyn.study import Band
from validation.measured import Measurement

SAMPLES, SEED = 32, 0
TURNS = 4.0
SLOWEST = 1000.0
"""Smallest speed of the points by which the default is chosen (rpm)."""
FILL: Final = 0.85

CATALOGUE: Final = {
    "32216": {"bore": 0.080, "outside": 0.140, "Y": 1.4, "series": "322"},
    "32008": {"bore": 0.040, "outside": 0.068, "Y": 1.6, "series": "320X"},
    "LM12700": {"bore": 0.02199, "outside": 0.04524, "Y": 1.96, "series": "LM"},
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
    "32208": lambda: _made(
        "32208", 17, 14.0, 60e-3, 0.5 * (9.46e-3 + 10.63e-3), 17e-3, ribs=trb.Ribs(edge_high=2.706e-3)
    ),
}

RIBS: Final[dict[str, dict[str, Any]]] = {
    "ribs of the paper": {},
    "ribs of Aihara": {"mixed_law": "exponential", "rib_film": "needle", "friction.rib_boundary_limit": 0.2},
}
"""Mixed friction at ribs: power of the film parameter and 0.1; or asperities' share, the film of a needle contact and 0.2."""

LAWS: Final = ("zhou_hoeprich", "goksem_hargreaves", "aihara", "matsuyama", "biboulet_houpert")
OPTIONS: Final = {
    f"{law}, heat by {heat}, {supply}, {ribs}": {
        "rolling_law": law,
        "thermal_law": heat,
        "supplied": supply == "supply by state",
        **RIBS[ribs],
    }
    for law, heat, supply, ribs in itertools.product(
        LAWS, ("gupta", "aihara"), ("full supply", "supply by state"), RIBS
    )
}
"""Laws and supply of oil beside each other."""
PAPER: Final = "Effects.paper()"
OPTIONS[PAPER] = {
    name: getattr(trb.Effects.paper(), name)
    for name in (
        "rolling_law",
        "thermal_law",
        "rolling_pressure_force",
        "rib_film",
        "damping",
        "quadrature",
        "n_slices",
    )
} | {"supplied": False}
"""The rule leaves it out: the torques of its rings do not agree."""


def oil_of(point: Measurement) -> trb.Lubricant:
    """Oil of a measurement at the temperature of its films."""
    if point.bearing == "LM12700":  # SAE 75W; its viscosity is assumed
        return trb.lubricants.Oil(nu40=26.0, nu100=5.0, density=870.0).at(point.temperature_c)
    if point.bearing == "32008":  # FVA3A
        return trb.lubricants.Oil(nu40=90.02, nu100=10.41, density=880.0).at(point.temperature_c + 10.0)
    return trb.lubricants.vg100(60.0 if math.isnan(point.temperature_c) else point.temperature_c)


def scene_of(point: Measurement, option: dict[str, Any]) -> trb.Scene:
    """The scene of a measurement, every open input at its value; `option` is one of `OPTIONS`."""
    changes = dict(option)
    supply = REPLENISHMENT[point.supply].value if changes.pop("supplied") else 0.0
    fill = "oil_air" if point.supply == "jet" else point.supply
    common = trb.Effects(oil_fill=fill, replenishment=supply, thermal_law="gupta", mixed_law="power", rib_film="pe")
    return trb.Scene(
        BEARINGS[point.bearing](),
        speed_rpm=point.speed_rpm,
        axial_load=point.axial_load,
        radial_load=point.radial_load,
        radial_direction_deg=-90.0,
        lubricant=oil_of(point),
        effects=common.replace(changes),
    )


def bands_of(point: Measurement, scene: trb.Scene) -> tuple[Band, ...]:
    """Bands of the open inputs."""
    rough, state, t = scene.bearing.roughness, REPLENISHMENT[point.supply], scene.lubricant.temperature_c
    fill = OIL_SUPPLIES["oil_air" if point.supply == "jet" else point.supply]
    cooler, warmer = {"32008": (10.0, 15.0), "32208": (20.0, 20.0)}.get(point.bearing, (3.0, 10.0))

    def band(path: str, low: float, high: float, source: str) -> Band:
        return Band(path=path, low=low, high=high, source=source)

    found = [
        band("lubricant.temperature_c", t - cooler, t + warmer, "films over what was measured"),
        band("effects.replenishment", state.low, state.high, state.words),
        band("effects.oil_fill", fill.low, fill.high, fill.words),
        band("bearing.roughness.raceway", 0.7 * rough.raceway, 1.5 * rough.raceway, "finishing"),
        band("bearing.roughness.rib", 0.7 * rough.rib, 1.5 * rough.rib, "finishing"),
        band("effects.friction.boundary_limit", 0.07, 0.2, "published"),
        band("effects.friction.rib_boundary_limit", 0.1, 0.2, "published"),
    ]
    if point.bearing == "32216":
        found.append(band("bearing.cup_half_angle_deg", 13.7, 15.7, "load zone and catalogues"))
    else:
        found.append(band("bearing.roller.profile.a_p", 0.0, 0.0005, "straight to ISO/TS 16281"))
    if point.bearing == "LM12700":
        found.append(band("scene.axial_load", 2800.0, 3800.0, "back-calculated"))
    return tuple(found)
