"""Bodies placed by independent kinematics: rotations by SciPy, points of surfaces, no inscribed spheres."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from trbdyn import Simulation, cases
from trbdyn.model.bearing import Bearing, Profile
from trbdyn.model.geometry import Geometry

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Placed:
    """Axes of a body in inertial coordinates (columns n, t, a) and the place of its centre of mass or reference."""

    axes: Array
    origin: Array

    def points(self, local: Array) -> Array:
        """Points given in the body's axes, shape (..., 3), in inertial coordinates."""
        return self.origin + local @ self.axes.T


class Places:
    """Where rollers, ring and pockets of a simulation are at a state vector, at time 0."""

    def __init__(self, sim: Simulation, vector: Array) -> None:
        self.sim, self.state = sim, sim.view(vector)
        self.geometry: Geometry = sim.scene.bearing.geometry

    def roller(self, j: int) -> Placed:
        """A roller from its mid length on the axis; it stands at time 0, when the frame R is at angle 0."""
        g, s = self.geometry, self.state
        angle = 2 * np.pi * j / self.sim.scene.bearing.n_rollers + float(s["roller_psi"][j])
        turn = Rotation.from_euler("z", angle)
        lean = Rotation.from_euler("y", g.roller_axis_angle + float(s["roller_tilt"][j]))
        skew = Rotation.from_euler("x", -float(s["roller_skew"][j]))
        axes = (turn * lean * skew).as_matrix()
        mass = turn.apply([g.roller_centre_radius + s["roller_r"][j], 0.0, g.roller_centre_height + s["roller_z"][j]])
        return Placed(axes, mass - g.roller_mass_offset * axes[:, 2])

    def ring(self) -> Placed:
        """The inner ring from its cone's apex."""
        shift, turn = self.sim.equilibrium.displacement[:3], self.sim.equilibrium.displacement[3:]
        axes = Rotation.from_rotvec([*turn, 0.0]).as_matrix()
        centre = shift + np.array([0.0, 0.0, self.geometry.centre_plane])
        return Placed(axes, centre - self.geometry.centre_plane * axes[:, 2])

    def pocket(self, j: int) -> Placed:
        """A pocket's axes n, t, a from the mid length of the nominal roller."""
        g, s = self.geometry, self.state
        body = Rotation.from_euler("y", float(s["cage_tilt"])) * Rotation.from_euler("x", -float(s["cage_skew"]))
        body = body * Rotation.from_euler("z", float(s["cage_psi"]))
        mine = Rotation.from_euler("z", 2 * np.pi * j / self.sim.scene.bearing.n_rollers)
        lean = Rotation.from_euler("y", g.roller_axis_angle)
        mass = np.array([s["cage_x"], s["cage_y"], g.centre_plane + self.sim.scene.bearing.cage.offset + s["cage_z"]])
        apex = mass - body.apply([0.0, 0.0, g.centre_plane + self.sim.scene.bearing.cage.offset])
        axes = (body * mine * lean).as_matrix()
        return Placed(axes, apex + g.apex_to_mid * axes[:, 2])


def beyond_cone(points: Array, apex: Array, axis: Array, half_angle: float) -> Array:
    """Signed distance of points to a cone, positive away from its axis."""
    relative = points - apex
    along = relative @ axis
    off = np.linalg.norm(relative - along[..., None] * axis, axis=-1)
    return off * np.cos(half_angle) - along * np.sin(half_angle)


@pytest.fixture(scope="session")
def places() -> type[Places]:
    """Makes places of a simulation and a state vector."""
    return Places


@pytest.fixture(scope="session")
def cone_distance() -> Callable[[Array, Array, Array, float], Array]:
    """Signed distance of points to a cone."""
    return beyond_cone


@pytest.fixture(scope="session")
def rig() -> Bearing:
    """The 30310 rig with its logarithmic profile."""
    return cases.rig_30310()


@pytest.fixture(scope="session")
def straight_rig(rig: Bearing) -> Bearing:
    """The 30310 rig with a straight generator."""
    return rig.replace(roller=rig.roller.replace(profile=Profile.straight()))


@pytest.fixture(scope="session")
def drawings() -> ModuleType:
    """The script that writes the example cages as STEP files."""
    script = Path(__file__).resolve().parents[2] / "examples/cage_drawings/drawings.py"
    spec = importlib.util.spec_from_file_location("cage_drawings", script)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
