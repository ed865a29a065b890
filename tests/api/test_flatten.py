"""How scenes and time histories reach the core."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from trbdyn import _core, cases
from trbdyn.errors import InputError
from trbdyn.model import flatten
from trbdyn.model.bearing import Bearing
from trbdyn.model.effects import Effects
from trbdyn.model.lubricants import vg100
from trbdyn.model.motion import History, knot_table
from trbdyn.model.scene import Scene


@pytest.fixture(scope="module")
def rig() -> Bearing:
    return cases.rig_30310()


@pytest.fixture(scope="module")
def scene() -> Scene:
    return cases.paper_30310()


class TestHistory:
    times, values = (0.0, 0.1, 0.35, 0.5), (0.0, 10.0, 12.0, 5.0)

    def test_passes_through_its_values_and_stays_between_them(self) -> None:
        history = History.table(self.times, self.values)
        assert history.value(self.times) == pytest.approx(self.values)
        fine = history.value(np.linspace(-1, 2, 5001))
        assert fine.min() >= 0.0
        assert fine.max() <= 12.0
        assert (history.value(-3.0), history.value(9.0)) == pytest.approx((0.0, 5.0))

    def test_use_leaves_it_equal(self) -> None:
        used, fresh = History.table(self.times, self.values), History.table(self.times, self.values)
        used.value(0.2)
        assert used == fresh
        assert hash(used) == hash(fresh)
        assert used != fresh.replace(values=(0.0, 10.0, 12.0, 5.1))

    def test_is_smooth_everywhere(self) -> None:
        history = History.table(self.times, self.values)
        assert (history.slope(0.0), history.slope(0.5)) == (0.0, 0.0)
        t = np.linspace(-0.05, 0.6, 3001)
        numeric = (history.value(t + 1e-7) - history.value(t - 1e-7)) / 2e-7
        assert history.slope(t) == pytest.approx(numeric, abs=2e-3)

    @pytest.mark.parametrize(("start", "end"), [(-0.3, 0.05), (0.05, 0.45), (-1.0, 2.0), (0.7, 0.9), (-2.0, -1.0)])
    def test_integral(self, start: float, end: float) -> None:
        history = History.table(self.times, self.values)
        points = [t for t in self.times if start < t < end]
        expected = quad(history.value, start, end, points=points or None, epsabs=1e-12)[0]
        assert history.integral(start, end) == pytest.approx(expected, abs=1e-9)

    def test_knot_table_keeps_every_curve(self) -> None:
        histories = [History.table(self.times, self.values), History.ramp(0.2, 0.8, -1.0, 3.0), 7.0]
        table = knot_table(histories)
        assert table.shape == (6, 8)
        t = np.linspace(-0.2, 1.0, 2001)
        for channel, quantity in enumerate(histories):
            expected = quantity.value(t) if isinstance(quantity, History) else np.full_like(t, quantity)
            assert hermite(table, channel, t) == pytest.approx(expected, abs=1e-12)

    @pytest.mark.parametrize(
        ("times", "values", "where"),
        [
            ([0.0], [1.0], "history.times"),
            ([0.0, 1.0], [1.0], "history.values"),
            ([0.0, 1.0, 1.0], [1.0, 2.0, 3.0], "history.times[2]"),
            ([0.0, float("nan")], [1.0, 2.0], "history.times[1]"),
            ([0.0, 1.0], [1.0, True], "history.values[1]"),
        ],
    )
    def test_refuses(self, times: list[float], values: list[float], where: str) -> None:
        with pytest.raises(InputError) as caught:
            History(times=times, values=values)
        assert caught.value.field == where


def hermite(table: np.ndarray, channel: int, t: np.ndarray) -> np.ndarray:
    """Cubic Hermite curve of a channel of a knot table, constant outside."""
    knots, value, slope = table[:, 0], table[:, 1 + 2 * channel], table[:, 2 + 2 * channel]
    inside = np.clip(t, knots[0], knots[-1])
    k = np.clip(np.searchsorted(knots, inside, side="right") - 1, 0, len(knots) - 2)
    width = knots[k + 1] - knots[k]
    s = (inside - knots[k]) / width
    rise = value[k] * (1 + 2 * s) * (1 - s) ** 2 + value[k + 1] * s**2 * (3 - 2 * s)
    return rise + width * (slope[k] * s * (1 - s) ** 2 - slope[k + 1] * s**2 * (1 - s))


class TestFlatten:
    def test_block_has_every_number_at_its_place(self, scene: Scene) -> None:
        block = dict(zip([row[0] for row in _core.parameter_table()], flatten.parameter_block(scene), strict=True))
        assert block["n_rollers"] == 12
        assert block["cup_half_angle"] == pytest.approx(math.radians(12.95278), abs=1e-7)
        assert block["roller_diameter"] == 14e-3
        assert block["rib_contact_height"] == 1.667e-3
        assert block["profile"] == 2
        assert block["viscosity"] == vg100(60).viscosity
        assert block["temperature"] == 60.0
        assert block["boundary_decay"] == 181.46
        assert (block["lubrication"], block["traction"], block["with_cage"], block["planar"]) == (2, 2, 1, 0)
        assert (block["thermal"], block["rolling_resistance"], block["rolling_pressure_force"]) == (1, 1, 0)

    def test_tables_that_differ_are_an_error(self, scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
        table = _core.parameter_table()
        monkeypatch.setattr(_core, "parameter_table", lambda: [*table, ("novelty", "1", 0.0, 1.0, "", "bearing")])
        with pytest.raises(RuntimeError, match="novelty"):
            flatten.parameter_block(scene)
        monkeypatch.setattr(_core, "parameter_table", lambda: table[1:])
        with pytest.raises(RuntimeError, match="n_rollers"):
            flatten.parameter_block(scene)

    def test_range_of_the_table_is_told_in_the_users_terms(self, scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
        table = [
            (n, u, 1.0, 9.0, t, p) if n == "cage_mass" else (n, u, a, b, t, p)
            for n, u, a, b, t, p in _core.parameter_table()
        ]
        monkeypatch.setattr(_core, "parameter_table", lambda: table)
        with pytest.raises(InputError, match=r"bearing\.cage\.mass = 0\.2 : must be from 1 to 9 \(kg\)"):
            flatten.parameter_block(scene)

    def test_face_rows(self, scene: Scene) -> None:
        rows = flatten.face_rows(scene)
        counts = [count for _, count, _, _ in _core.face_table()]
        assert rows.shape == (4, sum(counts))
        starts = dict(zip([name for name, *_ in _core.face_table()], np.cumsum([0, *counts[:-1]]), strict=True))
        for row, face in zip(rows, scene.bearing.pocket.faces, strict=True):
            assert row[starts["pocket"]] == -1
            assert row[starts["slot"]] == face.slot
            assert row[starts["n_vertices"]] == len(face.outline)
            first = row[starts["outline"] : starts["outline"] + 2]
            origin, u, v = (row[starts[name] : starts[name] + 3] for name in ("origin", "u", "v"))
            assert origin + first[0] * u + first[1] * v == pytest.approx(face.vertices[0], abs=1e-15)
        assert rows[:, starts["part"]].tolist() == [0, 0, 1, 2]

    def test_films_off_means_their_effects_off(self, scene: Scene) -> None:
        dry = scene.replace(effects=Effects.standard().replace(lubrication="dry"))
        entries = flatten.scene_entries(dry)
        assert [entries[n].value for n in ("thermal", "rolling_resistance", "rolling_pressure_force")] == [0, 0, 0]

    def test_loads_of_two_frequencies_in_one_channel(self, scene: Scene) -> None:
        waves = [History.harmonic(0.0, 10.0, frequency_hz=f) for f in (50.0, 70.0)]
        loads: dict[str, flatten.Load] = {"force_x": tuple((2.0, wave) for wave in waves)}
        period = flatten.loads_period(scene, loads)
        assert period == pytest.approx(0.1)  # five of one, seven of the other
        table = flatten.motion_table(scene, [0.0] * 5, loads=loads)
        t = np.linspace(0.0, 0.0999, 500)
        channel = [name for name, *_ in _core.motion_table()].index("force_x")
        assert hermite(table, channel, t) == pytest.approx(2.0 * sum(wave.value(t) for wave in waves), abs=1e-9)

    def test_ring_load(self, rig: Bearing) -> None:
        scene = Scene(rig, speed_rpm=-60, axial_load=4930, radial_load=100, radial_direction_deg=30, moment_y=2.0)
        load = flatten.ring_load(scene)
        assert load.force == pytest.approx([100 * math.cos(math.pi / 6), 50, -4930])
        assert load.fixed.tolist() == [0, 0, 0, 1, 0]
        assert load.moment.tolist() == [0, 2]
        assert load.shaft_speed == pytest.approx(-2 * math.pi)
        assert load.gravity.tolist() == [0, -9.80665, 0]
        up = flatten.ring_load(scene.replace(radial_direction_deg=90.0)).force
        assert up == pytest.approx([0, 100, -4930], abs=1e-12)

    def test_ring_by_displacement(self, rig: Bearing) -> None:
        scene = Scene(rig, speed_rpm=60, displacement=(1e-6, 0, -2e-6), misalignment_x=1e-3)
        load = flatten.ring_load(scene)
        assert load.fixed.tolist() == [1, 1, 1, 1, 1]
        assert load.displacement.tolist() == [1e-6, 0, -2e-6, 1e-3, 0]

    def test_held_ring(self, scene: Scene) -> None:
        table = flatten.motion_table(scene, [1e-6, 2e-6, -3e-6, 9.0, 9.0])
        assert table.shape == (1, 44)
        values = dict(zip([name for name, _, _ in _core.motion_table()], table[0, 1:-1:2], strict=True))
        assert (values["displacement_x"], values["displacement_y"], values["displacement_z"]) == (1e-6, 2e-6, -3e-6)
        assert (values["rotation_x"], values["rotation_y"]) == (0.0, 0.0)
        assert values["shaft_speed"] == pytest.approx(100 * math.pi)
        assert values["gravity_y"] == -9.80665
        assert not table[0, 2::2].any()

    def test_ring_that_follows_its_load(self, rig: Bearing) -> None:
        load = History.table((0.1, 0.2, 0.6), (1000.0, 4000.0, 2000.0))
        scene = Scene(rig, speed_rpm=History.ramp(0, 0.05, 0, 600), axial_load=load, moment_x=0.0, ring="follows")
        place = load.replace(values=tuple(-1e-9 * value for value in load.values))
        turn = load.replace(values=tuple(-5e-10 * value for value in load.values))
        table = flatten.motion_table(scene, [0.0, 0.0, place, turn, 7.0])
        assert table[:, 0].tolist() == [0.0, 0.05, 0.1, 0.2, 0.6]
        channels = [name for name, _, _ in _core.motion_table()]
        t = np.linspace(-0.1, 0.8, 901)
        assert hermite(table, channels.index("displacement_z"), t) == pytest.approx(-1e-9 * load.value(t), abs=1e-18)
        assert hermite(table, channels.index("rotation_x"), np.array([0.2])) == pytest.approx([-2e-6])
        assert not hermite(table, channels.index("rotation_y"), t).any()
        assert hermite(table, channels.index("shaft_speed"), np.array([0.3])) == pytest.approx([20 * math.pi])

    def test_gravity_off(self, rig: Bearing) -> None:
        scene = Scene(rig, speed_rpm=60, axial_load=1e3, effects=Effects(gravity=False))
        assert not flatten.ring_load(scene).gravity.any()
        assert not flatten.motion_table(scene, [0.0] * 5)[0, 13:].any()
