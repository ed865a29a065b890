"""Stresses below a surface under rectangles of constant pressure.

Love (1929), Phil. Trans. R. Soc. A 228, 377-420: with V and chi the integrals of p/r and of p ln(z + r) over the loaded
rectangle, compression negative,

    2 pi s_x = 2 nu V_z - z V_xx - (1 - 2 nu) chi_xx,    2 pi s_z = V_z - z V_zz,
    2 pi t_xy = -(1 - 2 nu) chi_xy - z V_xy,             2 pi t_xz = -z V_xz,

and the same with x and y exchanged. Each derivative is a sum over the corners of a function of r = (X^2 + Y^2 + z^2)^(1/2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]

DEPTHS: Final = np.array([0.05, 0.15, 0.3, 0.4, 0.5, 0.6, 0.7, 0.786, 0.9, 1.05, 1.3, 1.7])
"""Depths over the half width of the contact; that of the largest shear stress of a line is 0.786, Johnson, 4.2."""


@dataclass(frozen=True)
class Shear:
    """Largest shear stresses below each place along a contact line.

    Attributes
    ----------
    largest, orthogonal : ndarray, shape (m,)
        Half of the difference of the principal stresses, and the shear stress in planes along the surface across the contact
        line, which changes its sign when the contact passes (Pa).
    largest_depth, orthogonal_depth : ndarray, shape (m,)
        Depths at which they act (m).
    """

    largest: Array
    largest_depth: Array
    orthogonal: Array
    orthogonal_depth: Array


def _corners(function: Array) -> Array:
    """Sum over the corners of rectangles, of a function of places at which corners are."""
    return np.asarray(function[1:, 1:] - function[:-1, 1:] - function[1:, :-1] + function[:-1, :-1])


def rectangle(x: Array, y: Array, depth: float, poisson_ratio: float) -> Array:
    """Stresses of a pressure of 1 over rectangles, shape (6, n - 1, m - 1): xx, yy, zz, xy, yz, xz.

    Parameters
    ----------
    x, y : ndarray, shape (n,) and (m,)
        The point's places from the edges of rectangles that touch each other, falling or rising by the size of one (m), not 0.
    depth : float
        Depth of the point (m), above 0.
    poisson_ratio : float
        Poisson's ratio (1).
    """
    long, wide, z, nu = np.abs(y)[None, :], np.abs(x)[:, None], depth, poisson_ratio
    signs, across, along = np.sign(x)[:, None] * np.sign(y)[None, :], np.sign(x)[:, None], np.sign(y)[None, :]
    r = np.sqrt(wide**2 + long**2 + z * z)
    # each is an integral from 0, odd in what it was integrated over, so that only places above 0 are needed
    solid = signs * np.arctan(wide * long / (z * r))
    xx = signs * (-wide * long / (r * (wide**2 + z * z)))
    yy = signs * (-wide * long / (r * (long**2 + z * z)))
    chi_xx = signs * (np.arctan(long / wide) - np.arctan(z * long / (wide * r)))
    chi_yy = signs * (np.arctan(wide / long) - np.arctan(z * wide / (long * r)))
    v_z, v_xx, v_yy = -_corners(solid), _corners(xx), _corners(yy)
    v_xy, v_xz = _corners(1.0 / r), _corners(-along * z * long / (r * (wide**2 + z * z)))
    v_yz = _corners(-across * z * wide / (r * (long**2 + z * z)))
    c_xx, c_yy, c_xy = _corners(chi_xx), _corners(chi_yy), _corners(np.log(z + r))
    free = 1.0 - 2.0 * nu
    return np.array(
        [
            2.0 * nu * v_z - z * v_xx - free * c_xx,
            2.0 * nu * v_z - z * v_yy - free * c_yy,
            v_z + z * (v_xx + v_yy),
            -free * c_xy - z * v_xy,
            -z * v_yz,
            -z * v_xz,
        ]
    ) / (2.0 * math.pi)


def stresses(pressure: Array, cell: tuple[float, float], depth: float, poisson_ratio: float) -> Array:
    """Stresses at a depth below the middles of the cells, shape (6, m, n).

    Parameters
    ----------
    pressure : ndarray, shape (m, n)
        Pressure (Pa), along and across.
    cell : tuple of float
        Width and length of a cell (m).
    depth : float
        Depth (m), above 0.
    poisson_ratio : float
        Poisson's ratio (1).
    """
    m, n = pressure.shape
    size = scipy.fft.next_fast_len(2 * m), scipy.fft.next_fast_len(2 * n, real=True)
    x, y = cell[0] * (np.arange(-n, n) + 0.5), cell[1] * (np.arange(-m, m) + 0.5)
    kernels = np.zeros((6, *size))
    across, along = np.arange(1 - n, n), np.arange(1 - m, m)
    kernels[:, along[:, None], across[None, :]] = rectangle(x, y, depth, poisson_ratio).transpose(0, 2, 1)
    spectrum = scipy.fft.rfft2(kernels) * scipy.fft.rfft2(pressure, s=size)
    return np.asarray(scipy.fft.irfft2(spectrum, s=size)[:, :m, :n])


def largest_shear(pressure: Array, cell: tuple[float, float], half_width: float, poisson_ratio: float) -> Shear:
    """Largest shear stresses below a contact, at depths from a twentieth to 1.7 times a half width.

    Parameters
    ----------
    pressure : ndarray, shape (m, n)
        Pressure (Pa), along and across.
    cell : tuple of float
        Width and length of a cell (m).
    half_width : float
        Half width of the contact where it is widest (m).
    poisson_ratio : float
        Poisson's ratio of the body (1).
    """
    depths, found = half_width * DEPTHS, []
    for depth in depths:
        xx, yy, zz, xy, yz, xz = stresses(pressure, cell, float(depth), poisson_ratio)
        principal = np.linalg.eigvalsh(np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=-1).reshape(*xx.shape, 3, 3))
        found.append((0.5 * (principal[..., 2] - principal[..., 0]).max(axis=1), np.abs(xz).max(axis=1)))
    every = np.array(found)
    best = every.argmax(axis=0)
    values = every.max(axis=0)
    return Shear(values[0], depths[best[0]], values[1], depths[best[1]])
