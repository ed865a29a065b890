"""Wear by Archard's law: nothing is lost between contacts and maps, films protect, and where the places are."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray

import trbdyn as trb
from trbdyn import Effects, InputError, Scene, Simulation
from trbdyn.run.replay import Replay

HOUR = 3600.0
THIN = {"speed_rpm": 300.0, "axial_load": 4930.0, "lubricant": trb.lubricants.vg32(90.0)}


def run(**given: Any) -> trb.Result:
    return Simulation(Scene(trb.cases.rig_30310(), **(THIN | given)), accuracy="fast").run(revolutions=1.0)


def worn(result: trb.Result, records: int, boundary: bool = False) -> dict[str, Any]:
    """Rate of load times sliding of all contacts over the records that `trb.wear` takes, straight from the contacts (N m/s)."""
    replay = Replay(result)
    index = np.unique(np.linspace(0, len(result) - 1, records).round().astype(int))
    race, rib = np.zeros(2), 0.0
    for place in index:
        found = replay.contacts(int(place))
        shares = [
            np.ones_like(found[f"{at}_load"])
            if boundary
            else np.asarray(trb.laws.boundary_share(found[f"{at}_film_parameter"], 0.01, 1.5))
            for at in ("raceway", "rib")
        ]
        race += (shares[0] * found["raceway_load"] * found["raceway_sliding_speed"]).sum(axis=(1, 2))
        rib += float((shares[1] * found["rib_load"] * found["rib_sliding_speed"]).sum())
    return {
        "race": race / index.size,
        "rib": rib / index.size,
        "weight": found["raceway_weight"][0, 0],
        "replay": replay,
    }


@pytest.mark.parametrize("boundary", [False, True])
def test_volumes_are_those_of_the_contacts(boundary: bool) -> None:
    effects = Effects.standard().replace(lubrication="boundary") if boundary else Effects.standard()
    result = run(radial_load=3000.0, effects=effects)
    found = trb.wear(result, coefficient=2e-17, records=30, bins=36)
    expected = worn(result, 30, boundary)
    geometry, bearing = result.scene.bearing.geometry, result.scene.bearing
    station = found.station.values
    roller = 0.5 * bearing.roller.diameter + station * np.tan(geometry.roller_half_angle)
    middle = 0.5 * bearing.pitch_diameter + station * np.sin(geometry.roller_axis_angle)
    for number, (race, side) in enumerate((("outer", 1.0), ("inner", -1.0))):
        radius = middle + side * roller * np.cos(geometry.roller_axis_angle)
        area = radius * expected["weight"] * 2.0 * np.pi / 36
        volume = float((found.raceway_depth.sel(race=race).values * area).sum())
        assert volume == pytest.approx(2e-17 * HOUR * expected["race"][number], rel=1e-9)
    volume = float((found.roller_depth.values * 2.0 * np.pi * roller * expected["weight"]).sum())
    assert volume == pytest.approx(2e-17 * HOUR * expected["race"].sum(), rel=1e-9)
    height = found.height.values
    rib = float(found.rib_depth.sum()) * (height[1] - height[0]) * 2.0 * np.pi * geometry.rib_contact_radius
    assert rib == pytest.approx(2e-17 * HOUR * expected["rib"], rel=0.15)  # a band of some places of the height


def test_a_film_protects_and_a_load_zone_shows() -> None:
    thin = trb.wear(run(radial_load=5000.0), coefficient=1e-17, records=60)
    assert float(thin.rib_depth.max()) > 100.0 * float(thin.raceway_depth.max())
    around = thin.raceway_depth.sel(race="outer").mean("station")
    loaded = around.where((around.angle > 45) & (around.angle < 135)).mean()
    assert float(loaded) > 3.0 * float(around.where((around.angle > 225) & (around.angle < 315)).mean())
    inner = thin.raceway_depth.sel(race="inner")
    assert np.ptp(inner.mean("station").values) == 0.0
    thick = trb.wear(run(lubricant=trb.lubricants.vg100(30.0), speed_rpm=1500.0), coefficient=1e-17, records=20)
    assert float(thick.raceway_depth.max()) == float(thick.rib_depth.max()) == 0.0
    assert float(thick.pocket_volume.max()) > 0.0
    full = run(effects=Effects.standard().replace(lubrication="full_film"))
    assert float(trb.wear(full, coefficient=1e-17, records=10).rib_depth.max()) == 0.0


def test_pockets_lose_what_friction_says() -> None:
    """Power of friction in the pockets over its coefficient is load times sliding."""
    result = run()
    found = trb.wear(result, coefficient=1e-17, records=40)
    replay = Replay(result)
    index = np.unique(np.linspace(0, len(result) - 1, 40).round().astype(int))
    total = 0.0
    names = [field.name for field in result.fields if field.name.startswith("power_")]
    for place in index:
        contacts = replay.contacts(int(place))
        lost = contacts["power"][:, names.index("power_pocket")]
        mu = contacts["pocket_friction"].sum(axis=1) / np.maximum(contacts["pocket_load"].sum(axis=1), 1e-300)
        total += float(np.sum(np.divide(lost, mu, out=np.zeros_like(lost), where=mu > 0.0)))
    assert float(found.pocket_volume.sum()) == pytest.approx(1e-17 * HOUR * total / index.size, rel=1e-9)


def test_what_is_refused_and_drawn() -> None:
    result = run()
    for given, words in (
        ({"coefficient": 0.0}, "coefficient"),
        ({"coefficient": -1.0}, "coefficient"),
        ({"coefficient": 1e-17, "records": 0}, "records"),
        ({"coefficient": 1e-17, "bins": 1.5}, "bins"),
    ):
        with pytest.raises(InputError, match=words):
            trb.wear(result, **given)
    found = trb.wear(result, coefficient=1e-17, records=10)
    assert isinstance(found, xarray.Dataset)
    assert found.raceway_depth.attrs["units"] == "m/h"
    assert len(trb.plot.wear_map(found).axes) == 6
    plt.close("all")
    few = Simulation(Scene(trb.cases.rig_30310(), **THIN)).run(revolutions=0.1, save_groups=("cage", "torque"))
    with pytest.raises(InputError, match="rollers"):
        trb.wear(few, coefficient=1e-17)


def test_rollers_without_load_wear_nothing_and_hide_nothing() -> None:
    """Some rollers touch no raceway: all depths are numbers, and their volume is what all contacts lose together."""
    result = run(axial_load=1000.0, radial_load=3000.0)
    assert (result["outer_load"] == 0.0).any()
    found = trb.wear(result, coefficient=1e-17, records=20)
    assert all(np.isfinite(found[name]).all() for name in ("raceway_depth", "roller_depth", "friction_power"))
    seen = worn(result, 20)
    station, geometry = found.station.values, result.scene.bearing.geometry
    radius = 0.5 * result.scene.bearing.roller.diameter + station * np.tan(geometry.roller_half_angle)
    weight = max(seen["replay"].contacts(0)["raceway_weight"][0], key=lambda line: line.sum())
    volume = float((found.roller_depth.values * 2.0 * np.pi * radius * weight).sum())
    assert volume == pytest.approx(1e-17 * HOUR * seen["race"].sum(), rel=1e-9)
