"""The integrator with steps of its own for each roller: beside CVODE, what it counts, what it refuses."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shared import Cut, cut_after, lost

import trbdyn as trb
from trbdyn import Effects, InputError, Simulation
from trbdyn.model.cases import paper_30310, scene_30310

PAPER = Effects.paper().replace(quadrature="gauss", n_slices=8)
SCENES: dict[str, Any] = {
    "colliding": lambda: scene_30310(3000.0, 4930.0, effects=PAPER, start=trb.Start.whirl(0.9)),
    "combined": lambda: paper_30310(2000.0, 4930.0, effects=PAPER, start=trb.Start.whirl(0.9), radial_load=5530.0),
    "light": lambda: scene_30310(3000.0, 1230.0, effects=PAPER, start=trb.Start.whirl(0.9)),
    "slow": lambda: scene_30310(100.0, 4930.0, effects=PAPER, start=trb.Start.whirl(0.9)),
    "as given": lambda: scene_30310(2000.0, 4930.0, 5530.0),
    "follows": lambda: scene_30310(2000.0, 4930.0, 5530.0, ring="follows"),
}


@pytest.mark.parametrize("name", SCENES)
def test_it_agrees_with_cvode(name: str) -> None:
    """Losses, loads and the energy audit, of which the start makes the largest part here; single hits are chaotic."""
    scene = SCENES[name]()
    duration = (0.05 if name == "slow" else 0.6) * 60.0 / float(scene.speed_rpm)
    bdf, own = (Simulation(scene, integrator=kind).run(duration=duration) for kind in ("bdf", "multirate"))
    assert lost(own) == pytest.approx(lost(bdf), rel=2e-3)
    # the slow scene has dissipated little when its start, which leaves 5e-5 J, is over
    assert own.energy_closure < (2e-3 if name == "slow" else max(4.0 * bdf.energy_closure, 6e-4))
    # records, peaks and summary are those of any run
    np.testing.assert_allclose(own.outer_load.mean(), bdf.outer_load.mean(), rtol=1e-3)
    np.testing.assert_allclose(own.roller_orbit_angle[-1].mean(), bdf.roller_orbit_angle[-1].mean(), atol=1e-4)
    if name != "slow":
        outer, wanted = (float(np.max(result.peaks["outer_load_peak"])) for result in (own, bdf))
        assert outer == pytest.approx(wanted, rel=0.1)
    assert "energy" in str(own.summary()).lower()
    bodies = scene.bearing.n_rollers + 1
    assert bdf.stats["body_steps"] == bodies * bdf.stats["steps"]
    assert own.stats["body_steps"] < 0.9 * bodies * own.stats["steps"]


def free_ring() -> trb.Scene:
    return scene_30310(2000.0, 4930.0).replace(
        ring="free", ring_body=trb.RingBody(mass=1.0, inertia_axial=1e-3, inertia_transverse=1e-3)
    )


def test_the_default_takes_what_can_run_the_scene_and_names_it() -> None:
    held = Simulation(scene_30310(2000.0, 4930.0))
    assert held.integrator == held.options.integrator == "multirate"
    result = held.run(duration=2e-5)
    assert (
        result.meta["settings"]["integrator"] == result.stats["integrator"] == result.meta["integrator"] == "multirate"
    )
    chosen = Simulation(scene_30310(2000.0, 4930.0), integrator="bdf")
    assert chosen.integrator == chosen.options.integrator == "bdf"
    for other, why in (
        (Simulation(free_ring()), "a ring moves freely"),
        (Simulation(held.scene, max_order=5), "max_order"),
    ):
        assert other.options.integrator == "bdf"
        assert other.integrator.startswith(f"bdf, as {why}")
        assert other.run(duration=2e-5).meta["integrator"] == other.integrator
    assert trb.RunOptions().integrator == "auto"


def test_a_run_goes_on_with_the_integrator_that_it_has(tmp_path: Path) -> None:
    """Also where the default is another one: files name the integrator that was used."""
    scene, at = scene_30310(2000.0, 4930.0), {"duration": 5e-3, "save_every": 2e-5}
    for kind in ("bdf", "multirate"):
        path = tmp_path / f"{kind}.h5"
        whole = Simulation(scene, integrator=kind, checkpoint_every=0.9e-3).run(**at, output=path)
        left = tmp_path / f"{kind}_left.h5"
        with pytest.raises(Cut):
            Simulation(scene, integrator=kind, checkpoint_every=0.9e-3).run(**at, output=left, callback=cut_after(3e-3))
        found = trb.resume(left)
        assert found.stats["integrator"] == kind
        np.testing.assert_array_equal(found.cage_position, whole.cage_position)


def test_what_it_cannot_do_is_refused() -> None:
    scene = scene_30310(2000.0, 4930.0)
    for settings, says in (({"max_order": 5}, "max_order is not 2"),):
        with pytest.raises(InputError, match=f"integrator = 'multirate' : {says}; choose integrator = 'bdf'"):
            Simulation(scene, integrator="multirate", **settings)
    with pytest.raises(InputError, match="integrator = 'multirate' : a ring moves freely; choose integrator = 'bdf'"):
        Simulation(free_ring(), integrator="multirate")
