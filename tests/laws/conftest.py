"""The 30310 rig and its oil, for the laws."""

from __future__ import annotations

import pytest

from trbdyn import cases
from trbdyn.model.geometry import Geometry


@pytest.fixture(scope="session")
def geometry() -> Geometry:
    """Derived geometry of the 30310 rig."""
    return cases.rig_30310().geometry
