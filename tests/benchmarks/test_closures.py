"""The grid of closures: what counts as energy turned over and as a finding, and that the command runs. No timings."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from shared import benchmark

import trbdyn as trb

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
pytestmark = pytest.mark.skipif(not BENCHMARKS.is_dir(), reason="the benchmarks are not part of a source distribution")


def test_grid_covers_what_is_promised() -> None:
    from closure import grid

    points = list(grid.points())
    assert {point.speed_rpm for point in points} >= {0.01, 1.0, 10.0, 100.0, 1000.0, 3000.0, 10_000.0, 30_000.0}
    assert {point.axial_load for point in points if not point.radial_share} == {500.0, 1230.0, 4930.0, 20_000.0}
    assert {(point.radial_share, point.direction_deg) for point in points if point.radial_share} == {
        (0.5, 90.0),
        (0.5, -30.0),
        (1.5, 90.0),
        (1.5, -30.0),
    }
    assert {point.preset for point in points} == {"fast", "standard", "reference"}
    assert {point.effects for point in points} == {"paper", "standard"}


def test_radial_loads_unload_a_roller() -> None:
    from closure import grid

    load = grid.unloading(4930.0)
    for share, loaded in ((0.5, True), (1.5, False)):
        sim = trb.Simulation(trb.cases.paper_30310(100.0, 4930.0, share * load))
        assert (sim.equilibrium.inner_load.min() > 0.0) == loaded


def test_closure_is_that_of_the_watch() -> None:
    from closure import grid

    sim = trb.Simulation(trb.cases.paper_30310(start=trb.Start.whirl(0.9)))
    result = sim.run(duration=2e-3, save_every=2e-5, save_groups=("time", "energy"))
    found = grid.audit(result)
    assert found["closure_dissipated"] == pytest.approx(result.energy_closure)
    names = [field.name for field in result.fields if field.group == "energy"]
    turned = 0.5 * sum(np.abs(np.diff(result[name])).sum() for name in names)
    assert found["turned_over_j"] == pytest.approx(turned)
    assert found["closure"] == pytest.approx(abs(result.energy_audit.residual) / turned)
    assert found["turned_over_j"] >= 0.99 * found["dissipated_j"]


def test_finds_a_run_that_is_wrong() -> None:
    from closure import grid

    point = grid.Point(3000.0, 4930.0, 0.0, 90.0, "paper", "standard", "whirl")
    row = grid.measure(point, 100, 1.0)
    assert row["status"] == "done"
    assert row["steps"] == 100
    assert grid.is_bad(row) is None
    assert "without a warning" in str(grid.is_bad(row | {"closure": 0.02}))
    assert "without a warning" in str(grid.is_bad(row | {"closure": math.nan}))
    assert grid.is_bad(row | {"closure": 0.02, "warnings": ["energy"]}) is None
    assert "mean step" in str(grid.is_bad(row | {"mean_step_s": 1e-9}))
    assert "ended" in str(grid.is_bad(row | {"status": "ended"}))


@pytest.mark.parametrize("effects", ["paper", "standard"])
@pytest.mark.parametrize(("preset", "speed"), [("standard", 3000.0), ("standard", 10_000.0), ("reference", 1.0)])
@pytest.mark.parametrize(("axial_load", "share"), [(1230.0, 0.0), (4930.0, 1.5)])
def test_presets_keep_what_is_promised(
    preset: str, speed: float, axial_load: float, share: float, effects: str
) -> None:
    """A few points of the grid; `closures.py` measures all of it."""
    from closure import grid

    row = grid.measure(grid.Point(speed, axial_load, share, 90.0, effects, preset, "whirl"), 1500, 2.0)
    assert row["status"] == "refused" or row["closure"] < 1e-3 or row["warnings"]


def test_loads_without_equilibrium_are_refused() -> None:
    from closure import grid

    row = grid.measure(grid.Point(30_000.0, 500.0, 0.0, 90.0, "paper", "standard", "equal"), 100, 1.0)
    assert row["status"] == "refused"
    assert "axial_load" in row["message"]
    assert grid.is_bad(row) is None


def test_command(tmp_path: Path) -> None:
    found, said = benchmark("closures", tmp_path, "--smoke")
    assert found["summary"]["bad"] == []
    assert found["results"][0]["closure"] < 1e-3
    assert "below 0.001 from" in said


def test_page_is_made_from_a_file(tmp_path: Path) -> None:
    import closures

    first = closures.main(["--smoke", "--jobs", "1", "--no-picture", "--json", str(tmp_path / "a.json")])
    path = tmp_path / "b.json"
    again = closures.main(["--no-picture", "--from-json", str(tmp_path / "a.json"), "--json", str(path)])
    assert again.results == json.loads((tmp_path / "a.json").read_text(encoding="utf-8"))["results"]
    assert again.readme == first.readme
    written = json.loads(path.read_text(encoding="utf-8"))
    assert written["date"] == json.loads((tmp_path / "a.json").read_text(encoding="utf-8"))["date"]
    (tmp_path / "other.json").write_text(json.dumps(written | {"benchmark": "scaling"}), encoding="utf-8")
    with pytest.raises(ValueError, match="not a file of closures"):
        closures.main(["--from-json", str(tmp_path / "other.json")])
