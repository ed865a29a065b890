"""Cage pockets: the default one against the paper's plays, other shapes, and what is refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from trbdyn import _core, cases, pocket_shapes
from trbdyn.errors import InputError
from trbdyn.model import flatten
from trbdyn.model.bearing import Bearing
from trbdyn.model.pocket import Face, OtherPocket, Pocket


@pytest.fixture(scope="module")
def rig() -> Bearing:
    return cases.rig_30310()


def roller_gap(face: Face, bearing: Bearing, shift: np.ndarray) -> float:
    """Gap between the flank of a roller moved by `shift` (pocket frame) and a face, from points on the roller's surface."""
    geometry = bearing.geometry
    station = np.linspace(-0.5, 0.5, 41)[:, None] * bearing.roller.effective_length
    around = np.linspace(0, 2 * np.pi, 721)[None, :]
    radius = (geometry.apex_to_mid + station) * math.tan(geometry.roller_half_angle)
    points = np.stack([radius * np.cos(around), radius * np.sin(around), station + 0 * around], axis=-1) + shift
    return float(((points - face.origin) @ face.normal).min())


class TestDefaultPocket:
    def test_lean_and_gap(self, rig: Bearing) -> None:
        assert math.degrees(pocket_shapes.bar_lean(rig)) == pytest.approx(26.39, abs=0.005)
        gaps = rig.pocket.gaps(rig.geometry)
        assert gaps["leading_bar"] == pytest.approx(0.1074e-3, abs=0.5e-7)
        assert gaps["trailing_bar"] == pytest.approx(gaps["leading_bar"], rel=1e-12)
        assert gaps["large_end_wall"] == pytest.approx(0.0, abs=1e-12)
        assert gaps["small_end_wall"] == pytest.approx(0.4e-3, abs=1e-12)

    def test_slots(self, rig: Bearing) -> None:
        assert rig.slot_names == ("leading_bar", "trailing_bar", "large_end_wall", "small_end_wall")

    @pytest.mark.parametrize("name", ["leading_bar", "trailing_bar"])
    def test_bar_is_parallel_to_the_flank(self, rig: Bearing, name: str) -> None:
        face = rig.pocket.face(name)
        nu = rig.geometry.roller_half_angle
        assert face.normal[2] == pytest.approx(math.sin(nu), rel=1e-9)
        assert -np.array(face.origin) @ face.normal > 0
        assert math.copysign(1, face.origin[1]) == (1 if name == "leading_bar" else -1)
        assert roller_gap(face, rig, np.zeros(3)) == pytest.approx(0.1074e-3, abs=2e-7)

    def test_large_end_touches_the_nearest_edge_alone(self, rig: Bearing) -> None:
        geometry, wall = rig.geometry, rig.pocket.face("large_end_wall")
        centre = np.array([0.0, 0.0, geometry.sphere_centre - geometry.apex_to_mid])
        nearest = np.array([1.5e-3, 0.0, wall.origin[2]])
        assert np.linalg.norm(nearest - centre) == pytest.approx(geometry.sphere_radius, abs=1e-12)
        assert np.linalg.norm(wall.vertices - centre, axis=1).min() > geometry.sphere_radius
        assert wall.normal == pytest.approx([0, 0, -1])

    def test_small_end_wall_lies_on_the_roller_end(self, rig: Bearing) -> None:
        geometry, wall = rig.geometry, rig.pocket.face("small_end_wall")
        assert wall.normal == pytest.approx([0, 0, 1])
        radii = np.linalg.norm(wall.vertices[:, :2], axis=1)
        assert radii.max() == pytest.approx(geometry.small_end_radius, rel=1e-12)
        assert np.sort(wall.vertices[:, 0]) == pytest.approx([1.5e-3, 1.5e-3, 4.5e-3, 4.5e-3])
        assert wall.vertices[:, 2] == pytest.approx(-10.8e-3, abs=1e-12)
        assert np.abs(wall.vertices[:, 1]).max() == pytest.approx(6e-3)


class TestPocketShapes:
    @pytest.mark.parametrize("shape", sorted(pocket_shapes.SHAPES))
    def test_fits(self, rig: Bearing, shape: str) -> None:
        arguments = {"lean_deg": 10.0} if shape == "drafted" else {}
        pocket = pocket_shapes.SHAPES[shape](rig, **arguments)
        bearing = rig.replace(cage=rig.cage.replace(pocket=pocket))
        assert min(pocket.gaps(bearing.geometry).values()) > -1e-12
        assert flatten.face_rows(cases.paper_30310(bearing=bearing)).shape[0] == len(pocket.faces)

    def test_drafted_keeps_the_circumferential_play(self, rig: Bearing) -> None:
        face = pocket_shapes.drafted_pocket(rig, 10.0).face("leading_bar")
        assert roller_gap(face, rig, np.array([0.0, 0.12e-3, 0.0])) == pytest.approx(0.0, abs=2e-7)

    def test_stepped_stands_back(self, rig: Bearing) -> None:
        pocket = pocket_shapes.stepped_pocket(rig, step=80e-6, split=0.25)
        gaps = pocket.gaps(rig.geometry)
        assert gaps["leading_bar_step"] - gaps["leading_bar"] == pytest.approx(80e-6, rel=1e-6)
        small, large = (np.ptp(pocket.face(name).vertices[:, 2]) for name in ("leading_bar", "leading_bar_step"))
        assert large / small == pytest.approx(3.0, rel=0.02)

    def test_relief_leaves_two_lands(self, rig: Bearing) -> None:
        pocket = pocket_shapes.relieved_pocket(rig, relief=0.6)
        small, large = pocket.face("leading_bar"), pocket.face("leading_bar_large_end_land")
        assert large.vertices[:, 2].min() - small.vertices[:, 2].max() == pytest.approx(0.6 * 19.8e-3, rel=2e-3)

    def test_missing_bar_keeps_the_other_slots(self, rig: Bearing) -> None:
        pocket = pocket_shapes.one_sided_pocket(rig, missing="leading")
        assert [face.slot for face in pocket.faces] == [1, 2, 3]
        assert rig.replace(cage=rig.cage.replace(pocket=pocket)).slot_names[0] == ""

    def test_one_pocket_differs(self, rig: Bearing) -> None:
        other = OtherPocket(index=5, pocket=pocket_shapes.chamfered_pocket(rig))
        bearing = rig.replace(cage=rig.cage.replace(other_pockets=[other]))
        rows = flatten.face_rows(cases.paper_30310(bearing=bearing))
        columns = {name: place for place, name in enumerate(name for name, *_ in _core.face_table())}
        assert columns["pocket"] == 0
        assert sorted(set(rows[:, 0])) == list(range(12))
        assert bearing.pocket_of(5) != bearing.pocket_of(4)
        with pytest.raises(InputError, match=r"cage\.other_pockets\[0\]\.index = 12"):
            rig.replace(cage=rig.cage.replace(other_pockets=[other.replace(index=12)]))

    @pytest.mark.parametrize(
        ("builder", "arguments", "field"),
        [
            ("drafted", {"lean_deg": 95.0}, "lean_deg"),
            ("drafted", {"lean_deg": float("nan")}, "lean_deg"),
            ("stepped", {"step": -1e-6}, "step"),
            ("relieved", {"relief": 1.0}, "relief"),
            ("chamfered", {"chamfer": 2e-3}, "chamfer"),
            ("one_sided", {"missing": "left"}, "missing"),
        ],
    )
    def test_bad_arguments(self, rig: Bearing, builder: str, arguments: dict[str, Any], field: str) -> None:
        with pytest.raises(InputError) as caught:
            pocket_shapes.SHAPES[builder](rig, **arguments)
        assert caught.value.field == field

    def test_interference_names_the_face(self, rig: Bearing) -> None:
        face = rig.pocket.face("trailing_bar")
        closer = face.replace(origin=tuple(np.array(face.origin) + 0.11e-3 * face.normal))
        pocket = rig.pocket.with_face(closer)
        with pytest.raises(InputError, match=r"bearing\.cage\.pocket\.faces\[1\]\.origin") as caught:
            rig.replace(cage=rig.cage.replace(pocket=pocket))
        assert "clearances do not fit" in caught.value.allowed
        assert "'trailing_bar'" in caught.value.allowed
        allowed = pocket.replace(allow_interference=True)
        assert rig.replace(cage=rig.cage.replace(pocket=allowed)).pocket.gaps(rig.geometry)["trailing_bar"] < 0

    def test_small_end_face_must_lie_on_the_end(self, rig: Bearing) -> None:
        wall = rig.pocket.face("small_end_wall")
        wide = wall.replace(outline=((1.5e-3, -6e-3), (4.5e-3, -6e-3), (4.5e-3, 6e-3), (1.5e-3, 6e-3)))
        with pytest.raises(InputError, match="small end"):
            rig.replace(cage=rig.cage.replace(pocket=rig.pocket.with_face(wide)))


class TestFace:
    @staticmethod
    def make(**changes: Any) -> Face:
        fields: dict[str, Any] = {
            "name": "face",
            "slot": 0,
            "part": "flank",
            "origin": (0.01, 0.0, 0.0),
            "u": (0.0, 0.6, 0.8),
            "v": (0.0, -0.8, 0.6),
            "outline": ((0.0, 0.0), (2e-3, 0.0), (3e-3, 1e-3), (0.0, 2e-3)),
        }
        return Face(**{**fields, **changes})

    def test_distance_against_sampling(self) -> None:
        face = self.make()
        rng = np.random.default_rng(3)
        weights = rng.dirichlet(np.full(4, 0.3), 200_000)
        samples = weights @ face.vertices
        for point in rng.uniform(-4e-3, 6e-3, (20, 3)) + face.origin:
            sampled = np.linalg.norm(samples - point, axis=1).min()
            exact = float(face.distance(point))
            assert exact <= sampled + 1e-12
            assert exact == pytest.approx(sampled, abs=6e-5)

    def test_distance_inside_is_the_height(self) -> None:
        face = self.make()
        points = face.vertices.mean(axis=0) + np.array([[1e-3], [-2e-3]]) * face.normal
        assert face.distance(points) == pytest.approx([1e-3, 2e-3])

    @pytest.mark.parametrize(
        ("field", "value"),
        [
            ("u", (0.0, 0.6, 0.81)),
            ("v", (1.0, 0.0, 0.0001)),
            ("v", (0.0, 0.6, 0.8)),
            ("outline", ((0.0, 0.0), (1e-3, 0.0))),
            ("outline", ((0.0, 0.0), (0.0, 1e-3), (1e-3, 0.0))),
            ("outline", ((0.0, 0.0), (2e-3, 0.0), (0.5e-3, 0.5e-3), (0.0, 2e-3))),
            ("outline", ((0.0, 0.0), (1e-3, 0.0), (2e-3, 0.0), (0.0, 1e-3))),
            ("outline", ((0.0, 0.0), (1e-3, 0.0), (2e-3, 0.0))),
            ("outline", ((0.0, 0.0), (0.0, 0.0), (1e-3, 0.0), (0.0, 1e-3))),
            ("outline", tuple((math.cos(a), math.sin(a)) for a in 2 * np.pi * np.arange(13) / 13)),
            ("outline", tuple((math.cos(a), math.sin(a)) for a in 4 * np.pi * np.arange(5) / 5)),
            ("part", "side"),
            ("stiffness_factor", 0.0),
            ("friction_factor", -0.1),
            ("slot", -1),
            ("slot", True),
            ("name", ""),
            ("origin", (0.0, float("inf"), 0.0)),
        ],
    )
    def test_refuses(self, field: str, value: object) -> None:
        with pytest.raises(InputError) as caught:
            self.make(**{field: value})
        assert caught.value.field.startswith(f"face.{field}")

    def test_pocket_refuses_shared_names_and_surfaces_of_two_parts(self) -> None:
        with pytest.raises(InputError, match=r"pocket\.faces\[1\]\.name = 'bar'"):
            Pocket(faces=[self.make(name="bar"), self.make(name="bar")])
        with pytest.raises(InputError, match=r"pocket\.faces\[1\]\.part = 'large_end' : must be 'flank'"):
            Pocket(faces=[self.make(), self.make(name="second", part="large_end")])
        with pytest.raises(InputError, match="at least 1"):
            Pocket(faces=[])
