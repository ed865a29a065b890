"""Parts of the core's state vector by name."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class StateView:
    """Parts of a state vector by name, as views: ``view["roller_r"]`` has shape (Z,), ``view["cage_x"]`` shape ().

    The layout has name, first entry and shape of each part: `_core.Model.state_layout`, or one of `_core.state_layouts`.
    """

    def __init__(self, layout: Sequence[tuple[str, int, tuple[int, ...]]], vector: Array) -> None:
        self._vector = vector
        self._layout = {name: (offset, shape) for name, offset, shape in layout}

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parts."""
        return tuple(self._layout)

    def __getitem__(self, name: str) -> Array:
        offset, shape = self._layout[name]
        if len(shape) == 2:
            count, stride = shape
            return self._vector[offset : offset + count * stride : stride]
        return self._vector[offset : offset + (shape[0] if shape else 1)].reshape(shape)

    def __setitem__(self, name: str, value: Array | float) -> None:
        self[name][...] = value
