"""Fits, growth by temperature and what they leave of end play and clearance, against formulas and samples made here."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.tolerances import bore_limits, clearance_limits, limits, outside_limits, series_of
from trbdyn.standards.sheet import Rating
from trbdyn.statics.press_fit import PressFit

ALUMINIUM = trb.Material(youngs_modulus=70e9, poisson_ratio=0.33, density=2700.0, expansion=23.5e-6)
STEEL = trb.Material.steel()
SEAT = {"bore": 0.050, "outside": 0.110, "width": 0.02925, "shaft": "m6", "housing": "N7"}


def pair(arrangement: str = "back to back", spread: float = 0.15, end_play: float = -40e-6) -> trb.Assembly:
    shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    return trb.Assembly.pair(
        trb.cases.rig_30310(), arrangement, spread=spread, end_play=end_play, shaft=shaft, speed_rpm=3000.0
    )


@pytest.mark.parametrize(
    ("code", "size", "lower", "upper"),
    [
        ("g6", 0.040, -25, -9),
        ("h5", 0.040, -11, 0),
        ("j5", 0.060, -7, 6),
        ("js7", 0.030, -10.5, 10.5),
        ("k5", 0.100, 3, 18),
        ("m6", 0.050, 9, 25),
        ("n6", 0.140, 27, 52),
        ("p6", 0.200, 50, 79),
        ("r6", 0.2001, 80, 109),
        ("r7", 0.220, 80, 126),
        ("G7", 0.080, 10, 40),
        ("H7", 0.180, 0, 40),
        ("J7", 0.090, -13, 22),
        ("K6", 0.070, -15, 4),
        ("K7", 0.080, -21, 9),
        ("M7", 0.080, -30, 0),
        ("M6", 0.300, -41, -9),
        ("N7", 0.110, -45, -10),
        ("P6", 0.110, -52, -30),
        ("P7", 0.240, -79, -33),
    ],
)
def test_tolerances_are_those_of_the_standard(code: str, size: float, lower: float, upper: float) -> None:
    assert np.multiply(limits(code, size), 1e6) == pytest.approx([lower, upper], abs=1e-9)


def test_tolerances_of_bearings_and_clearances() -> None:
    assert bore_limits(0.050, tapered=True) == pytest.approx((-12e-6, 0.0))
    assert bore_limits(0.0501, tapered=False, accuracy="6") == pytest.approx((-12e-6, 0.0))
    assert outside_limits(0.110, tapered=True) == pytest.approx((-18e-6, 0.0))
    assert outside_limits(0.110, tapered=False) == pytest.approx((-15e-6, 0.0))
    assert clearance_limits("C3", 0.050) == pytest.approx((50e-6, 80e-6))
    assert clearance_limits("CN", 0.0501) == pytest.approx((40e-6, 70e-6))


@pytest.mark.parametrize("code", ["x6", "m11", "m3", "M6x", "Kk7", "", "P9x", "j8", "K9", "jS6"])
def test_unknown_tolerances_are_refused(code: str) -> None:
    with pytest.raises(trb.InputError, match="tolerance class of ISO 286"):
        limits(code, 0.05)


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"shaft": "M6"}, "shaft"),
        ({"housing": "n7"}, "housing"),
        ({"shaft": (25e-6, 9e-6)}, "shaft"),
        ({"shaft_bore": 0.05}, "shaft_bore"),
        ({"housing_outside": 0.110}, "housing_outside"),
        ({"outside": 0.040}, "outside"),
        ({"clearance": "C9"}, "clearance"),
        ({"bore": 0.700, "outside": 0.9}, "shaft"),
    ],
)
def test_mountings_that_cannot_be_are_refused(changes: dict[str, object], field: str) -> None:
    with pytest.raises(trb.InputError, match=field):
        trb.Mounting(**{**SEAT, **changes})


def test_a_ring_that_does_not_fit_its_seat_is_refused() -> None:
    with pytest.raises(trb.InputError, match=r"mounting\.bore.*below the diameter of the raceway"):
        trb.fit(trb.cases.rig_30310(), trb.Mounting(**{**SEAT, "bore": 0.07}))
    with pytest.raises(trb.InputError, match="accuracy"):
        trb.fit(trb.cases.rig_30310(), trb.Mounting(**SEAT, accuracy="6"))


@pytest.mark.parametrize(
    ("field", "own", "other"), [("bore", 0.040, 0.045), ("outside", 0.080, 0.085), ("width", 0.02475, 0.02)]
)
def test_a_mounting_for_another_size_is_refused_wherever_it_meets_the_bearing(
    field: str, own: float, other: float
) -> None:
    bearing, size = trb.Bearing.named("32208"), {"bore": 0.040, "outside": 0.080, "width": 0.02475}
    said = rf"mounting\.{field} = {other:g} : must be {own:g}, that of the bearing 32208"
    wrong = trb.Mounting(**{**SEAT, **size, field: other})
    with pytest.raises(trb.InputError, match=said):
        trb.fit(bearing, wrong)
    with pytest.raises(trb.InputError, match=said):
        trb.preload_over(trb.Scene(bearing, speed_rpm=1000, axial_load=2e3), wrong, [20.0])
    on_shaft = {"left": trb.Mounting(**{**SEAT, **size}), "right": wrong}
    shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.04, length=0.3)
    two = trb.Assembly.pair(bearing, "back to back", spread=0.15, end_play=-40e-6, shaft=shaft, speed_rpm=1000)
    with pytest.raises(trb.InputError, match=said.replace("mounting", r"mounting\.right")):
        trb.fit(two, on_shaft)
    rounded = trb.Mounting(**{**SEAT, **size, field: own + 4e-6})
    assert trb.fit(bearing, rounded)[""].seats[0].mean > 0.0


@pytest.mark.parametrize(("field", "wrong"), [("bore", 0.07), ("outside", 0.08), ("width", 0.015)])
def test_boundary_dimensions_within_rollers_and_raceways_are_refused(field: str, wrong: float) -> None:
    with pytest.raises(trb.InputError, match=f"{field} = {wrong:g} : must be (below|above) the"):
        trb.cases.rig_30310().replace(**{field: wrong})


def lame(fit: PressFit, interference: float) -> tuple[float, float, float]:
    """Pressure (Pa), growth of the outside and shrinkage of the bore (m, diameters): u = A r + B/r of both rings, and the four
    conditions at their surfaces, as a system of equations.
    """
    a, d, b = 0.5 * fit.bore, 0.5 * fit.seat, 0.5 * fit.outside

    def stress(material: trb.Material, r: float) -> list[float]:
        e, nu = material.youngs_modulus, material.poisson_ratio
        return [e / (1.0 - nu), -e / ((1.0 + nu) * r**2)]

    inner_at_d, outer_at_d, outer_at_b = (
        stress(fit.inner, d),
        stress(fit.outer, d),
        stress(fit.outer, b),
    )
    first = [*stress(fit.inner, a), 0.0, 0.0] if a else [0.0, 1.0, 0.0, 0.0]
    rows = np.array(
        [
            first,
            [0.0, 0.0, *outer_at_b],
            [*inner_at_d, -outer_at_d[0], -outer_at_d[1]],
            [-d, -1.0 / d, d, 1.0 / d],
        ]
    )
    scale = np.array([[1e11, 1e11, 1e11, 1.0]]).T
    one = np.linalg.solve(rows / scale, np.array([0.0, 0.0, 0.0, 0.5 * interference]))
    pressure = -(inner_at_d[0] * one[0] + inner_at_d[1] * one[1])
    shrinks = -2.0 * (one[0] * a + one[1] / a) if a else 0.0
    return pressure, 2.0 * (one[2] * b + one[3] / b), shrinks


@pytest.mark.parametrize(
    "fit",
    [
        PressFit(0.0, 0.050, 0.0686, STEEL, STEEL),
        PressFit(0.030, 0.050, 0.0686, STEEL, STEEL),
        PressFit(0.096, 0.110, 0.165, STEEL, ALUMINIUM),
        PressFit(0.096, 0.110, 0.120, STEEL, trb.Material(youngs_modulus=110e9, poisson_ratio=0.26)),
    ],
)
def test_rings_are_those_of_lame(fit: PressFit) -> None:
    pressure, grows, shrinks = lame(fit, 30e-6)
    drawn = np.array(30e-6)
    assert float(fit.pressure(drawn)) == pytest.approx(pressure, rel=1e-9)
    assert float(fit.outside_growth(drawn)) == pytest.approx(grows, rel=1e-9)
    assert float(fit.bore_shrinkage(drawn)) == pytest.approx(shrinks, rel=1e-9, abs=1e-20)
    assert float(fit.pressure(-drawn)) == 0.0


def test_rings_of_one_material_are_those_of_catalogues() -> None:
    """NSK, Rolling Bearings: growth over interference k (1 - k0^2)/(1 - k^2 k0^2), k = d/Di, k0 = d0/d; and the same of a
    housing, h (1 - h0^2)/(1 - h^2 h0^2), h = De/D, h0 = D/D0.
    """
    k, k0 = 50.0 / 68.6, 30.0 / 50.0
    grows = float(PressFit(0.030, 0.050, 0.0686, STEEL, STEEL).outside_growth(np.array(1e-6)))
    assert grows == pytest.approx(1e-6 * k * (1.0 - k0**2) / (1.0 - k**2 * k0**2), rel=1e-9)
    h, h0 = 96.0 / 110.0, 110.0 / 165.0
    shrinks = float(PressFit(0.096, 0.110, 0.165, STEEL, STEEL).bore_shrinkage(np.array(1e-6)))
    assert shrinks == pytest.approx(1e-6 * h * (1.0 - h0**2) / (1.0 - h**2 * h0**2), rel=1e-9)


def test_a_published_example() -> None:
    """Powertransmission.com, Bearings with Norm, aluminum housing series, March 2015: an HM804846/10 in aluminium loses half of
    an interference of 100 um; its outer ring grows by 10 um, which is 27.4 um of axial play. Open are the housing's outside
    (here 1.5 times that of the bearing) and the ring's raceway (here 80 mm), which change the growth by 3 um.
    """
    ring = PressFit(0.080, 0.09525, 1.5 * 0.09525, STEEL, ALUMINIUM)
    growth = 0.5 * float(ring.bore_shrinkage(np.array(100e-6)) - ring.bore_shrinkage(np.array(50e-6)))
    assert growth == pytest.approx(10e-6, rel=0.02)
    page = {"bore": 0.047625, "outside": 0.09525, "width": 0.030162, "C": 107e3, "e": 0.55}
    bearing = trb.Bearing.from_catalogue(**page)
    seat = {"bore": 0.047625, "outside": 0.09525, "width": 0.030162, "shaft": (0.0, 0.0)}
    tight, loose = (
        trb.fit(bearing, trb.Mounting(**seat, housing=(-u, -u), smoothing=0.0, set="before mounting"))[""]
        for u in (100e-6, 50e-6)
    )
    raceway = 0.5 * (tight.seats[1].raceway - loose.seats[1].raceway)
    axial = loose.parts["housing_fit"] - tight.parts["housing_fit"]
    assert axial / raceway == pytest.approx(27.4 / 10.0, rel=0.01)


def test_probabilities_are_those_of_a_sample() -> None:
    """A transition fit and a warm one, and the clearance that is left, against a million bearings with sizes drawn here."""
    seat = trb.Mounting(
        bore=0.050, outside=0.090, width=0.020, shaft="k5", housing="K7", clearance="C3", housing_material=ALUMINIUM
    )
    warm = trb.Temperatures(shaft_c=60.0, inner_ring_c=62.0, rollers_c=61.0, outer_ring_c=50.0, housing_c=35.0)
    bearing = trb.cases.bearing_nj210()
    found = trb.fit(bearing, seat, temperatures=warm)
    draw, size = np.random.default_rng(7), 1_000_000

    def drawn(low: float, high: float) -> np.ndarray:
        return 1e-6 * draw.normal(0.5 * (low + high), (high - low) / 6.0, size)

    shaft, bore, outside, housing = drawn(2, 13), drawn(-12, 0), drawn(-15, 0), drawn(-25, 10)
    steel, other, races = 12e-6, 23.5e-6, bearing.geometry
    on_shaft = shaft - bore + 0.050 * steel * (40.0 - 42.0)
    in_housing = outside - housing + 0.090 * (steel * 30.0 - other * 15.0)
    for part, sample in zip(found[""].seats, (on_shaft, in_housing), strict=True):
        assert part.probability == pytest.approx(np.mean(sample > 0.0), abs=2e-3)
    inner, outer = 2.0 * races.inner_race_radius, 2.0 * races.outer_race_radius
    k, left = 0.050 / inner, np.where(on_shaft > 0.0, 0.050 / 0.052 * on_shaft, 0.0)
    grows = k * left
    ring = PressFit(outer, 0.090, 0.135, STEEL, ALUMINIUM)
    shrinks = np.where(in_housing > 0.0, 0.090 / 0.092 * in_housing, 0.0) * lame(ring, 1e-6)[2] / 1e-6
    rings = steel * (30.0 * outer - 42.0 * inner - 2.0 * 41.0 * bearing.roller.diameter)
    play = drawn(50, 80) - grows - shrinks + rings
    told = found.plays[""]["operating"]
    low, high = np.quantile(play, [0.005, 0.995])
    assert told.mean == pytest.approx(play.mean(), abs=0.05e-6)
    assert (told.low, told.high) == pytest.approx((low, high), abs=0.5e-6)
    assert found.subject.radial_clearance == told.mean


def test_a_clearance_that_fits_turn_into_preload() -> None:
    """NU 2210 of group C2 (5 to 35 um) on n6 (17 to 33 um, bore 0 to -12) and in N7 (-10 to -45, outside 0 to -15): the raceways
    come closer by 0.84 and 0.8 of the interferences 31 and 20 um less what smoothing takes."""
    page = {"bore": 0.050, "outside": 0.090, "width": 0.023, "C": 90e3, "C0": 88e3, "F": 0.0595, "flanges": "NU"}
    seat = {"bore": 0.050, "outside": 0.090, "width": 0.023, "shaft": "n6", "housing": "N7"}
    bearing = trb.Bearing.from_catalogue(**page)
    found = trb.fit(bearing, trb.Mounting(**seat, clearance="C2"))
    told, races = found.plays[""]["operating"], bearing.geometry
    grows = 0.050 / (2.0 * races.inner_race_radius) * 31e-6 * 0.050 / 0.052
    ring = PressFit(2.0 * races.outer_race_radius, 0.090, 0.135, STEEL, STEEL)
    shrinks = 20e-6 * 0.090 / 0.092 * lame(ring, 1e-6)[2] / 1e-6
    assert told.mean == pytest.approx(20e-6 - grows - shrinks, abs=0.1e-6)
    assert told.mean == pytest.approx(-21e-6, abs=0.5e-6)
    assert told.preloaded > 0.99
    assert "preloaded" in str(found)
    assert found.subject.radial_clearance == told.mean
    driven_up = trb.fit(bearing, trb.Mounting(**{**seat, "housing": "K6"}, clearance=(-8e-6, -2e-6)))
    assert driven_up.plays[""]["mounted"].mean < -5e-6


def test_a_pinion_in_aluminium() -> None:
    """Two bearings 0.11 m apart, 60 K warmer in aluminium: 76 um by the length between them, more than three times the 22.7 um
    that 5 kN of preload are.
    """
    one = pair()
    planes = [bearing.centre_plane for bearing in one.bearings]
    one = pair(spread=0.15 + 0.11 - (planes[1] - planes[0]))
    planes = [bearing.centre_plane for bearing in one.bearings]
    assert planes[1] - planes[0] == pytest.approx(0.11)
    warm = trb.fit(one, trb.Mounting(**SEAT, housing_material=ALUMINIUM), temperatures=trb.Temperatures.uniform(80.0))
    span = sum(bearing.parts["span"] for bearing in warm.values())
    assert span == pytest.approx(-0.11 * 60.0 * 11.5e-6, rel=1e-9)
    assert -1e6 * span == pytest.approx(75.9, abs=0.1)
    half = 0.5 * 22.7e-6
    preloaded = one.replace(bearings=tuple(bearing.replace(end_play=-half) for bearing in one.bearings))
    assert trb.equilibrium(preloaded)["left"].axial_load == pytest.approx(5000.0, rel=0.7)
    other = pair("face to face", spread=0.05)
    grows = trb.fit(
        other, trb.Mounting(**SEAT, housing_material=ALUMINIUM), temperatures=trb.Temperatures.uniform(80.0)
    )
    assert sum(bearing.parts["span"] for bearing in grows.values()) > 0.0
    assert any("may creep" in text for text in warm.warnings)


def test_bearings_with_one_apex_keep_their_play() -> None:
    """A well-known rule of adjusted pairs: where the apexes of both bearings meet, a warm shaft with its inner rings and rollers
    changes nothing, as all of them grow away from one point.
    """
    bearing = trb.cases.rig_30310()
    planes = [one.centre_plane for one in pair(spread=0.3).bearings]
    spread = 0.3 + 2.0 * bearing.geometry.centre_plane - (planes[1] - planes[0])
    warm = trb.Temperatures(shaft_c=70.0, inner_ring_c=70.0, rollers_c=70.0, outer_ring_c=20.0, housing_c=20.0)
    found = trb.fit(pair(spread=spread), trb.Mounting(**SEAT), temperatures=warm)
    plays = found.plays["end play"]
    assert plays["operating"].mean == pytest.approx(plays["mounted"].mean, abs=1e-12)
    nearer = trb.fit(pair(spread=spread - 0.1), trb.Mounting(**SEAT), temperatures=warm).plays["end play"]
    assert nearer["operating"].mean - nearer["mounted"].mean == pytest.approx(-0.1 * 50.0 * 12e-6, rel=1e-9)


def test_one_material_at_one_temperature_changes_nothing() -> None:
    for subject in (pair(), trb.cases.bearing_nj210()):
        seat = SEAT if isinstance(subject, trb.Assembly) else {**SEAT, "outside": 0.090, "width": 0.020}
        found = trb.fit(subject, trb.Mounting(**seat), temperatures=trb.Temperatures.uniform(120.0))
        for plays in found.plays.values():
            change = plays["operating"].mean - plays["mounted"].mean
            assert change == pytest.approx(0.0, abs=1e-12)


def test_sets_before_mounting_lose_their_play_by_the_fits() -> None:
    one = pair()
    mounted, before = (
        trb.fit(one, trb.Mounting(**SEAT, set=when)).plays["end play"]["operating"].mean
        for when in ("mounted", "before mounting")
    )
    cot = 1.0 / math.tan(math.radians(one.bearings[0].bearing.cup_half_angle_deg))
    seats = trb.fit(one, trb.Mounting(**SEAT))["left"].seats
    assert mounted == pytest.approx(-40e-6)
    assert before == pytest.approx(mounted - cot * sum(seat.raceway for seat in seats), rel=2e-2)


def test_what_it_takes() -> None:
    one = pair()
    with pytest.raises(trb.InputError, match="left, right"):
        trb.fit(one, {"left": trb.Mounting(**SEAT)})
    iron = trb.Material(youngs_modulus=110e9, poisson_ratio=0.26)
    with pytest.raises(trb.InputError, match="expansion"):
        trb.fit(one, trb.Mounting(**SEAT, housing_material=iron), temperatures=trb.Temperatures.uniform(60.0))
    with pytest.raises(trb.InputError, match="seed"):
        trb.fit(one, trb.Mounting(**SEAT), seed=-1)
    found = trb.fit(one, trb.Mounting(**SEAT))
    assert "left shaft m6" in str(found)
    assert "m6" in found._repr_html_()
    assert [bearing.end_play for bearing in found.subject.bearings] == pytest.approx([-20e-6, -20e-6])


def test_a_spring_takes_up_the_growth() -> None:
    """A spring without stiffness keeps its force; one with stiffness changes it by that of its way."""
    warm = trb.Temperatures(shaft_c=80.0, inner_ring_c=80.0, rollers_c=80.0, outer_ring_c=40.0, housing_c=40.0)
    one = pair()
    for stiffness in (0.0, 2e5):  # the bearings give way, too, by 0.2 % of the spring's way
        spring = trb.PreloadSpring(force=1500.0, stiffness=stiffness)
        left, right = one.bearings
        sprung = one.replace(bearings=(left.replace(end_play=0.0), right.replace(end_play=0.0, spring=spring)))
        found = trb.fit(sprung, trb.Mounting(**SEAT), temperatures=warm)
        way = found.plays["way of the spring"]["operating"].mean
        assert way < -50e-6
        cold, hot = (trb.equilibrium(subject)["right"].axial_load for subject in (sprung, found.subject))
        assert hot - cold == pytest.approx(-stiffness * way, rel=4e-3, abs=1e-3)
    left, right = one.bearings
    soft = right.replace(end_play=0.0, spring=trb.PreloadSpring(force=10.0, stiffness=1e7))
    cooled = trb.Temperatures(shaft_c=20.0, inner_ring_c=20.0, rollers_c=20.0, outer_ring_c=80.0, housing_c=80.0)
    with pytest.raises(trb.InputError, match="force"):
        trb.fit(one.replace(bearings=(left.replace(end_play=0.0), soft)), trb.Mounting(**SEAT), temperatures=cooled)


def test_the_sheet_of_ratings_shows_the_fits() -> None:
    """Of one bearing and of several, with the play of operation; of a bearing alone there is nothing to rate."""
    warm = trb.Temperatures.uniform(80.0)
    seat = trb.Mounting(**SEAT, housing_material=ALUMINIUM)
    load = trb.ShaftLoad(position=0.0, force=(0.0, -3000.0, 1000.0))
    for subject in (pair().replace(loads=(load,)), trb.Scene(trb.cases.rig_30310(), speed_rpm=2000, axial_load=5e3)):
        found = trb.fit(subject, seat, temperatures=warm)
        rated, plain = trb.rating(found), trb.rating(found.subject)
        assert rated.life_hours == plain.life_hours
        assert rated.fits is found
        assert plain.fits is None
        assert str(rated) == f"{plain}\n\n{found}"
        assert "Fits of the seats" in str(rated)
        shown = rated._shown()
        assert [one.title for one in shown.parts][:2] == ["Fits of the seats", "What changes the play"]
    assert isinstance(rated, Rating)
    kept = json.loads(json.dumps(rated.to_dict()))["fits"]
    assert kept["bearings"][""]["seats"][0]["operating"] == found[""].seats[0].operating
    assert plain.to_dict()["fits"] is None
    with pytest.raises(trb.InputError, match="a rating needs speed and loads"):
        trb.rating(trb.fit(trb.cases.rig_30310(), seat))


@pytest.mark.parametrize(
    ("code", "size", "ends"),
    [("K4", 0.005, (-3.5, 0.5)), ("N4", 0.005, (-10.5, -6.5)), ("M4", 0.008, (-8.5, -4.5)), ("K4", 0.015, (-4.0, 1.0))],
)
def test_fine_holes_of_small_sizes(code: str, size: float, ends: tuple[float, float]) -> None:
    """ISO 286-1:2010, table 1: IT3 is 2.5 um from 3 to 10 mm, which its rule for fine holes takes; limits of ISO 286-2."""
    assert limits(code, size) == pytest.approx([1e-6 * end for end in ends], abs=1e-12)


def test_a_mounted_set_says_why_nothing_changes() -> None:
    """Not ten zeros: a set whose end play was measured when mounted has its fits in it."""
    one = trb.fit(pair(), trb.Mounting(**SEAT))
    assert "set = 'mounted', and has the fits in it" in " ".join(str(one).split())
    assert "the parts grow not at all or alike, so nothing does" in " ".join(str(one).split())
    assert "What changes the play" not in str(one)
    warm = " ".join(
        str(
            trb.fit(
                pair(), trb.Mounting(**SEAT, housing_material=ALUMINIUM), temperatures=trb.Temperatures.uniform(60.0)
            )
        ).split()
    )
    assert "only temperatures change it. Sets" in warm
    before = str(trb.fit(pair(), trb.Mounting(**SEAT, set="before mounting")))
    assert "has the fits in it" not in before
    assert "left shaft fit" in before


@pytest.mark.parametrize(
    ("size", "accuracy", "bore", "outside"),
    [
        # SKF, Tolerances for inch tapered roller bearings; NTN, Large Bearings, table 3.5
        (0.03175, "normal", 13, 25),
        (0.0762, "4", 13, 25),
        (0.0763, "4", 25, 25),
        (0.0762, "3", 13, 13),
        (0.2, "2", 25, 25),
        (0.2, "3", 13, 13),
        (0.2, "0", 13, 13),
        (0.2, "00", 8, 8),
        (0.304, "4", 25, 25),
        (0.4, "4", 51, 51),
        (0.4, "3", 25, 25),
        (0.8, "4", 76, 76),
        (0.8, "3", 38, 38),
    ],
)
def test_tolerances_of_inch_series(size: float, accuracy: Any, bore: float, outside: float) -> None:
    """ISO 578: bore and outside diameter lie above the nominal size."""
    for of, most in ((bore_limits, bore), (outside_limits, outside)):
        assert of(size, tapered=True, accuracy=accuracy, series="inch") == pytest.approx((0.0, 1e-6 * most))


@pytest.mark.parametrize(
    ("name", "bore", "outside", "series"),
    [
        ("LM67048/LM67010", 0.03175, 0.059131, "inch"),
        ("LM67048 - LM67010", 0.03175, 0.059131, "inch"),
        ("LM67048/10", 0.03175, 0.059131, "inch"),
        ("33275/33462", 0.069850, 0.117475, "inch"),
        ("49585/49520", 0.050800, 0.101600, "inch"),
        ("JLM104948/JLM104910", 0.050, 0.082, "metric"),
        ("32208 J2/Q", 0.040, 0.080, "metric"),
        ("HR32208J", 0.040, 0.080, "metric"),
        ("30310", 0.050, 0.110, "metric"),
        ("a hub", 0.03175, 0.059131, "inch"),
        ("a hub", 0.050, 0.110, "metric"),
        ("31.75x59.131x15.875", 0.03175, 0.059131, "inch"),
    ],
)
def test_what_tells_an_inch_series(name: str, bore: float, outside: float, series: str) -> None:
    assert series_of(name, bore, outside)[0] == series


def test_a_fit_says_whose_tolerances_it_took() -> None:
    inch = trb.Bearing.named("LM67048/LM67010")
    seat = {"bore": inch.bore, "outside": inch.outside, "width": inch.width, "shaft": "m6", "housing": "N7"}
    found = trb.fit(inch, trb.Mounting(**seat))
    assert "tolerances of ISO 578, class 4 (inch series, by its designation LM67048/LM67010)" in " ".join(
        str(found).split()
    )
    # m6 at 31.75 mm is 9 to 25 um, the bore 0 to 13 um above
    assert (found[""].seats[0].least, found[""].seats[0].most) == pytest.approx((9e-6 - 13e-6, 25e-6))
    metric = trb.fit(inch, trb.Mounting(**seat, series="metric"))
    assert "ISO 492, class normal (metric series, as given)" in " ".join(str(metric).split())
    assert metric[""].seats[0].least == pytest.approx(9e-6)
    fine = trb.fit(inch, trb.Mounting(**seat, accuracy="3"))
    assert "ISO 578, class 3" in str(fine)
    assert fine[""].seats[1].most == pytest.approx(found[""].seats[1].most - 12e-6)
    with pytest.raises(trb.InputError, match=r"accuracy = '5' .*ISO 578 has no other"):
        trb.fit(inch, trb.Mounting(**seat, accuracy="5"))
    with pytest.raises(trb.InputError, match=r"accuracy = '00' .*classes of inch series"):
        trb.fit(trb.cases.rig_30310(), trb.Mounting(**SEAT, accuracy="00"))
    nj210 = {"bore": 0.050, "outside": 0.090, "width": 0.020, "shaft": "k5", "housing": "H7"}
    with pytest.raises(trb.InputError, match="ISO 578 has tapered ones alone"):
        trb.fit(trb.cases.bearing_nj210(), trb.Mounting(**nj210, series="inch"))
