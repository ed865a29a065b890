"""Frequencies of defects before any run, against the handbooks' formulas and against a run."""

from __future__ import annotations

import math

import pytest

import trbdyn as trb


@pytest.mark.parametrize("speeds", [(3000.0, 0.0), (0.0, 1200.0), (1500.0, -400.0), (-600.0, 0.0)])
@pytest.mark.parametrize("make", [trb.cases.bearing_nj210, trb.cases.rig_30310, trb.cases.bearing_32216])
def test_formulas_of_handbooks(make, speeds: tuple[float, float]) -> None:
    """Exact for cylinders; for cones the handbooks' ratio of diameters is that of the mid roller."""
    bearing, (shaft, outer) = make(), speeds
    found = trb.frequencies(bearing, speed_rpm=shaft, outer_speed_rpm=outer)
    rolling, angle = (shaft - outer) / 60.0, bearing.geometry.roller_axis_angle
    ratio = bearing.roller.diameter * math.cos(angle) / bearing.pitch_diameter
    close = 1e-12 if bearing.is_cylindrical else 3e-3
    assert found.bpfo == pytest.approx(0.5 * bearing.n_rollers * abs(rolling) * (1.0 - ratio), rel=close)
    assert found.bpfi == pytest.approx(0.5 * bearing.n_rollers * abs(rolling) * (1.0 + ratio), rel=close)
    spin = bearing.pitch_diameter / (2.0 * bearing.roller.diameter) * abs(rolling) * (1.0 - ratio**2)
    assert found.bsf == pytest.approx(spin, rel=close)
    assert found.ftf == pytest.approx(0.5 * (1.0 - ratio) * rolling + outer / 60.0, rel=3 * close)
    assert found.bpfo + found.bpfi == pytest.approx(bearing.n_rollers * abs(rolling), rel=1e-12)


def test_orders_count_in_the_ring_that_turns() -> None:
    bearing = trb.cases.rig_30310()
    inner = trb.frequencies(bearing, speed_rpm=3000.0)
    outer = trb.frequencies(bearing, speed_rpm=0.0, outer_speed_rpm=3000.0)
    assert inner.orders["bpfo"] == pytest.approx(inner.bpfo / 50.0)
    assert outer.orders["ftf"] == pytest.approx(1.0 - inner.orders["ftf"])
    assert "BPFO" in repr(inner)


def test_rings_that_turn_alike_are_refused() -> None:
    with pytest.raises(trb.InputError, match="speed_rpm"):
        trb.frequencies(trb.cases.rig_30310(), speed_rpm=100.0, outer_speed_rpm=100.0)
