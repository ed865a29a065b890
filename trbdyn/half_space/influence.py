"""Displacement of the surface of a half space under rectangles of constant pressure, and of a body with free ends.

Love (1929), as in Johnson, Contact Mechanics, 3.25: a pressure of 1 over a rectangle with corners (X_i, Y_j) from the point
presses the surface down by (1 - nu^2)/(pi E) times the sum over the corners, with alternating signs, of

    F(X, Y) = X asinh(Y/|X|) + Y asinh(X/|Y|).

A body that ends at a plane has no stresses there. The pressure mirrored at the plane takes the shear stress away (de Mul, Kalker
and Fredriksson 1986); multiplied by a factor above 1 it stands for the normal stress, too (Guilbault 2011, `guilbault_factor`).
"""

from __future__ import annotations

import math

import numpy as np
import scipy
from numpy.typing import NDArray

Array = NDArray[np.float64]


def guilbault_factor(poisson_ratio: float) -> float:
    """Factor of the mirrored pressure (1): 1.29 - (0.08 - 0.5 nu)/(1 - nu), Guilbault (2011), J. Tribology 133, 031402.

    Parameters
    ----------
    poisson_ratio : float
        Poisson's ratio of the body that ends (1).
    """
    return 1.29 - (0.08 - 0.5 * poisson_ratio) / (1.0 - poisson_ratio)


def _corner(x: NDArray[np.floating], y: NDArray[np.floating]) -> Array:
    """F(X, Y), shape (n, m), of places along both axes; 0 where one of them is 0."""
    wide, long = np.abs(x)[:, None], np.abs(y)[None, :]
    with np.errstate(divide="ignore", invalid="ignore"):
        found = wide * np.arcsinh(long / wide) + long * np.arcsinh(wide / long)
    return np.where((wide > 0.0) & (long > 0.0), found, 0.0) * np.sign(x)[:, None] * np.sign(y)[None, :]


class Influence:
    """Displacements from pressures on a grid of rectangles, by fast Fourier transforms without repetition of the grid.

    Parameters
    ----------
    shape : tuple of int
        Cells across the contact (x) and along it (y).
    cell : tuple of float
        Width and length of a cell (m).
    compliance : float
        Sum of (1 - nu^2)/E of both bodies (1/Pa).
    mirrored : float
        Factor of the mirrored pressure times (1 - nu^2)/E of the body that ends (1/Pa); 0 without free ends.
    beyond : float
        Distance from the ends of the grid to the planes at which this body ends (m).

    Attributes
    ----------
    row_stiffness : ndarray, shape (n, n)
        Pressures (Pa) that displace the cells across by 1 m if only their own row had any.
    """

    def __init__(
        self,
        shape: tuple[int, int],
        cell: tuple[float, float],
        *,
        compliance: float,
        mirrored: float = 0.0,
        beyond: float = 0.0,
    ) -> None:
        n, m = shape
        self.shape, self.cell = shape, cell
        # y is the first axis: the transform of real numbers, which takes half, goes along x
        self._size = scipy.fft.next_fast_len(2 * m), scipy.fft.next_fast_len(2 * n, real=True)
        kernel = self._kernel(np.arange(m + 1.0) - 0.5, compliance)
        self._direct = self._spread(self._placed(np.arange(m), kernel))
        self.row_stiffness = np.linalg.inv(kernel[:, 0][np.abs(np.subtract.outer(np.arange(n), np.arange(n)))])
        self._mirror: NDArray[np.complex128] | None = None
        if mirrored > 0.0:
            # of cells i and j, the image at one end is (j - k) - m away and that at the other (j - k) + m, with k = m - 1 - i
            shift = 2.0 * beyond / cell[1]
            images = self._kernel(np.arange(2.0 * m) + 0.5 + shift, mirrored)
            images += images[:, ::-1]
            placed = np.zeros((self._size[0], n))
            placed[np.arange(1 - m, m)] = images.T
            turned = np.exp(-2j * np.pi * np.arange(self._size[0]) * (m - 1) / self._size[0])
            self._mirror = self._spread(placed) * turned[:, None]
            self._back = -np.arange(self._size[0])

    def _kernel(self, edges: NDArray[np.floating], compliance: float) -> Array:
        """Displacement at 0 to n - 1 cells across and between edges along, in cells and one apart, shape (n, len(edges) - 1)."""
        wide, long = self.cell
        x = wide * (np.arange(self.shape[0] + 1) - 0.5)
        corners: Array = _corner(x, long * edges)
        both = corners[1:] - corners[:-1]
        return compliance / math.pi * np.asarray(both[:, 1:] - both[:, :-1])

    def _placed(self, distances: NDArray[np.int64], kernel: Array) -> Array:
        placed = np.zeros((self._size[0], self.shape[0]))
        placed[distances] = kernel.T
        placed[-distances] = kernel.T
        return placed

    def _spread(self, half: Array) -> NDArray[np.complex128]:
        """The transform of a kernel that is even across, from the half with distances from 0 on."""
        n = self.shape[0]
        whole = np.zeros(self._size)
        whole[:, :n] = half
        whole[:, -np.arange(1, n)] = half[:, 1:]
        return np.asarray(scipy.fft.fft(scipy.fft.rfft(whole, axis=1), axis=0))

    def __call__(self, pressure: Array) -> Array:
        """Displacement of both surfaces towards their bodies together (m), of pressures (Pa), shape (along, across) both."""
        m, n = pressure.shape
        long, wide = self._size
        spectrum = scipy.fft.fft(scipy.fft.rfft(pressure, wide, axis=1), long, axis=0)
        total = self._direct * spectrum
        if self._mirror is not None:
            total += self._mirror * spectrum[self._back]
        # rows of the padding are left out before the second transform
        return np.asarray(scipy.fft.irfft(scipy.fft.ifft(total, axis=0)[:m], wide, axis=1)[:, :n])
