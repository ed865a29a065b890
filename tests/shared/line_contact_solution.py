"""Film and pressure of a lubricated line contact in pure rolling, solved numerically: a reference that no fitted law enters.

Reynolds' equation with the viscosity of Barus or of Roelands and the density of Dowson and Higginson, and the elastic half
space, in Hertz's scales: X = x/b, P = p/p_max, H = h Re/b^2. Finite volumes: the flow at a face is that of the pressure's slope
less that of the surfaces, whose film is taken from upwind to second order; where the flow cannot fill the gap behind the
contact, the pressure is zero (complementarity). One Newton system holds the pressures and the approach of the bodies, with the
exact matrix of a pressure that is linear between nodes; a path from a small to the full pressure coefficient leads to the
solution.

Oil may end at a meniscus before the contact. Heat of the inlet: oil is sheared across the film, and the heat goes into both
surfaces, which keep their temperature (conduction alone, as Murch and Wilson 1975). With the parabolic flow of the pressure's
slope the mean rise is 0.6 eta u^2 (1 - h*/h)^2/k', and the viscosity falls by exp(-theta) with theta = beta times this rise.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import lambertw

Array = NDArray[np.float64]

MODULUS = 226.37e9
"""E' of steel on steel (Pa): the density's law is the only one that needs it."""
CORE, GROWTH, OUTLET = 1.3, 1.05, 1.6
"""Evenly spaced nodes up to this |X|, growth of the spacing beyond, and where the outlet ends."""


@dataclass(frozen=True)
class LineContact:
    """What the solution gives.

    Attributes
    ----------
    force : float
        F/(E' Re l): what drags each surface against rolling, from the slope of the pressure.
    moment : float
        The same from the moment of the pressure about the contact's centre; both are equal where nothing is wrong.
    central, smallest : float
        Film thickness at the centre, and the smallest, over Re.
    x, pressure : ndarray
        Nodes and pressure in Hertz's scales.
    """

    force: float
    moment: float
    central: float
    smallest: float
    x: Array
    pressure: Array


class NoSolution(RuntimeError):
    """Newton's method found none."""


def solve(
    w: float,
    u: float,
    g: float,
    nodes: int = 150,
    *,
    viscosity: float | None = None,
    heat: float = 0.0,
    meniscus: float | None = None,
) -> LineContact:
    """Solve a line contact.

    Parameters
    ----------
    w, u, g : float
        The groups W = w/(E' Re), U = eta0 u/(E' Re) with the mean speed u, and G = alpha0 E'.
    nodes : int
        Evenly spaced nodes across the contact.
    viscosity : float, optional
        eta0 (Pa s) for the law of Roelands; that of Barus otherwise.
    heat : float
        L = eta0 beta u^2/k' of the mean speed (1); 0: no heat.
    meniscus : float, optional
        Where the oil begins before the contact's centre, in half widths; far away otherwise.

    Returns
    -------
    LineContact

    Raises
    ------
    NoSolution
        If Newton's method does not converge.
    """
    system = _System(w, u, nodes, viscosity, meniscus)
    last = g * system.peak
    pressure, approach = system.start(2.922 * w**-0.166 * u**0.692 * g**0.470)
    alpha, step, order = min(0.5, last), 0.3, 0.0
    state = system.newton(pressure, approach, alpha, order, 200)
    while alpha < last or order < 1.0:
        if state is None:
            raise NoSolution(f"no solution at W {w:g}, U {u:g}, G {g:g}")
        stiffer, higher = (min(last, alpha + step), order) if alpha < last else (alpha, min(1.0, order + step))
        tried = system.newton(*state, stiffer, higher, 40)
        if tried is not None:
            state, alpha, order = tried, stiffer, higher
            step = min(1.5 * step, 2.0)
        elif step < 1e-3:
            raise NoSolution(f"no solution at W {w:g}, U {u:g}, G {g:g}")
        else:
            step *= 0.5
    if state is None:
        raise NoSolution(f"no solution at W {w:g}, U {u:g}, G {g:g}")
    for _ in range(60 if heat else 0):
        warmer = system.warmed(*state, last, heat)
        change = float(np.max(np.abs(warmer - system.theta)))
        system.theta += 0.7 * (warmer - system.theta)
        state = system.newton(*state, last, 1.0, 60)
        if state is None:
            raise NoSolution(f"no solution at W {w:g}, U {u:g}, G {g:g}, L {heat:g}")
        if change < 1e-4:
            break
    return system.found(*state)


class _System:
    def __init__(self, w: float, u: float, nodes: int, viscosity: float | None, meniscus: float | None) -> None:
        self.speed, self.meniscus = u, meniscus
        self.roelands = None if viscosity is None else float(np.log(viscosity) + 9.67)
        self.half = float(np.sqrt(8.0 * w / np.pi))
        self.peak = 2.0 * w / (np.pi * self.half)
        self.flow = 12.0 * u / (self.half**3 * self.peak)
        x = self.x = _grid(nodes, max(8.0, 60.0 * np.sqrt(2.0 * u) / w) if meniscus is None else meniscus)
        n, dx = len(x), np.diff(x)
        self.theta = np.zeros(n - 1)
        self.kernel, self.gap = _kernel(x), 0.5 * x * x
        self.weight = np.zeros(n)
        self.weight[:-1] += 0.5 * dx
        self.weight[1:] += 0.5 * dx
        face = np.arange(n - 1)
        self.mean, self.slope, self.upwind = np.zeros((n - 1, n)), np.zeros((n - 1, n)), np.zeros((n - 1, n))
        self.mean[face, face] = self.mean[face, face + 1] = 0.5
        self.slope[face, face], self.slope[face, face + 1] = -1.0 / dx, 1.0 / dx
        self.upwind[face, face] = 1.0
        self.second = np.zeros((n - 1, n))
        ratio = 0.5 * dx[1:] / dx[:-1]
        self.second[face[1:], face[1:]], self.second[face[1:], face[:-1]] = ratio, -ratio

    def start(self, film: float) -> tuple[Array, float]:
        """Hertz's pressure with a film at its centre."""
        pressure = np.sqrt(np.maximum(1.0 - self.x**2, 0.0))
        height = self.gap + self.kernel @ pressure
        return pressure, film / self.half**2 - float(height[np.argmin(np.abs(self.x))])

    def density(self, pressure: Array) -> tuple[Array, Array]:
        p = np.maximum(pressure, 0.0) * self.peak * MODULUS
        slope = 0.6e-9 / (1.0 + 1.7e-9 * p) ** 2 * self.peak * MODULUS
        return 1.0 + 0.6e-9 * p / (1.0 + 1.7e-9 * p), np.where(pressure > 0.0, slope, 0.0)

    def exponent(self, pressure: Array, alpha: float) -> tuple[Array, Array]:
        """ln(eta/eta0) and its slope; alpha is that of the scaled pressure."""
        if self.roelands is None:
            return alpha * pressure, np.full_like(pressure, alpha)
        scale = 5.1e-9 * self.peak * MODULUS
        z = alpha / (scale * self.roelands)
        return self.roelands * ((1.0 + scale * pressure) ** z - 1.0), alpha * (1.0 + scale * pressure) ** (z - 1.0)

    def warmed(self, pressure: Array, approach: float, alpha: float, heat: float) -> Array:
        """theta at each face from the flow that the pressure drives."""
        film = np.maximum(self.mean @ (approach + self.gap + self.kernel @ pressure), 1e-7)
        exponent, _ = self.exponent(self.mean @ np.maximum(pressure, 0.0), alpha)
        driven = film**2 / self.flow * (self.slope @ pressure)
        # theta exp(theta) = 0.6 L exp(exponent) (1 - h*/h)^2, and 1 - h*/h = driven exp(theta - exponent)
        found: Array = np.real(lambertw(0.6 * heat * np.exp(2.0 * self.theta - exponent) * driven**2))
        return found

    def newton(
        self, pressure: Array, approach: float, alpha: float, order: float, most: int
    ) -> tuple[Array, float] | None:
        n, k = len(self.x), np.arange(1, len(self.x) - 1)
        upwind, core = self.upwind + order * self.second, np.abs(self.x) < 1.5
        empty, changed, settled = np.zeros(n - 2, dtype=bool), False, False
        for step in range(most):
            height = approach + self.gap + self.kernel @ pressure
            film, carries = np.maximum(self.mean @ height, 1e-7), (pressure > 0.0).astype(float)
            rho, rho_slope = self.density(pressure)
            rho_face = self.mean @ rho
            exponent, steeper = self.exponent(self.mean @ np.maximum(pressure, 0.0), alpha)
            ease = rho_face * film**3 / self.flow * np.exp(self.theta - exponent)
            driven = ease * (self.slope @ pressure)
            by_pressure = ease[:, None] * self.slope + self.mean * (
                (driven / rho_face)[:, None] * rho_slope - (steeper * driven)[:, None] * carries
            )
            flow = driven - upwind @ (rho * height)
            to_height = 3.0 * driven / film
            jacobian = by_pressure + to_height[:, None] * (self.mean @ self.kernel)
            jacobian -= upwind @ (rho[:, None] * self.kernel) + upwind * (rho_slope * height)
            to_approach = to_height - upwind @ rho
            matrix, left = np.zeros((n + 1, n + 1)), np.zeros(n + 1)
            left[k] = np.diff(flow)
            matrix[1 : n - 1, :n] = np.diff(jacobian, axis=0)
            matrix[1 : n - 1, n] = np.diff(to_approach)
            wanted = (pressure[k] + left[k] / np.abs(matrix[k, k]) < 0.0) & (self.x[k] > 0.0)
            # after some steps the edge of the empty part moves only once the rest has converged: no cycles
            if step < 10 or settled:
                changed, empty = bool(np.any(wanted != empty)), wanted
            rows = k[empty]
            for row in (0, *rows, n - 1):
                matrix[row] = 0.0
                matrix[row, row], left[row] = 1.0, pressure[row]
            matrix[n, :n], left[n] = self.weight, self.weight @ pressure - 0.5 * np.pi
            try:
                change = np.linalg.solve(matrix, -left)
            except np.linalg.LinAlgError:
                return None
            largest = float(np.max(np.abs(change[:n])))
            if not np.isfinite(largest):
                return None
            share = min(1.0, 0.1 / largest) if largest else 1.0
            lifted = self.kernel @ change[:n] + change[n]
            while share > 1e-3 and np.min((height + share * lifted)[core] / height[core]) < 0.3:
                share *= 0.6
            pressure, approach = pressure + share * change[:n], approach + share * float(change[n])
            settled = share == 1.0 and largest < 1e-4
            if share == 1.0 and largest < 1e-9 and not changed:
                return pressure, approach
        return None

    def found(self, pressure: Array, approach: float) -> LineContact:
        pressure = np.maximum(pressure, 0.0)
        height = (approach + self.gap + self.kernel @ pressure) * self.half**2
        # beyond the first node the gap is x^2/2 and the oil has no pressure to speak of: 6 U times the integral of 1/h
        beyond = 12.0 * self.speed / (-self.x[0] * self.half) * float(np.exp(-self.theta[0]))
        if self.meniscus is not None:
            beyond = 0.0
        slope = 0.5 * self.peak * float(np.sum((self.mean @ height) * np.diff(pressure)))
        moment = -0.5 * self.peak * self.half**2 * float(self.weight @ (self.x * pressure))
        centre = float(height[np.argmin(np.abs(self.x))])
        return LineContact(
            slope + beyond, moment + beyond, centre, float(height[np.abs(self.x) < 1.4].min()), self.x, pressure
        )


def _grid(nodes: int, inlet: float) -> Array:
    core = np.linspace(-CORE, CORE, nodes)
    first = core[1] - core[0]

    def outward(end: float) -> list[float]:
        found, step = [CORE], first
        while found[-1] < end:
            step *= GROWTH
            found.append(found[-1] + step)
        return found[1:]

    return np.concatenate([-np.array(outward(inlet))[::-1], core, outward(OUTLET)])


def _kernel(x: Array) -> Array:
    """Displacement of the surface at each node, for a pressure of 1 at a node that falls linearly to its neighbours."""

    def first(a: Array) -> Array:  # integral of log|a|
        return a * np.log(np.abs(np.where(a == 0.0, 1.0, a))) - a

    def second(a: Array) -> Array:  # integral of a log|a|
        return 0.5 * a * a * np.log(np.abs(np.where(a == 0.0, 1.0, a))) - 0.25 * a * a

    out = np.zeros((len(x), len(x)))
    for j, length in enumerate(np.diff(x)):
        a, b = x[j] - x, x[j + 1] - x
        zeroth, one = first(b) - first(a), second(b) - second(a)
        out[:, j] += (b * zeroth - one) / length
        out[:, j + 1] += (one - a * zeroth) / length
    return -out / np.pi
