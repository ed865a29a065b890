"""Pressures of half spaces: against Hertz, Lundberg's profile, Boussinesq's potentials, rigid punches, and another program."""

from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest
import scipy

import trbdyn as trb
from trbdyn.extras.design.edge_search import edge_numbers
from trbdyn.half_space.contact import press
from trbdyn.half_space.influence import Influence, guilbault_factor
from trbdyn.half_space.line import Line, Pressures, press_line
from trbdyn.half_space.stress import largest_shear, rectangle
from trbdyn.model.spectrum import LoadCase, Spectrum
from trbdyn.run.contact_pressure import edge_warnings

E, NU = 206e9, 0.3
COMPLIANCE = (1.0 - NU**2) / E
MODULUS = 1.0 / (2.0 * COMPLIANCE)  # E* of two equal bodies
RADIUS, LENGTH, LOAD = 6e-3, 19.8e-3, 1833.0
HALF = math.sqrt(4.0 * LOAD / LENGTH * RADIUS / (math.pi * MODULUS))
HERTZ = 2.0 * LOAD / (math.pi * HALF * LENGTH)


def places(count: int, length: float = LENGTH) -> np.ndarray:
    return length * ((np.arange(count) + 0.5) / count - 0.5)


def line(drop: np.ndarray, length: float = LENGTH, **more: float) -> Line:
    y, radius = places(drop.size, length), np.full(drop.size, RADIUS)
    return Line(y, drop, radius, np.zeros_like(y), (COMPLIANCE, COMPLIANCE), **more)


def pressed(made: Line, moment: float | None = 0.0, load: float = LOAD, **how: float) -> Pressures:
    count, length = made.places.size, made.places.size * (made.places[1] - made.places[0])
    return press_line(made, load=load, moment=moment, per_length=np.full(count, load / length), **how)


def lundberg(y: np.ndarray, end: float = 1.0) -> np.ndarray:
    """The drop under which a line load is uniform: Lundberg (1939); end < 1: of Johns and Gohar (1981)."""
    return LOAD / (math.pi * LENGTH * MODULUS) * np.log(1.0 / (1.0 - end * (2.0 * y / LENGTH) ** 2))


def test_far_from_the_ends_the_pressure_is_that_of_a_line() -> None:
    found = pressed(line(np.zeros(128)))
    along = found.found.pressure.max(axis=1)
    per_length = found.found.pressure.sum(axis=1) * (found.x[1] - found.x[0])
    hertz = np.sqrt(per_length * MODULUS / (math.pi * RADIUS))
    assert np.abs(along / hertz - 1.0)[10:-10] == pytest.approx(0.0, abs=5e-3)
    assert found.found.pressure.sum() * (found.x[1] - found.x[0]) * LENGTH / 128 == pytest.approx(LOAD, rel=1e-9)
    assert along[0] > 1.4 * HERTZ  # a sharp end


def test_the_logarithmic_profile_gives_the_uniform_pressure_that_it_was_designed_for() -> None:
    """Lundberg's drop makes the load uniform; the approach then is 2 w/(pi E*) [ln(2 L/b) + 1/2]."""
    y = places(128)
    found = pressed(line(lundberg(y)))
    along = found.found.pressure.max(axis=1)
    assert along[np.abs(y) < 0.475 * LENGTH] / HERTZ == pytest.approx(1.0, abs=5e-3)
    exact = 2.0 * LOAD / LENGTH / (math.pi * MODULUS) * (math.log(2.0 * LENGTH / HALF) + 0.5)
    assert found.found.approach == pytest.approx(exact, rel=1e-3)
    # of Johns and Gohar, whose drop at the ends is finite: no more than 5 % above the design's pressure
    finite = pressed(line(lundberg(y, 1.0 - 0.3033 * 2.0 * HALF / LENGTH))).found.pressure.max(axis=1)
    assert finite[np.abs(y) < 0.475 * LENGTH] / HERTZ == pytest.approx(1.0, abs=1e-2)
    assert finite.max() < 1.05 * HERTZ


def test_the_profile_of_fujiwara_and_kawase() -> None:
    """NTN Technical Review 75 (2007): with K1 = K2 = 1 it is that of Johns and Gohar, designed for a uniform pressure, which has
    pressure at its edge when the roller tilts; a larger drop at the end takes it away.
    """
    y, tilt = places(128), 2e-4
    size = LOAD / (math.pi * LENGTH * MODULUS)
    how = {"station": y, "length": LENGTH, "load": LOAD, "effective_modulus": 2.0 * MODULUS}
    johns_gohar = trb.laws.profile_logarithmic(k1=1.0, k2=1.0, zm=-size * math.log(0.3033 * 2.0 * HALF / LENGTH), **how)
    modified = trb.laws.profile_logarithmic(k1=3.0, k2=1.0, zm=20e-6, **how)
    level = pressed(line(johns_gohar)).found.pressure.max(axis=1)
    assert level[np.abs(y) < 0.475 * LENGTH] / HERTZ == pytest.approx(1.0, abs=1e-2)
    assert level.max() < 1.05 * HERTZ
    edge, none = (pressed(line(drop - tilt * y), None).found.pressure.max(axis=1) for drop in (johns_gohar, modified))
    assert edge[-1] == edge.max() > 1.6 * HERTZ
    assert none[-1] < 0.75 * HERTZ
    assert none.max() < 1.3 * HERTZ
    assert y[none.argmax()] < 0.45 * LENGTH


def test_a_sharp_end_has_the_known_singularity() -> None:
    """At the end of a body that ends at a right angle on one that goes on, both of one material and without friction, the
    pressure rises with the distance to the power -0.226: Dundurs and Lee (1972), J. Elasticity 2, 109-112. Of two half spaces it
    is -1/2; with images of the factor psi the cosine of pi times 1 plus the power is -psi/2.
    """

    def corner(power: float) -> float:
        turn = math.pi * power
        return 2.0 / math.tan(turn) + math.sin(turn) / (math.sin(0.5 * turn) ** 2 - power**2)

    known = 1.0 - scipy.optimize.brentq(corner, 0.6, 0.95)
    assert known == pytest.approx(0.226, abs=5e-4)
    length, found = 0.6e-3, {}
    for factor in (0.0, guilbault_factor(0.3)):
        ends = [
            pressed(line(np.zeros(count), length, mirrored=factor), load=LOAD * length / LENGTH).found.pressure[0].max()
            for count in (128, 256)
        ]
        found[factor] = math.log2(ends[1] / ends[0])
    assert found[0.0] == pytest.approx(0.5, abs=0.02)
    assert found[guilbault_factor(0.3)] == pytest.approx(known, abs=0.03)
    assert 1.0 - math.acos(-0.5 * guilbault_factor(0.3)) / math.pi == pytest.approx(known, abs=0.03)


def test_free_ends_take_pressure_away_from_the_ends() -> None:
    free, going_on = (
        pressed(line(np.zeros(128), mirrored=factor)).found.pressure.max(axis=1) for factor in (1.39, 0.0)
    )
    assert free[0] < 0.8 * going_on[0]
    assert free[64] == pytest.approx(going_on[64], rel=0.03)
    assert guilbault_factor(0.3) == pytest.approx(1.39)
    far = pressed(line(np.zeros(128), mirrored=1.39, beyond=20.0 * LENGTH)).found.pressure.max(axis=1)
    assert far[0] == pytest.approx(going_on[0], rel=2e-2)


def test_displacements_are_sums_over_rectangles_and_their_images() -> None:
    generator, shape, cell = np.random.default_rng(3), (6, 10), (2e-5, 1e-4)
    pressure = generator.uniform(0.0, 1e9, shape[::-1])
    beyond, length = 3e-5, shape[1] * cell[1]
    found = Influence(shape, cell, compliance=2.0 * COMPLIANCE, mirrored=1.3 * COMPLIANCE, beyond=beyond)(pressure)

    def love(x: float, y: float) -> float:
        total = 0.0
        for a in (-0.5, 0.5):
            for b in (-0.5, 0.5):
                u, v = x + a * cell[0], y + b * cell[1]
                total += 4.0 * a * b * (u * math.asinh(v / abs(u)) + v * math.asinh(u / abs(v)))
        return total / math.pi

    middle = (np.arange(shape[1]) + 0.5) * cell[1]
    for j, i in ((0, 0), (4, 3), (9, 5)):
        expected = 0.0
        for k in range(shape[1]):
            for n in range(shape[0]):
                x = (i - n) * cell[0]
                images = (-2.0 * beyond - middle[k], 2.0 * (length + beyond) - middle[k])
                own = 2.0 * COMPLIANCE * love(x, middle[j] - middle[k])
                expected += pressure[k, n] * (own + 1.3 * COMPLIANCE * sum(love(x, middle[j] - one) for one in images))
        assert found[j, i] == pytest.approx(expected, rel=1e-9)


def test_a_rigid_punch_has_the_known_approach_and_an_edge_that_grows_with_the_grid() -> None:
    """A flat round punch: approach P/(2 a E*), pressure P/(2 pi a^2) (1 - r^2/a^2)^(-1/2)."""
    radius, load, errors, edges = 1e-3, 500.0, [], []
    for count in (20, 40, 80):
        x = 1.2 * radius * (2.0 * (np.arange(count) + 0.5) / count - 1.0)
        r = np.hypot(x[:, None], x[None, :])
        gap = np.where(r < radius, 0.0, 1.0)
        cell = 2.4 * radius / count
        found = press(Influence((count, count), (cell, cell), compliance=1.0 / MODULUS), gap, load=load, tolerance=1e-6)
        errors.append(abs(found.approach / (load / (2.0 * radius * MODULUS)) - 1.0))
        edges.append(found.pressure.max())
        inner = r < 0.7 * radius
        exact = load / (2.0 * math.pi * radius**2) / np.sqrt(1.0 - (r[inner] / radius) ** 2)
        assert found.pressure[inner] == pytest.approx(exact, rel=0.08 if count < 40 else 0.03)
    assert errors[2] < 0.01
    assert errors[2] < errors[0]
    assert edges[0] < edges[1] < edges[2]
    assert edges[2] / edges[0] == pytest.approx(2.0, rel=0.35)  # with the root of the number of cells, up to its steps


def test_a_tilt_by_hand() -> None:
    """A crowned roller that tilts by t touches t R_c away from its middle, with the same ellipse of Hertz."""
    crown, load, y = 0.5, 300.0, places(160, 6e-3)
    drop, tilt = y**2 / (2.0 * crown), 1.5e-3
    straight, leaning = (
        pressed(line(drop, 6e-3), moment=load * at, load=load, tolerance=1e-5) for at in (0.0, tilt * crown)
    )
    assert leaning.found.tilt == pytest.approx(tilt, rel=2e-3)
    stiffness = trb.laws.point_stiffness(radius_one=RADIUS, radius_two=crown, effective_modulus=2.0 * MODULUS)
    # the pressure by Hertz: 3/2 of the load over the ellipse's area
    sizes = [
        getattr(trb.laws, f"point_semi_axis_{name}")(
            load=load, radius_one=RADIUS, radius_two=crown, effective_modulus=2.0 * MODULUS
        )
        for name in ("long", "short")
    ]
    hertz = 1.5 * load / (math.pi * sizes[0] * sizes[1])
    assert straight.found.approach == pytest.approx((load / stiffness) ** (2.0 / 3.0), rel=5e-3)
    for found in (straight, leaning):
        assert found.found.pressure.max() == pytest.approx(hertz, rel=5e-3)
    weights = leaning.found.pressure.sum(axis=1)
    assert weights @ y / weights.sum() == pytest.approx(tilt * crown, rel=1e-6)


@pytest.mark.parametrize(("crown", "share"), [(math.inf, 0.0), (math.inf, 0.03), (1.5, 0.05)])
def test_beside_tamaas(crown: float, share: float) -> None:
    """Tamaas (EPFL) has a solver of its own, without tilts: it gets ours, and has to find the load's moment again."""
    tamaas = pytest.importorskip("tamaas")
    count, length = 64, 3e-3
    load = LOAD * length / LENGTH
    y = places(count, length)
    drop = y**2 / (2.0 * crown)
    ours = pressed(line(drop, length), moment=share * load * length, load=load, cells=32, tolerance=1e-6)
    x = ours.x
    gap = x[None, :] ** 2 / (2.0 * RADIUS) + (drop - ours.found.tilt * y)[:, None]
    size = [length, x.size * (x[1] - x[0])]
    model = tamaas.Model(tamaas.model_type.basic_2d, size, [count, x.size])
    model.E, model.nu = MODULUS, 0.0
    tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
    kind = tamaas.PolonskyKeerRey.pressure
    solver = tamaas.PolonskyKeerRey(model, -gap, 1e-12, kind, kind)
    solver.setIntegralOperator("dcfft")
    solver.max_iter = 5000
    solver.solve(load / (size[0] * size[1]))
    theirs = np.asarray(model["traction"])
    assert np.abs(theirs - ours.found.pressure).max() < 1e-3 * theirs.max()
    assert theirs.sum(axis=1) @ y / theirs.sum() == pytest.approx(share * length, abs=1e-5 * length)


def test_stresses_below_a_rectangle_are_those_of_boussinesq() -> None:
    x, y, z = 0.7, -0.4, 0.5

    def point(part: str, xi: float, eta: float) -> float:
        a, b = x - xi, y - eta
        q, r = a * a + b * b, math.sqrt((x - xi) ** 2 + (y - eta) ** 2 + z * z)
        free = (1.0 - 2.0 * NU) / q
        value = {
            "xx": free * ((1.0 - z / r) * (a * a - b * b) / q + z * b * b / r**3) - 3.0 * z * a * a / r**5,
            "yy": free * ((1.0 - z / r) * (b * b - a * a) / q + z * a * a / r**3) - 3.0 * z * b * b / r**5,
            "zz": -3.0 * z**3 / r**5,
            "xy": free * ((1.0 - z / r) * 2.0 * a * b / q - a * b * z / r**3) - 3.0 * a * b * z / r**5,
            "yz": -3.0 * b * z * z / r**5,
            "xz": -3.0 * a * z * z / r**5,
        }
        return value[part] / (2.0 * math.pi)

    found = rectangle(np.array([x - 0.3, x + 0.3]), np.array([y - 0.25, y + 0.25]), z, NU)[:, 0, 0]
    for value, part in zip(found, ("xx", "yy", "zz", "xy", "yz", "xz"), strict=True):
        whole = scipy.integrate.dblquad(lambda eta, xi, part=part: point(part, xi, eta), -0.3, 0.3, -0.25, 0.25)[0]
        assert value == pytest.approx(whole, abs=1e-7)


def test_the_largest_shear_below_a_line() -> None:
    """0.300 of the pressure in 0.786 half widths, and 0.25 in half of one: Johnson, Contact Mechanics, 4.2."""
    count, rows = 48, 32
    x = 1.3 * (2.0 * (np.arange(count) + 0.5) / count - 1.0)
    pressure = np.repeat(np.sqrt(np.maximum(1.0 - x**2, 0.0))[None, :], rows, axis=0)
    found = largest_shear(pressure, (2.6 / count, 6.0), 1.0, NU)
    assert found.largest[16] == pytest.approx(0.3003, rel=5e-3)
    assert found.largest_depth[16] == pytest.approx(0.786)
    assert found.orthogonal[16] == pytest.approx(0.25, rel=5e-3)
    assert found.orthogonal_depth[16] == pytest.approx(0.5)


def with_profile(profile: trb.Profile) -> trb.Scene:
    scene = trb.cases.scene_30310(3000.0, 4930.0)
    return scene.replace(bearing=scene.bearing.replace({"roller.profile": profile}))


def test_of_a_scene_load_and_moment_are_those_of_the_slices() -> None:
    scene = trb.cases.scene_30310(3000.0, 4930.0)
    nodes, contacts = trb.Simulation(scene).contacts()["raceway_load"], ("outer", "inner")
    for race, raceway in enumerate(contacts):
        found = trb.contact_pressure(scene, raceway=raceway, roller=2, cells=(16, 64))
        area = found.cell[0] * found.cell[1]
        assert found.load == pytest.approx(nodes[race, 2].sum(), rel=1e-9)
        assert found.pressure.sum() * area == pytest.approx(found.load, rel=1e-9)
        assert found.pressure.sum(axis=1) @ found.y * area == pytest.approx(found.moment, abs=1e-9 * found.load)
        assert found.largest == pytest.approx(found.slice_pressure.max(), rel=0.03)  # a logarithmic profile, light load
        assert found.slice_load_per_length.sum() * found.cell[1] == pytest.approx(found.load, rel=5e-3)
        assert found.warnings == ()


def test_sharp_ends_are_said_and_drawn() -> None:
    found = trb.contact_pressure(with_profile(trb.Profile.straight()))
    assert found.slices_are_off == (True, True)
    assert min(found.edge_ratios) > 1.1
    assert "sharp edge" in str(found).lower()
    assert abs(found.place[1]) > 9e-3
    fine = trb.contact_pressure(with_profile(trb.Profile.straight()), cells=(24, 256))
    assert fine.largest > 1.15 * found.largest
    assert found.shear.largest.max() == pytest.approx(0.3 * found.largest, rel=0.25)
    figure = trb.plot.contact_pressure(found)
    assert len(figure.axes) == 5


@pytest.mark.parametrize("scene", [trb.cases.scene_32216(), trb.cases.scene_nj210()], ids=["tapered", "cylindrical"])
def test_other_bearings(scene: trb.Scene) -> None:
    for raceway in ("outer", "inner"):
        found = trb.contact_pressure(scene, raceway=raceway)
        assert found.largest == pytest.approx(found.slice_pressure.max(), rel=0.12)
        assert not found.pressure[:, [0, -1]].any()
        fine = trb.contact_pressure(scene, raceway=raceway, cells=(32, 192))
        assert fine.largest == pytest.approx(found.largest, rel=0.02)


def test_a_load_above_that_of_the_profile_presses_at_the_end() -> None:
    """The rig's profile drops by 10 um at its ends, for 1.8 kN a roller: under 7 kN and a tilt its ends are sharp edges."""
    scene = trb.cases.scene_30310(1000.0, 20e3).replace(radial_load=20e3)
    found = trb.contact_pressure(scene, raceway="outer")
    assert any(found.slices_are_off)
    assert max(found.edge_ratios) > 1.3
    assert any(found.sharp_edges)


def test_of_a_result_a_record_is_taken() -> None:
    result = trb.Simulation(trb.cases.scene_30310(1000.0, 8e3)).run(duration=2e-4)
    first = trb.contact_pressure(result, time=0.0, roller=1, cells=(16, 64))
    assert first.time == 0.0
    assert first.largest == pytest.approx(
        trb.contact_pressure(result.scene, roller=1, cells=(16, 64)).largest, rel=1e-3
    )
    assert trb.contact_pressure(result, cells=(16, 64)).time == pytest.approx(result["time"][-1])
    for arguments, field in (
        ({"time": 1.0}, "time"),
        ({"roller": 99}, "roller"),
        ({"raceway": "rib"}, "raceway"),
        ({"cells": (7, 64)}, "cells"),
        ({"free_ends": "all"}, "free_ends"),
        ({"mirrored": 9.0}, "mirrored"),
    ):
        with pytest.raises(trb.InputError, match=field):
            trb.contact_pressure(result, **arguments)


def test_lives_beside_each_other() -> None:
    good, sharp = (
        trb.edge_life(with_profile(one), cells=(16, 64)) for one in (trb.Profile.logarithmic(), trb.Profile.straight())
    )
    assert good.contacts == 24
    assert good.without > good.with_factor
    # rollers whose profile fits the load live as slices say; the factor takes the same from any profile
    assert good.with_pressures == pytest.approx(good.without, rel=0.1)
    assert good.sharp == 0
    assert sharp.sharp == 24
    assert sharp.with_pressures < 0.97 * sharp.without
    assert "sharp" in str(sharp)
    assert "half spaces" in str(good)


def test_equivalent_loads_of_a_line_are_its_loads() -> None:
    found = trb.contact_pressure(with_profile(trb.Profile.logarithmic()), free_ends="none")
    assert found.equivalent_loads(50).sum() == pytest.approx(found.load, rel=5e-3)


def test_the_report_says_where_slices_are_off() -> None:
    for profile, count in ((trb.Profile.straight(), 4), (trb.Profile.logarithmic(), 0)):
        result = trb.Simulation(with_profile(profile)).run(duration=1e-4)
        assert len(edge_warnings(result)) == count


def test_a_better_profile_presses_less_at_its_edges() -> None:
    scene = with_profile(trb.Profile.logarithmic(k1=0.5)).replace(axial_load=20e3)
    worse, better = edge_numbers(scene), edge_numbers(scene.replace({"bearing.roller.profile.k1": 4.0}))
    assert better["edge_pressure"] < 0.9 * worse["edge_pressure"]
    assert worse["largest_pressure"] >= worse["edge_pressure"]
    assert worse["edge_pressure"] > 1.1 * worse["slice_edge_pressure"]


@pytest.mark.slow
def test_profiles_are_optimised_over_load_cases() -> None:
    pytest.importorskip("sklearn")
    scene = with_profile(trb.Profile.logarithmic(k1=0.5))
    heavy = scene.replace(axial_load=20e3, radial_load=15e3)
    cases = Spectrum([LoadCase("light", 0.7, scene), LoadCase("heavy", 0.3, heavy)])
    change = {"bearing.roller.profile.k1": (0.3, 4.0)}
    found = trb.optimise(scene, change, {"edge_pressure": "least"}, designs=10, over=cases)
    assert found.chosen.values["edge_pressure"] < 0.95 * found.first.values["edge_pressure"]
    assert found.chosen.inputs["bearing.roller.profile.k1"] > 1.0
    with pytest.raises(trb.InputError, match="edge_pressure"):
        trb.optimise(scene, change, {"torque": "least"}, designs=10, over=cases)


def test_nothing_is_loaded_before_it_is_asked_for() -> None:
    code = "import sys, trbdyn as trb; trb.Simulation; print([n for n in sys.modules if 'half_space' in n])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
