"""Equations of motion: rollers and the cage as bodies of one array, Newton-Euler in frames that do not spin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trbdyn.model.scene import Scene

from .constants import Constants
from .pocket import pocket_wrenches
from .rings import Poses, cross, five, ring_wrenches

Array = NDArray[np.float64]


@dataclass
class Bodies:
    """What a state stands for; bodies are the rollers, then the cage: (..., body, state)."""

    values: Array  # the eleven entries of each body, not as offsets
    frames: Array  # (axis n, t, a; component; body; state)
    skew: tuple[Array, Array]  # cosine and sine
    turn: tuple[Array, Array]  # cosine and sine of the orbit angle in R; the cage's is zero
    omega: Array  # angular velocity in the body's parent frame
    parent: Array  # rate of the parent frame about the bearing axis
    seen: Array  # ring axis, centre, gravity, ring omega in the parent frame, (3, which, body, state)
    cage_axes: Array  # axes of the cage's body in R as columns, (state, 3, 3)


class NumpyModel:
    """Right-hand side of a scene for any number of states at once.

    The state is that of the core without its tail of spin angles and energies, which nothing depends on.

    Parameters
    ----------
    scene : Scene
        The scene.
    """

    def __init__(self, scene: Scene) -> None:
        self.constants = Constants(scene)
        self.n_state = self.constants.n_state
        self.evaluations = 0

    def derivative(self, time: float, y: Array) -> Array:
        """Rates of states, shape (n_state,) or (n_state, states)."""
        self.evaluations += 1
        bodies = self.bodies(time, y)
        wrenches = self.ring_loads(bodies)
        pocket = self.pocket_loads(bodies)
        if pocket is not None:
            wrenches += pocket[0]
        return self.rates(bodies, wrenches, None if pocket is None else pocket[1].sum(axis=1)).reshape(y.shape)

    def bodies(self, time: float, y: Array) -> Bodies:
        """Poses of rollers and cage."""
        c, z = self.constants, self.constants.n_rollers
        y = y.reshape(self.n_state, -1)
        values = y[c.index]
        values += c.base
        angles = values[1:5].copy()
        angles[0, z] = 0.0
        np.add(angles[0], c.frame_speed * (time - c.start_time), out=angles[1])
        cosine, sine = np.cos(angles), np.sin(angles)
        frames = np.zeros((3, 3, *cosine.shape[1:]))
        frames[0, 0] = cosine[3]
        np.negative(sine[3], out=frames[0, 2])
        np.multiply(sine[2], frames[0, 2], out=frames[1, 0])
        frames[1, 1] = cosine[2]
        np.multiply(-sine[2], cosine[3], out=frames[1, 2])
        np.multiply(cosine[2], sine[3], out=frames[2, 0])
        frames[2, 1] = sine[2]
        np.multiply(cosine[2], cosine[3], out=frames[2, 2])
        omega = (frames * values[8:11, None]).sum(axis=0)
        parent = np.full(values.shape[1:], c.frame_speed)
        np.divide(values[6, :z], values[0, :z], out=parent[:z])
        fixed = c.fixed_vectors
        seen = np.empty((3, 4, *parent.shape))
        seen[0] = fixed[0] * cosine[1] + fixed[1] * sine[1]
        seen[1] = fixed[1] * cosine[1] - fixed[0] * sine[1]
        seen[2] = fixed[2]
        turned_cos, turned_sin = np.cos(y[c.cage_turn]), np.sin(y[c.cage_turn])
        own = frames[:, :, z]
        axes = np.empty((y.shape[1], 3, 3))
        axes[..., 0] = (turned_cos * own[0] + turned_sin * own[1]).T
        axes[..., 1] = (turned_cos * own[1] - turned_sin * own[0]).T
        axes[..., 2] = own[2].T
        return Bodies(values, frames, (cosine[2], sine[2]), (cosine[0], sine[0]), omega, parent, seen, axes)

    def ring_loads(self, b: Bodies, states: slice = slice(None)) -> Array:
        """Wrenches of the rings on the rollers, (6, roller, state)."""
        z = self.constants.n_rollers
        x = np.zeros((3, z, b.parent[:, states].shape[1]))
        x[0], x[2] = b.values[0, :z, states], b.values[2, :z, states]
        return ring_wrenches(
            self.constants,
            Poses(
                x,
                b.frames[2, :, :z, states],
                b.values[5:8, :z, states],
                b.omega[:, :z, states],
                b.parent[:z, states],
                b.seen[:, 0, :z, states],
                b.seen[:, 1, :z, states],
                b.seen[:, 3, :z, states],
            ),
        )

    def pocket_loads(self, b: Bodies) -> tuple[Array, Array] | None:
        """Wrenches of the pockets on rollers and cage, (6, roller, state) each; None if nothing touches."""
        z = self.constants.n_rollers
        roller = np.zeros((3, 4, z, b.parent.shape[1]))
        roller[0, 0], roller[2, 0] = b.values[0, :z], b.values[2, :z]
        roller[:, 1] = b.frames[2, :, :z]
        roller[:, 2] = b.values[5:8, :z]
        roller[:, 3] = b.omega[:, :z]
        cage = np.empty((3, 3, b.parent.shape[1]))
        cage[:, 0] = b.values[:3, z]
        cage[:, 1] = b.values[5:8, z]
        cage[:, 2] = b.omega[:, z]
        return pocket_wrenches(self.constants, roller, (b.turn[0][:z], b.turn[1][:z]), cage, b.cage_axes)

    def rates(self, b: Bodies, wrenches: Array, on_cage: Array | None) -> Array:
        """Newton and Euler for every body under the wrenches on rollers (6, roller, state) and cage (6, state)."""
        c, z = self.constants, self.constants.n_rollers
        values, parent, frames = b.values, b.parent, b.frames
        load = np.zeros((2, 3, *parent.shape))
        load[:, :, :z] = wrenches.reshape(2, 3, *wrenches.shape[1:])
        if on_cage is not None:
            load[:, :, z] = on_cage.reshape(2, 3, -1)
        out = np.empty((self.n_state, parent.shape[1]))
        rates = np.empty_like(values)
        # translation: position of rollers in cylinder coordinates, of the cage in R
        rates[:3] = values[5:8]
        rates[1, :z] = parent[:z]
        rates[1, :z] -= c.frame_speed
        rates[0, z] += c.frame_speed * values[1, z]
        rates[1, z] -= c.frame_speed * values[0, z]
        np.multiply(load[0], c.per_mass, out=rates[5:8])
        rates[5:8] += b.seen[:, 2]
        rates[5] += values[6] * parent
        rates[6] -= values[5] * parent
        # rotation
        moment = (frames * load[1]).sum(axis=1)
        cosine, sine = b.skew
        carried = parent * frames[:, 2]
        np.subtract(carried[0], values[8], out=rates[3])
        np.divide(values[9] - carried[1], cosine, out=rates[4])
        frame_a = carried[2] + rates[4] * sine
        gyro = c.transverse * frame_a - c.axial * values[10]
        np.add(moment[0], gyro * values[9], out=rates[8])
        np.subtract(moment[1], gyro * values[8], out=rates[9])
        rates[8:10] *= c.per_transverse
        np.multiply(moment[2], c.per_axial, out=rates[10])
        out[c.index] = rates
        out[c.cage_turn] = values[10, z] - frame_a[z]
        return out


__all__ = ["Bodies", "NumpyModel", "cross", "five"]
