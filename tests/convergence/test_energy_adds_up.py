"""The energy of a run adds up below a thousandth of what is turned over with each preset, or the run warns."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.results.observables import energy

UNLOADS = 17_200.0
"""Radial load under which some rollers of a 30310 with an axial load of 4930 N carry nothing on the inner ring (N)."""
MOST_STEPS = 1500
MOST_TURNS = 2.0


def turned_over(result: trb.Result) -> float:
    """Half of all changes of works, losses and stored energies, added up without signs (J)."""
    names = [field.name for field in result.fields]
    terms = [name for name in names if name.startswith(("work_", "loss_")) or name in energy.STORED]
    return 0.5 * float(sum(np.abs(np.diff(result[name])).sum() for name in terms))


@pytest.mark.usefixtures("probes")
@pytest.mark.parametrize("effects", ["paper", "standard"])
@pytest.mark.parametrize(("preset", "speed"), [("standard", 3000.0), ("standard", 10_000.0), ("reference", 1.0)])
@pytest.mark.parametrize(("axial", "radial"), [(1230.0, 0.0), (4930.0, UNLOADS)])
def test_presets_keep_what_is_promised(preset: str, speed: float, axial: float, radial: float, effects: str) -> None:
    """Some of 768 points that were measured once (docs/promises.md)."""
    own = getattr(trb.Effects, effects)().replace(quadrature="gauss", n_slices=8)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        scene = trb.cases.paper_30310(speed, axial, radial, effects=own, start=trb.Start.whirl(0.9))
        sim = trb.Simulation(scene, accuracy=preset)
        assert (sim.equilibrium.inner_load.min() > 0.0) == (radial == 0.0)
        length, end = 60.0 * MOST_TURNS / speed, sim.copy()
        for _ in range(MOST_STEPS):
            if end.time > length:
                break
            end.step()
        length = min(end.time, length)
        result = sim.run(duration=length, save_every=length / 100, save_groups=("time", "energy"))
    closure = abs(result.energy_audit.residual) / turned_over(result)
    assert result.energy_audit.dissipated > 0.0
    assert closure < 1e-3 or result.warnings
