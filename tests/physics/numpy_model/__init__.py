"""The equations of motion and the forces of the paper's effects, written once more in NumPy: what the core is compared with.

Arrays run over (vector component, race, roller, state, node). Constant speed and load; see `Constants.check`.
"""

from .model import NumpyModel

__all__ = ["NumpyModel"]
