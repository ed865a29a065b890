"""Wear of raceways, rollers, ribs and pockets by Archard's law, and where rollers are heated most by sliding.

Archard: a surface loses the volume k F s for a load F that slides by s. Where a film carries a part of the load, only what
asperities carry wears. Records of a run are evaluated again by the core, node by node along each roller; their mean is the rate
of wear. The coefficient k of an actual pair of surfaces in its oil is known to a power of ten at best: compare designs, and
places of one design (docs/theory/cage.md#wear).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn import laws
from trbdyn.base.expected import expect
from trbdyn.base.validation import number_of
from trbdyn.errors import InputError
from trbdyn.results import fields as field_table
from trbdyn.results.result import Result
from trbdyn.run.replay import Replay

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

HOUR: Final = 3600.0
HEIGHTS: Final = 24
"""Places over the height of the rib."""
RACES: Final = ("outer", "inner")


def wear(result: Result, *, coefficient: float, records: int = 200, bins: int = 72) -> xarray.Dataset:
    """Rates of wear by Archard's law, and the largest power of friction for the area of a contact.

    Parameters
    ----------
    result : Result
        A settled run (`Result.window`); needs the groups time, rollers and cage.
    coefficient : float
        k: volume that a surface loses for a load and a way of sliding (m3/(N m) = m2/N). For steel in mixed lubrication 1e-18 to
        1e-16 are usual, a tenth to a hundredth of that where additives work well.
    records : int
        Number of records to evaluate, spread over the run.
    bins : int
        Number of places around the bearing.

    Returns
    -------
    xarray.Dataset
        ``raceway_depth`` (race, angle, station) and ``roller_depth`` (roller, station), ``rib_depth`` (height) and
        ``end_depth`` (roller), in m/h; ``pocket_volume`` (roller, slot), in m3/h; ``friction_power`` (race, angle), in W/m2: the
        largest power of friction for the area of a contact, which says where smearing threatens, in places that stand still. On
        a ring that turns the depth is the same all round.

    Raises
    ------
    InputError
        If an argument is not allowed, or a group was not recorded.

    Notes
    -----
    Source: J. F. Archard, J. Applied Physics 24 (1953) 981; that asperities alone wear is assumed, with the share that the law
    of mixed friction has. Each of both surfaces loses the same volume.

    Examples
    --------
    >>> import trbdyn as trb
    >>> scene = trb.cases.scene_30310(500.0, 4930.0, lubricant=trb.lubricants.vg100(110.0))
    >>> found = trb.wear(trb.Simulation(scene).run(revolutions=1), coefficient=1e-17, records=20)
    >>> bool(found.rib_depth.max() > 0.0)
    True
    """
    import xarray

    expect("result", result, Result)
    k = number_of("coefficient", coefficient)
    if not 0.0 < k < math.inf:
        raise InputError.of("coefficient", coefficient, "must be > 0 (m2/N)")
    for name, value in (("records", records), ("bins", bins)):
        if not isinstance(value, int) or isinstance(value, bool) or value < 1:
            raise InputError.of(name, value, "must be a whole number >= 1")
    replay = Replay(result)
    sums = _Sums(result, replay, bins)
    index = np.unique(np.linspace(0, len(result) - 1, min(records, len(result))).round().astype(int))
    for place in index:
        sums.add(int(place), replay.contacts(int(place)))
    rate = k * HOUR / index.size
    bearing = result.scene.bearing
    depth = {
        "raceway_depth": (("race", "angle", "station"), rate * sums.race, "m/h", "wear of the raceways"),
        "roller_depth": (("roller", "station"), rate * sums.roller, "m/h", "wear of the rollers' flanks"),
        "rib_depth": (("height",), rate * sums.rib, "m/h", "wear of the back-face rib"),
        "end_depth": (("roller",), rate * sums.end, "m/h", "wear of the rollers' large ends"),
        "pocket_volume": (("roller", "slot"), rate * sums.pocket, "m3/h", "volume worn off each face of the pockets"),
        "friction_power": (
            ("race", "angle"),
            sums.power,
            "W/m2",
            "largest power of friction for the area of a contact",
        ),
    }
    places = {
        "race": list(RACES),
        "angle": ("angle", np.degrees(sums.middles), {"units": "deg"}),
        "station": ("station", replay.stations, {"units": "m", "long_name": "from mid length towards the large end"}),
        "height": ("height", sums.heights, {"units": "m", "long_name": "above the raceway"}),
        "roller": np.arange(bearing.n_rollers),
    }
    data = {
        name: (dims, values, {"units": unit, "long_name": text}) for name, (dims, values, unit, text) in depth.items()
    }
    return xarray.Dataset(data, places, {"coefficient": k, "records": int(index.size), "bearing": bearing.name})


class _Sums:
    """Load that wears times speed of sliding, over areas, summed over records."""

    def __init__(self, result: Result, replay: Replay, bins: int) -> None:
        scene, geometry = result.scene, result.scene.bearing.geometry
        self.result, self.scene, self.bins = result, scene, bins
        count, stations = scene.bearing.n_rollers, replay.stations
        self.middles = (np.arange(bins) + 0.5) * 2.0 * np.pi / bins
        ribs = scene.bearing.ribs
        self.heights = np.linspace(ribs.edge_low, ribs.edge_high, HEIGHTS)
        self.race, self.power = np.zeros((2, bins, stations.size)), np.zeros((2, bins))
        self.roller, self.rib = np.zeros((count, stations.size)), np.zeros(HEIGHTS)
        self.end = np.zeros(count)
        self.pocket = np.zeros((count, max(face.slot for face in scene.bearing.pocket.faces) + 1))
        self._radius = 0.5 * scene.bearing.roller.diameter + stations * math.tan(geometry.roller_half_angle)
        middle = 0.5 * scene.bearing.pitch_diameter + stations * math.sin(geometry.roller_axis_angle)
        reach = self._radius * math.cos(geometry.roller_axis_angle)
        self._race_radius = (middle + reach, middle - reach)
        self._turns = (scene.outer_turns, bool(np.any(result["shaft_speed"] != 0.0)))
        names = [field.name for field in field_table.table() if field.name.startswith("power_")]
        self._pocket_power = names.index("power_pocket")

    def asperities(self, film_parameter: Array, at: str) -> Array | float:
        """Share of the load that asperities carry."""
        effects = self.scene.effects
        friction = effects.friction
        if not effects.films:
            return 1.0
        if effects.lubrication == "full_film":
            return 0.0
        if effects.mixed_law == "exponential":
            b, c = (friction.asperity_factor, friction.asperity_exponent)
            if at == "rib":
                b, c = friction.rib_asperity_factor, friction.rib_asperity_exponent
            return np.asarray(laws.asperity_share(film_parameter, b, c))
        return np.asarray(laws.boundary_share(film_parameter, friction.lambda_boundary, friction.lambda_full))

    def add(self, place: int, found: dict[str, Array]) -> None:
        """Add a record."""
        angle = np.mod(self.result["roller_orbit_angle"][place], 2.0 * np.pi)
        load, weight = found["raceway_load"], found["raceway_weight"]
        sliding = found["raceway_sliding_speed"]
        worn = load * self.asperities(found["raceway_film_parameter"], "race") * sliding
        width = 2.0 * found["raceway_half_width"] * weight
        heat = np.divide(
            load * found["raceway_friction_coefficient"] * sliding, width, out=np.zeros_like(load), where=width > 0
        )
        number = (angle / (2.0 * np.pi) * self.bins).astype(int) % self.bins
        step = 2.0 * np.pi / self.bins
        for race in range(2):
            # a roller that touches nothing has no part of the line: no weights
            worn_along = np.divide(worn[race], weight[race], out=np.zeros_like(load[race]), where=weight[race] > 0.0)
            of_roller = worn_along / self._race_radius[race]
            if self._turns[race]:
                self.race[race] += of_roller.sum(axis=0) / (2.0 * np.pi)
            else:
                np.add.at(self.race[race], number, of_roller / step)
            self.roller += worn_along / (2.0 * np.pi * self._radius)
            np.maximum.at(self.power[race], number, heat[race].max(axis=-1))
        self._add_rib(found)
        friction = found["pocket_friction"].sum(axis=1)
        lost = found["power"][:, self._pocket_power]
        speed = np.divide(lost, friction, out=np.zeros_like(lost), where=friction > 0.0)
        self.pocket += found["pocket_load"][:, : self.pocket.shape[1]] * speed[:, None]

    def _add_rib(self, found: dict[str, Array]) -> None:
        if not self.scene.effects.back_rib:
            return
        geometry = self.scene.bearing.geometry
        load = found["rib_load"]
        worn = load * self.asperities(found["rib_film_parameter"], "rib") * found["rib_sliding_speed"]
        semi = geometry.rib_semi_axis_across * np.cbrt(load)
        band = np.maximum(2.0 * semi, self.heights[1] - self.heights[0])
        inside = np.abs(self.heights[None, :] - found["rib_height"][:, None]) <= 0.5 * band[:, None]
        self.rib += np.sum(inside * (worn / band)[:, None], axis=0) / (2.0 * np.pi * geometry.rib_contact_radius)
        middle = 0.5 * geometry.large_end_diameter - found["rib_height"]
        self.end += worn / (2.0 * np.pi * np.maximum(middle, 0.1 * geometry.large_end_diameter) * band)
