"""Profiles of rollers and raceways against their formulas, and their limits."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import laws
from trbdyn.model.bearing import Bearing, Profile
from trbdyn.model.profiles import drop_of, profile_drop, raceway_drops

HALF = 9.9e-3


def rig(profile: Profile, **fields: Profile) -> Bearing:
    return trb.cases.rig_30310().replace({"roller.profile": profile}).replace(**fields)


def interference(bearing: Bearing, race: int = 0) -> np.ndarray:
    scene = trb.cases.scene_30310(bearing=bearing, effects=trb.Effects.paper().replace(n_slices=12))
    sim = trb.Simulation(scene)
    vector = np.zeros_like(sim.state.vector)
    sim.view(vector)["roller_r"] = -5e-6 if race else 5e-6
    return sim.contacts(vector, 0.0)["raceway_interference"][race, 0]


@pytest.mark.parametrize(("a_p", "c_p", "d_p", "k_p"), [(3.5e-4, 19.8e-3, 0.0, 2.0), (5e-4, 12e-3, 6e-3, 2.5)])
def test_the_general_form_is_its_formula(a_p: float, c_p: float, d_p: float, k_p: float) -> None:
    bearing = rig(Profile.iso(a_p=a_p, c_p=c_p, d_p=d_p, k_p=k_p))
    for y in np.linspace(-0.4 * (d_p + c_p), 0.4 * (d_p + c_p), 23):
        way = (2.0 * abs(y) - d_p) / c_p
        expected = a_p * 14e-3 * math.log(1.0 / (1.0 - way**k_p)) if way > 0.0 else 0.0
        assert profile_drop(bearing, [y])[0] == pytest.approx(expected, rel=1e-9, abs=1e-18)
    assert np.isfinite(profile_drop(bearing, [-1.0, 1.0])).all()
    drops = profile_drop(bearing, np.linspace(0.0, HALF, 200))
    assert np.all(np.diff(drops) >= 0.0)


@pytest.mark.parametrize("length", [20e-3, 30e-3])
def test_the_constants_of_the_standard_follow_the_size(length: float) -> None:
    roller = trb.Roller(diameter=10e-3, effective_length=length, profile=Profile.iso())
    bearing = Bearing(n_rollers=15, cup_half_angle_deg=14.0, pitch_diameter=75e-3, roller=roller)
    profile = bearing.roller.profile
    assert (profile.a_p, profile.d_p) == (0.00045, 0.0)  # ISO 16281, tapered rollers
    assert profile.c_p == pytest.approx(length)
    assert {"roller.profile.a_p", "roller.profile.c_p"} <= set(bearing.assumed)
    straight = bearing.replace(cup_half_angle_deg=0.0, ribs=trb.Ribs(flanges="NU"))
    cylindrical = straight.roller.profile
    long = length > 25e-3
    assert cylindrical.a_p == (0.0005 if long else 0.00035)
    assert (cylindrical.c_p, cylindrical.d_p) == pytest.approx((25e-3, 5e-3) if long else (20e-3, 0.0))


def test_a_profile_without_drop_is_straight() -> None:
    flat = interference(rig(Profile.straight()))
    assert interference(rig(Profile.iso(a_p=0.0))) == pytest.approx(flat, abs=1e-18)
    assert interference(rig(Profile.table([-HALF, HALF], [0.0, 0.0]))) == pytest.approx(flat, abs=1e-18)


def test_a_table_of_a_formula_is_the_formula(tmp_path: Path) -> None:
    shape = Profile.crowned(30.0)
    places = np.linspace(-HALF, HALF, 101)
    drops = laws.profile_crowned(station=places, radius=30.0)
    table = Profile.table(places, drops)
    assert interference(rig(table)) == pytest.approx(interference(rig(shape)), abs=2e-10)
    file = tmp_path / "drops.csv"
    lines = [f"{1e3 * y!r},{1e6 * drop!r}" for y, drop in zip(places.tolist(), drops.tolist(), strict=True)]
    file.write_text("\n".join(["station_mm,drop_um", *lines]), encoding="utf-8")
    assert Profile.from_csv(file).drops == pytest.approx(table.drops, rel=1e-12)


@pytest.mark.parametrize(("race", "name"), [(0, "cup_profile"), (1, "cone_profile")])
def test_a_raceway_with_the_profile_equals_a_roller_with_it(race: int, name: str) -> None:
    """Perpendicular to the roller's axis and along the raceway's normal differ by the cosine of its half angle alone."""
    crown, flat = Profile.crowned(30.0), Profile.straight()
    straight = interference(rig(flat), race)
    lost = straight - interference(rig(crown), race)
    given = straight - interference(rig(flat, **{name: crown}), race)
    cosine = math.cos(trb.cases.rig_30310().geometry.roller_half_angle)
    left = cosine * given - lost
    # the rings' displacement differs where only one of the raceways has the drop: the same all along the inner one
    assert left - left.mean() == pytest.approx(0.0, abs=1e-12)
    assert race == 1 or left == pytest.approx(0.0, abs=1e-15)
    assert np.ptp(given) > 1e-6
    other = ("cone_profile", "cup_profile")[race]
    assert np.ptp(straight - interference(rig(flat, **{other: crown}), race)) < 1e-12
    assert raceway_drops(rig(flat, cup_profile=crown), [0.0, HALF])[0] == pytest.approx([0.0, HALF**2 / 60.0], rel=1e-6)


def test_a_raceway_profile_changes_equilibrium_and_pressure_as_the_rollers_does() -> None:
    def pressure(bearing: Bearing) -> float:
        return float(trb.Simulation(trb.cases.scene_30310(bearing=bearing)).contacts()["raceway_pressure"].max())

    crown, flat = Profile.crowned(10.0), Profile.straight()
    on_roller = pressure(rig(crown))
    on_raceways = pressure(rig(flat, cup_profile=crown, cone_profile=crown))
    assert on_raceways == pytest.approx(on_roller, rel=2e-3)
    assert on_roller > 1.1 * pressure(rig(flat))


def test_what_is_no_table_is_refused(tmp_path: Path) -> None:
    with pytest.raises(trb.InputError, match="rising places"):
        Profile.table([0.0, 0.0], [0.0, 0.0])
    with pytest.raises(trb.InputError, match=r"profile\.stations.*must go from"):
        rig(Profile.table([-1e-3, 1e-3], [0.0, 0.0]))
    with pytest.raises(trb.InputError, match=r"cup_profile\.stations"):
        rig(Profile.straight(), cup_profile=Profile.table([-1e-3, 1e-3], [0.0, 0.0]))
    (tmp_path / "bad.csv").write_text("x,y\n1,2\n2,3\n", encoding="utf-8")
    with pytest.raises(trb.InputError, match="station_mm"):
        Profile.from_csv(tmp_path / "bad.csv")


def test_a_raceway_profile_is_kept_in_a_file() -> None:
    bearing = rig(Profile.straight(), cup_profile=Profile.iso())
    assert Bearing(**bearing.to_dict()) == bearing
    assert drop_of(bearing, bearing.cup_profile, [HALF * 0.5])[0] > 0.0


def test_an_estimated_bearing_has_the_standard_profile_with_the_band_of_published_ones() -> None:
    bearing = trb.Bearing.from_catalogue(bore=0.080, outside=0.140, width=0.03525, C=187e3, e=0.43)
    band = next(entry for entry in bearing.estimated if entry.path == "roller.profile.a_p")
    assert (band.low, band.value, band.high) == (0.00025, 0.00045, 0.0006)
    assert bearing.roller.profile.kind == "iso"
