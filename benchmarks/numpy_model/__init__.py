"""The force model of trbdyn in vectorised NumPy: what a user would write in Python, as well as it can be written.

Arrays run over (vector component, race, roller, state, node); many states are evaluated in one call. One logarithm of
interference, sliding and mean speed is used for every power of them, one matrix product and one exponential give all powers.
Covers the effects of `Effects.paper()` and constant speed and load; see `Constants.check`.
"""

from .jacobian import Jacobian
from .model import NumpyModel

__all__ = ["Jacobian", "NumpyModel"]
