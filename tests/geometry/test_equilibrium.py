"""Static equilibrium: contact loads, load zone, balance of forces and moments, and loads that nothing can carry."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq, fsolve

from trbdyn import Effects, LoadError, RingBody, Scene, Simulation, cases
from trbdyn.errors import InputError
from trbdyn.model.bearing import Bearing
from trbdyn.statics.equilibrium import most_radial_load

CUP = math.radians(12 + 57 / 60 + 10 / 3600)
EVEN = 2 * np.pi * np.arange(12) / 12


def simulate(
    bearing: Bearing, speed_rpm: float = 0.0, axial: float = 4930.0, radial: float = 0.0, **more: Any
) -> Simulation:
    return Simulation(cases.paper_30310(speed_rpm, axial, radial, bearing=bearing, **more))


class TestAxialLoad:
    def test_standstill(self, straight_rig: Bearing) -> None:
        found = simulate(straight_rig).equilibrium
        assert found.outer_load == pytest.approx(1832.9, abs=0.05)
        assert found.inner_load == pytest.approx(1829.5, abs=0.05)
        assert found.rib_load == pytest.approx(119.6, abs=0.05)
        # from the axial balance of ring and roller alone
        assert found.outer_load == pytest.approx(4930.0 / (12 * math.sin(CUP)), rel=1e-9)

    def test_at_speed(self, straight_rig: Bearing) -> None:
        geometry = straight_rig.geometry
        found = simulate(straight_rig, 3000.0).equilibrium
        assert found.outer_load == pytest.approx(1832.9, abs=0.05)
        assert found.inner_load == pytest.approx(1812.0, abs=0.5)
        assert found.rib_load == pytest.approx(122.4, abs=0.05)
        orbit = geometry.cage_speed_ratio * 100 * math.pi
        assert geometry.roller_mass * orbit**2 * geometry.roller_centre_radius == pytest.approx(17.7, abs=0.05)

    def test_balance_of_a_roller(self, straight_rig: Bearing) -> None:
        """Three normals and the centrifugal force: outer and inner race, rib, in the axial plane."""
        g = straight_rig.geometry
        for speed in (0.0, 3000.0, 6000.0):
            found = simulate(straight_rig, speed).equilibrium
            orbit = g.cage_speed_ratio * speed * math.pi / 30
            centrifugal = g.roller_mass * orbit**2 * (g.roller_centre_radius + found.rollers[0, 0])
            outer = found.outer_load[0] * np.array([-math.cos(CUP), math.sin(CUP)])
            inner = found.inner_load[0] * np.array([math.cos(g.cone_half_angle), -math.sin(g.cone_half_angle)])
            rib = found.rib_load[0] * np.array([-math.sin(g.rib_normal_angle), -math.cos(g.rib_normal_angle)])
            assert outer + inner + rib + [centrifugal, 0.0] == pytest.approx([0.0, 0.0], abs=1e-5)

    def test_profile_hardly_matters(self, rig: Bearing, straight_rig: Bearing) -> None:
        """Loads follow from balance; only their sharing by stiffness can change, and only by the rollers' tilt."""
        for speed in (0.0, 3000.0):
            one, other = (simulate(bearing, speed).equilibrium for bearing in (rig, straight_rig))
            assert one.inner_load == pytest.approx(other.inner_load, abs=1e-3)
            assert one.rib_load == pytest.approx(other.rib_load, abs=1e-3)
            assert one.displacement[2] < other.displacement[2] < 0.0

    def test_all_rollers_alike(self, rig: Bearing) -> None:
        found = simulate(rig, 2000.0).equilibrium
        assert np.ptp(found.outer_load) < 1e-6
        assert found.displacement[:2] == pytest.approx([0.0, 0.0], abs=1e-14)
        assert found.residual < 1e-6


def sjovall(axial: float, radial: float) -> tuple[NDArray[np.float64], float]:
    """Loads of 12 rollers of equal stiffness, exponent 10/9, and the load zone's epsilon."""

    def loads(x: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.maximum(x[0] * math.sin(CUP) + x[1] * math.cos(CUP) * np.cos(EVEN), 0.0) ** (10 / 9)

    def off(x: NDArray[np.float64]) -> list[float]:
        q = loads(x)
        return [q.sum() * math.sin(CUP) - axial, (q * np.cos(EVEN)).sum() * math.cos(CUP) - radial]

    x = fsolve(off, [4000.0, 300.0], xtol=1e-13)
    return loads(x), 0.5 * (1.0 + x[0] * math.tan(CUP) / x[1])


def with_rib(bearing: Bearing, axial: float, radial: float) -> NDArray[np.float64]:
    """The same with three contacts in series: two lines and the rib's Hertz point, by the complementary energy."""
    g = bearing.geometry
    line = 0.356 * g.effective_modulus * bearing.roller.effective_length ** (8 / 9)
    inner, rib = math.cos(2 * g.roller_half_angle), math.sin(2 * g.roller_half_angle)

    def approach(q: float) -> float:
        return (q / line) ** 0.9 * (1.0 + inner**1.9) + (q * rib / g.rib_stiffness) ** (2 / 3) * rib

    def loads(x: NDArray[np.float64]) -> NDArray[np.float64]:
        closing = 1e-5 * (x[0] * math.sin(CUP) + x[1] * math.cos(CUP) * np.cos(EVEN))
        return np.array([brentq(lambda q, d=d: approach(q) - d, 0.0, 1e5, xtol=1e-10) for d in closing])

    def off(x: NDArray[np.float64]) -> list[float]:
        q = loads(x)
        return [q.sum() * math.sin(CUP) / axial - 1.0, (q * np.cos(EVEN)).sum() * math.cos(CUP) / radial - 1.0]

    return loads(fsolve(off, [2.7, 0.3], xtol=1e-13))


@pytest.mark.parametrize(
    ("radial", "epsilon", "largest", "smallest"),
    [(2780.0, 2.637, 2311.0, 1361.0), (5530.0, 1.566, 2791.0, 901.0), (8380.0, 1.193, 3294.0, 436.0)],
)
class TestLoadZone:
    """At standstill, straight generator, no misalignment."""

    def test_of_sjovall(self, radial: float, epsilon: float, largest: float, smallest: float) -> None:
        """The oracle itself gives the numbers that are known."""
        loads, zone = sjovall(4930.0, radial)
        assert zone == pytest.approx(epsilon, abs=0.5e-3)
        assert (loads.max(), loads.min()) == pytest.approx((largest, smallest), abs=0.5)

    def test_of_the_core(
        self, straight_rig: Bearing, radial: float, epsilon: float, largest: float, smallest: float
    ) -> None:
        found = simulate(straight_rig, radial=radial, radial_direction_deg=0.0).equilibrium
        loads, zone = sjovall(4930.0, radial)
        # rib and tilting of the rollers, which Sjovall leaves out, shift less than 1 N
        assert found.outer_load == pytest.approx(loads, abs=1.0)
        assert (found.outer_load.max(), found.outer_load.min()) == pytest.approx((largest, smallest), abs=1.5)
        share = found.outer_load.min() / found.outer_load.max()
        assert 1.0 / (1.0 - share**0.9) == pytest.approx(zone, abs=1e-3)
        assert 1.0 / (1.0 - share**0.9) == pytest.approx(epsilon, abs=1.5e-3)

    def test_with_the_rib_in_series(
        self, straight_rig: Bearing, radial: float, epsilon: float, largest: float, smallest: float
    ) -> None:
        """What is left is the rollers' tilt: less than 2e-4 of the largest load."""
        found = simulate(straight_rig, radial=radial, radial_direction_deg=0.0).equilibrium
        assert found.outer_load == pytest.approx(with_rib(straight_rig, 4930.0, radial), abs=2e-4 * largest)

    @pytest.mark.parametrize(("direction", "loaded"), [(90.0, 3), (0.0, 0), (-90.0, 9), (150.0, 5)])
    def test_direction(
        self,
        straight_rig: Bearing,
        radial: float,
        epsilon: float,
        largest: float,
        smallest: float,
        direction: float,
        loaded: int,
    ) -> None:
        found = simulate(straight_rig, radial=radial, radial_direction_deg=direction).equilibrium
        assert np.argmax(found.outer_load) == loaded
        towards = np.array([math.cos(math.radians(direction)), math.sin(math.radians(direction))])
        assert found.displacement[:2] @ towards == pytest.approx(np.linalg.norm(found.displacement[:2]), rel=1e-9)


def balance(sim: Simulation) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Force and moment of the rollers on the inner ring at the start, from the contacts of the dynamics."""
    record = sim.record()
    return record["ring_force"], record["ring_moment"]


@pytest.mark.parametrize("axial", [100.0, 1230.0, 4930.0, 60e3])
@pytest.mark.parametrize("share", [0.0, 0.3, 0.9])
def test_force_balance(rig: Bearing, axial: float, share: float) -> None:
    radial = share * axial / math.tan(CUP)
    sim = simulate(rig, 0.0, axial, radial, radial_direction_deg=40.0)
    force, _ = balance(sim)
    direction = math.radians(40.0)
    applied = np.array([radial * math.cos(direction), radial * math.sin(direction), -axial])
    assert force == pytest.approx(-applied, abs=1e-8 * axial + 1e-6)
    assert sim.equilibrium.residual < 1e-8 * axial


@pytest.mark.parametrize("speed", [0.0, 3000.0])
@pytest.mark.parametrize("radial", [0.0, 5530.0])
def test_rollers_rest_at_equilibrium(rig: Bearing, speed: float, radial: float) -> None:
    """Without friction no roller of the dynamics is accelerated, but along its orbit where the ring is off centre."""
    free = Effects.frictionless().replace(gravity=False, front_rib=False)
    sim = Simulation(cases.scene_30310(speed, 4930.0, radial, bearing=rig, effects=free))
    rates = sim.view(sim.derivative())
    # 2.5e-6 N on a roller of 25 g
    for direction in ("r", "z") if radial else ("r", "t", "z"):
        assert np.abs(rates[f"roller_v_{direction}"]).max() < 1e-4
    # the equilibrium takes the gyroscopic moment at the nominal tilt: off by its relative change with the tilt
    g = rig.geometry
    orbit, spin = g.cage_speed_ratio * speed * math.pi / 30, g.roller_spin_ratio * speed * math.pi / 30
    gyroscopic = g.roller_inertia_axial * orbit * math.sin(g.roller_axis_angle) * spin
    change = np.abs(sim.equilibrium.rollers[:, 2]).max() / math.tan(g.roller_axis_angle)
    assert np.abs(rates["roller_omega_t"]).max() < 1e-2 + 1.5 * gyroscopic * change / g.roller_inertia_transverse


class TestMoments:
    def test_free_ring_turns_until_no_moment_is_left(self, rig: Bearing) -> None:
        sim = simulate(rig, 0.0, 4930.0, 2780.0, moment_x=0.0, moment_y=0.0)
        _, moment = balance(sim)
        assert abs(sim.equilibrium.displacement[3]) > 1e-4
        assert moment[:2] == pytest.approx([0.0, 0.0], abs=1e-6)

    @pytest.mark.parametrize("moments", [(20.0, 0.0), (-15.0, 8.0)])
    def test_prescribing_the_rotation_gives_the_moment_back(self, rig: Bearing, moments: tuple[float, float]) -> None:
        free = simulate(rig, 0.0, 4930.0, 1000.0, moment_x=moments[0], moment_y=moments[1])
        turn = free.equilibrium.displacement[3:]
        held = simulate(rig, 0.0, 4930.0, 1000.0, misalignment_x=turn[0], misalignment_y=turn[1])
        assert held.equilibrium.displacement == pytest.approx(free.equilibrium.displacement, abs=1e-12)
        assert held.equilibrium.outer_load == pytest.approx(free.equilibrium.outer_load, abs=1e-4)
        for sim in (free, held):
            _, moment = balance(sim)
            assert moment[:2] == pytest.approx([-moments[0], -moments[1]], abs=1e-5)

    def test_moment_and_rotation_have_the_same_sense(self, rig: Bearing) -> None:
        found = simulate(rig, 0.0, 4930.0, moment_x=10.0).equilibrium
        assert found.displacement[3] > 0.0
        other = simulate(rig, 0.0, 4930.0, moment_y=10.0).equilibrium
        assert other.displacement[4] == pytest.approx(found.displacement[3], rel=1e-6)

    @pytest.mark.parametrize("moment", [1.0, 20.0])
    def test_a_free_ring_takes_hardly_more_steps_than_a_held_one(self, rig: Bearing, moment: float) -> None:
        """Rotations are damped as little as places are, on the way to the equilibrium."""
        held = simulate(rig, 0.0, 4930.0).equilibrium
        free = simulate(rig, 0.0, 4930.0, moment_x=moment, moment_y=0.0).equilibrium
        assert free.iterations <= held.iterations + 2

    def test_prescribed_place(self, rig: Bearing) -> None:
        """A ring placed where a load would put it carries that load."""
        loaded = simulate(rig, 0.0, 4930.0, 2780.0)
        shift = tuple(float(x) for x in loaded.equilibrium.displacement[:3])
        placed = Simulation(Scene(rig, speed_rpm=0.0, displacement=shift, effects=loaded.scene.effects))
        assert placed.equilibrium.outer_load == pytest.approx(loaded.equilibrium.outer_load, abs=1e-4)
        force, _ = balance(placed)
        assert force == pytest.approx([0.0, -2780.0, 4930.0], abs=1e-4)


class TestTooMuch:
    def test_a_balance_far_away_is_none(self) -> None:
        """Rollers that cannot skew hold a ring that tilts by 40 mrad under a radial load; the run began with a blow of 50 kJ."""
        body = RingBody.hollow_cylinder(mass=17.0, outer_diameter=0.055, length=0.11, mass_offset=0.108)
        scene = Scene(
            cases.bearing_32216(),
            speed_rpm=473.0,
            axial_load=3679.0,
            radial_load=9197.0,
            radial_direction_deg=-114.8,
            effects=Effects.standard().replace(planar=True, front_rib=False),
            ring="free",
            ring_body=body,
            moment_x=0.0,
            moment_y=0.0,
        )
        with pytest.raises(LoadError, match=r"more than a tenth of a roller's diameter"):
            Simulation(scene)

    def test_radial_load_that_lifts_the_ring(self, rig: Bearing) -> None:
        limit = 4930.0 / math.tan(CUP)
        with pytest.raises(InputError, match="radial_load"):
            simulate(rig, 0.0, 4930.0, 1.0001 * limit)
        found = simulate(rig, 0.0, 4930.0, 0.999 * limit).equilibrium
        assert np.count_nonzero(found.outer_load > 1.0) == 3

    def test_radial_load_between_two_rollers(self, rig: Bearing) -> None:
        """Two rollers at 15 degrees to the load: all they carry is cos(15 deg) of what one can in its own direction."""
        limit = 4930.0 / math.tan(CUP) * math.cos(math.radians(15.0))
        with pytest.raises(LoadError, match="cannot carry"):
            simulate(rig, 0.0, 4930.0, 1.01 * limit, radial_direction_deg=75.0)
        found = simulate(rig, 0.0, 4930.0, 0.99 * limit, radial_direction_deg=75.0).equilibrium
        assert np.flatnonzero(found.outer_load > 1e3).tolist() == [2, 3]

    @pytest.mark.parametrize("axial", [0.0, -5.0, math.nan, math.inf])
    def test_axial_load(self, rig: Bearing, axial: float) -> None:
        with pytest.raises(InputError, match="axial_load"):
            simulate(rig, 0.0, axial)

    def test_moment_that_nothing_carries(self, rig: Bearing) -> None:
        with pytest.raises(LoadError, match="cannot carry"):
            simulate(rig, 0.0, 10.0, moment_x=1e4)

    @pytest.mark.parametrize("speed", [1000.0, 3000.0])
    def test_axial_load_that_does_not_hold_the_rollers_down(self, rig: Bearing, speed: float) -> None:
        """Centrifugal force drives the rollers up the cup: below the load where they leave the cone the ring is pushed
        off.

        There Qo cos(alpha_o) + Qr sin(theta) = Fc and Qo sin(alpha_o) = Qr cos(theta), theta the rib's angle.
        """
        g = rig.geometry
        orbit = g.cage_speed_ratio * speed * math.pi / 30
        centrifugal = g.roller_mass * orbit**2 * g.roller_centre_radius
        outer = centrifugal / (math.cos(CUP) + math.sin(CUP) * math.tan(g.rib_normal_angle))
        least = 12 * outer * math.sin(CUP)
        with pytest.raises(LoadError, match="axial_load must be at least"):
            simulate(rig, speed, 0.98 * least)
        found = simulate(rig, speed, 1.02 * least).equilibrium
        assert np.all(found.inner_load > 0.0)
        assert found.inner_load == pytest.approx(0.02 * outer, rel=0.2)


class TestCombinedLoads:
    def test_a_moment_is_held_by_the_running_bearing(self, rig: Bearing) -> None:
        """Rollers skew with the ring that a moment tilts. What is left, one per cent, is friction of rollers that twist as they
        orbit; with rollers that did not skew the ring held (27, 19.2) N m.
        """
        scene = Scene(rig, speed_rpm=3000.0, axial_load=8000.0, radial_load=4000.0, moment_x=-30.0, moment_y=20.0)
        run = Simulation(scene.replace(effects=scene.effects.replace(bodies="rollers")), accuracy="fast")
        assert np.abs(run.equilibrium.rollers[:, 3]).max() > 2e-4
        result = run.run(duration=0.08, save_every=1e-4)
        moment = np.asarray(result["ring_moment"])[400:, :2].mean(axis=0)
        assert moment == pytest.approx([30.0, -20.0], abs=0.4)

    def test_rollers_do_not_skew_without_a_reason(self, rig: Bearing) -> None:
        assert np.abs(simulate(rig, 3000.0, 4930.0).equilibrium.rollers[:, 3]).max() < 1e-12

    @pytest.mark.parametrize("direction", [0.0, 90.0, 180.0, 270.0])
    def test_heavy_loads_along_the_axes_are_found(self, rig: Bearing, direction: float) -> None:
        """Some of them are found only where the load is raised from a smaller one, in whichever direction it acts."""
        limit = most_radial_load(Scene(rig, speed_rpm=3000.0, axial_load=8000.0), 8000.0)
        for share in (0.98, 0.995):
            radial = share * limit * math.cos(math.radians(15.0))
            found = simulate(rig, 3000.0, 8000.0, radial, radial_direction_deg=direction).equilibrium
            assert found.residual < 1e-4 * radial

    @pytest.mark.parametrize("share", [0.88, 0.95, 0.97, 0.99])
    def test_loads_close_to_the_largest_are_found(self, rig: Bearing, share: float) -> None:
        """The largest load in a direction lies on the edge of the polygon whose corners are the rollers."""
        for direction in (3.0, 12.0, 87.2, 134.7):
            off = math.radians((direction - 15.0) % 30.0 if direction % 30.0 >= 15.0 else 15.0 - direction % 30.0)
            limit = most_radial_load(Scene(rig, speed_rpm=2000.0, axial_load=3000.0), 3000.0)
            radial = share * limit * math.cos(math.radians(15.0)) / math.cos(off)
            found = simulate(rig, 2000.0, 3000.0, radial, radial_direction_deg=direction).equilibrium
            assert found.residual < 1e-4 * radial

    def test_the_largest_load_is_named(self, rig: Bearing) -> None:
        with pytest.raises(
            LoadError, match=r"with these rollers \d+ N and \d+(\.\d+)? N m in this direction were balanced"
        ):
            simulate(rig, 3000.0, 8000.0, 4000.0, moment_x=500.0)
