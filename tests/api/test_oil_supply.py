"""States of lubrication: shares by name, bands, the fill of a bath, the share of drag in the summary."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.extras.study.uncertainty import open_inputs
from trbdyn.model.lubricants import OIL_SUPPLIES, supply_of


@pytest.mark.parametrize("name", OIL_SUPPLIES)
def test_names_are_shares_with_bands(name: str) -> None:
    supply = OIL_SUPPLIES[name]
    effects = trb.Effects(oil_fill=name)  # type: ignore[arg-type]
    assert effects.oil_fill == supply.fill
    assert effects == trb.Effects.standard().replace(oil_fill=name)
    assert supply.low <= supply.fill <= supply.high
    assert supply_of(supply.fill) is supply
    scene = trb.cases.scene_30310(effects=effects)
    assert trb.Scene.from_dict(scene.to_dict()) == scene
    band = next(band for band in open_inputs(scene) if band.path == "effects.oil_fill")
    assert (band.low, band.high) == (supply.low, supply.high)


def test_other_shares_have_a_band_from_nothing() -> None:
    scene = trb.cases.scene_30310(effects=trb.Effects(oil_fill=0.2))
    band = next(band for band in open_inputs(scene) if band.path == "effects.oil_fill")
    assert (band.low, band.high) == (0.0, 0.4)


def test_unknown_names() -> None:
    with pytest.raises(trb.InputError, match=r"oil_fill = 'bathe' : .*did you mean 'bath'"):
        trb.Effects(oil_fill="bathe")  # type: ignore[arg-type]


def test_fill_of_a_bath() -> None:
    """Against a count of points; halves; monotone."""
    bearing = trb.cases.rig_30310()
    outer, inner = bearing.geometry.outer_race_radius, bearing.geometry.inner_race_radius
    grid = np.linspace(-outer, outer, 2001)
    x, y = np.meshgrid(grid, grid)
    ring = (np.hypot(x, y) < outer) & (np.hypot(x, y) > inner)
    for level in (0.3e-2, 2e-2, 7e-2):
        expected = (ring & (y < level - outer)).sum() / ring.sum()
        assert trb.lubricants.bath_fill(bearing, level) == pytest.approx(expected, abs=2e-3)
    assert trb.lubricants.bath_fill(bearing, outer) == pytest.approx(0.5)
    assert trb.lubricants.bath_fill(bearing, 0.0) == 0.0
    assert trb.lubricants.bath_fill(bearing, 2 * outer) == pytest.approx(1.0)
    with pytest.raises(trb.InputError, match=r"level = .*from 0 to the raceway's diameter"):
        trb.lubricants.bath_fill(bearing, 1.0)


@pytest.mark.parametrize(
    ("measured_on", "said"),
    [
        ("ring", "60 C of the ring, films from -3 to +10 K"),
        ("film", "60 C of the films, films from -3 to +3 K"),
        ("supply", "60 C of the oil that is supplied, films from +0 to +25 K"),
    ],
)
def test_the_summary_tells_what_the_temperature_was_measured_on(measured_on: str, said: str) -> None:
    """The band is that of an uncertainty; an oil that is known at one temperature alone has none."""
    oil = trb.lubricants.vg100(60.0).replace(temperature_of=measured_on)
    scene = trb.cases.scene_30310(3000.0, lubricant=oil)
    summary = trb.Simulation(scene).run(duration=2e-4).summary()
    assert summary["oil_temperature_note"] == said
    assert said in str(summary)
    band = next(band for band in open_inputs(scene) if band.path == "lubricant.temperature_c")
    assert f"from {band.low - 60.0:+g} to {band.high - 60.0:+g} K" in said
    fixed = oil.replace(oil=None)
    assert "oil_temperature_note" not in trb.Simulation(scene.replace(lubricant=fixed)).run(duration=2e-4).summary()


def test_the_summary_tells_the_share_of_drag() -> None:
    def summed(fill: float | str) -> dict[str, Any]:
        scene = trb.cases.scene_30310(6000.0, effects=trb.Effects(oil_fill=fill))  # type: ignore[arg-type]
        return trb.Simulation(scene, accuracy="fast").run(revolutions=1.0).summary()

    dry, bath, flooded = summed(0.0), summed("bath"), summed("flooded")
    assert "drag_share" not in dry
    assert bath["drag_share"] == pytest.approx(
        bath["torque_by_loss"]["drag"] / sum(bath["torque_by_loss"].values()), rel=0.01
    )
    assert 0.0 < bath["drag_share"] < flooded["drag_share"] < 1.0
    assert "share of the oil's drag in the torque" in str(bath)
