"""An effect that is off leaves nothing in the file, the summary and the report of a run: every row of the list of effects."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import h5py
import numpy as np
import pytest
from effect_cost.catalogue import EFFECTS, EVERYTHING, NOTHING, Effect

import trbdyn as trb
from trbdyn.reporting.tables import numbers as report_numbers
from trbdyn.results import fields, peaks
from trbdyn.results.numbers import of_table, rows
from trbdyn.run.keeping import absent, there

BASE = trb.cases.scene_30310(3000.0, 4930.0).replace(effects=EVERYTHING)
TOGETHER = (
    Effect(
        "sliding friction", "boundary friction and that of films", {"lubrication": "full_film", "traction": "none"}, {}
    ),
    Effect("films", "films of all contacts", {"lubrication": "dry"}, {}),
    Effect("pockets", "bars and ends of pockets", {"pocket_bars": False, "pocket_ends": False}, {}),
)
"""What several switches have in common."""

STAYS = {
    # the frame in which rollers are counted has the cage's name
    "cage": ("cage_",),
    # a cage is there, and may be pushed by other things
    "pockets": ("cage_force", "cage_moment"),
    # planar motion freezes coordinates that are there
    "space": ("cage_tilt", "roller_skew", "roller_tilt", "skew_peak", "skew_rms", "tilt_rms", "lean_mean"),
    # a ring that is held has its place, too
    "free ring": ("ring_", "work_ring"),
    "housing": ("ring_", "work_ring"),
    # boundary friction, which acts where films are thin
    "film traction": tuple(f"{of}_traction" for of in ("power", "loss", "power_split", "torque_by_loss")),
    # ends of pockets and the front rib, which are not touched in this run without the other
    "pocket bars": ("pocket_",),
    "back rib": ("front_rib_", "torque_split_front_rib"),
}
"""Beginnings of names that other effects make, too, or that are no effect's."""


def nothing(value: Any) -> bool:
    """Whether a dataset or an entry tells that there was none: zero throughout, or without a value."""
    numbers = np.asarray(value)
    return numbers.dtype.kind in "fiu" and not np.nan_to_num(numbers).any()


def run(kit: SimpleNamespace, scene: trb.Scene, **options: Any) -> trb.Result:
    """A short run in which everything touches."""
    sim = trb.Simulation(scene.replace({"effects.n_slices": 4}), accuracy="fast")
    sim.set_state(kit.perturbed(sim, 1, back=2.5e-4))
    with warnings.catch_warnings(action="ignore"):
        return sim.run(duration=2e-5, save_every=1e-5, **options)


def told(result: trb.Result) -> dict[str, Any]:
    """What the fields of a file, the summary and the report tell: value by place and name."""
    values = result.summary()
    found: dict[str, Any] = {f"file/{field.name}": result[field.name] for field in result.fields}
    found |= {f"summary/{name}": value for name, value in of_table(values).items()}
    lines = re.findall(r"<td class='q'>([^<]*)</td><td[^>]*>([^<]*)</td>", report_numbers([values], ["run"], [{}]))
    assert lines
    names = {row.words.strip(): row.name for row in rows()}
    return found | {f"report/{names.get(words, words)}": 0.0 if number == "0" else number for words, number in lines}


@pytest.fixture(scope="module")
def usual(kit: SimpleNamespace) -> dict[str, Any]:
    """The scene of all rows that are not added to it."""
    return told(run(kit, BASE))


@pytest.mark.parametrize("effects", [EVERYTHING, NOTHING], ids=["everything", "nothing"])
def test_a_file_holds_the_fields_of_its_result_and_no_others(
    kit: SimpleNamespace, effects: trb.Effects, tmp_path: Path
) -> None:
    result = run(kit, BASE.replace(effects=effects), output=tmp_path / "run.h5")
    held: list[str] = []
    with h5py.File(tmp_path / "run.h5") as file:
        file.visititems(lambda name, one: held.append(name) if isinstance(one, h5py.Dataset) else None)
    known = {field.name for field in (*fields.table(), *peaks.table())}
    held = [name for name in (path.rpartition("/")[2] for path in held) if name in known]
    assert sorted(held) == sorted(field.name for field in result.fields)


@pytest.mark.parametrize("effect", [*EFFECTS, *TOGETHER], ids=lambda effect: effect.name)
def test_what_is_off_is_in_no_file_summary_and_report(kit: SimpleNamespace, usual: dict[str, Any], effect: Any) -> None:
    """What tells zero without an effect, and more with it, is not there where the effect is off."""
    other = effect.switched_on(BASE) if effect.is_added else effect.switched_off(BASE)
    here = told(run(kit, other))
    off, on = (usual, here) if effect.is_added else (here, usual)
    left = [name for name, value in off.items() if name in on and nothing(value) and not nothing(on[name])]
    left = [name for name in left if not name.endswith("_time")]
    left = [name for name in left if not name.rpartition("/")[2].startswith(STAYS.get(effect.name, ()))]
    assert left == []


SWITCHES: dict[str, tuple[Any, ...]] = {
    "gravity": (True, False),
    "bodies": ("rollers_and_cage", "rollers_and_cage", "rollers_and_spacer", "rollers"),
    "lubrication": ("mixed", "full_film", "full_film", "boundary", "dry"),
    "traction": ("muraki_kimura", "coulomb", "none", "none"),
    "rolling_resistance": (True, False),
    "hysteresis": (0.0, 0.01),
    "flooded_gaps": (True, False),
    "back_rib": (True, False),
    "front_rib": (True, False),
    "pocket_bars": (True, False),
    "pocket_ends": (True, False),
    "pocket_film": (0.0, 5e-5),
    "guidance": ("rollers", "inner_land", "outer_land"),
    "oil_fill": (0.0, 0.1),
    "damping": ("off", "hunt_crossley", "film"),
    "planar": (False, False, True),
}
ROUND_OFF = 1e-12
"""In N, N m and W: normal forces have a moment of 1e-17 N m about the axis that they pass through."""


@pytest.mark.parametrize("name", ["30310", "LM67048", "NJ308"])
def test_nothing_that_acts_is_left_out(kit: SimpleNamespace, name: str) -> None:
    """Each field that a scene's switches leave out is zero, whatever they are together."""
    random = np.random.default_rng(7)
    bearing = BASE.bearing if name == "30310" else trb.Bearing.named(name)
    loads = {"axial_load": 10.0, "radial_load": 4000.0} if bearing.is_cylindrical else {"radial_load": 2000.0}
    left_out, counted = [], 0
    for number in range(40):
        chosen: dict[str, Any] = {key: values[random.integers(len(values))] for key, values in SWITCHES.items()}
        if chosen["bodies"] != "rollers_and_cage":
            chosen["guidance"] = "rollers"
        if bearing.is_cylindrical:
            chosen |= {"back_rib": True, "front_rib": True}
        chosen["rolling_pressure_force"] = chosen["rolling_resistance"]
        scene = BASE.replace(bearing=bearing, effects=EVERYTHING.replace(**chosen, n_slices=4), **loads)
        try:
            with warnings.catch_warnings(action="ignore"):
                sim = trb.Simulation(scene)
                vector = kit.perturbed(sim, number, back=2.5e-4)
        except trb.InputError:
            continue  # switches that exclude each other
        counted += 1
        kept = {field.name for field in there(fields.table(), absent(scene, moves=False))}
        values = sim.record(vector)
        left_out += [
            (key, chosen)
            for key, value in values.items()
            if key not in kept and np.abs(np.nan_to_num(np.asarray(value, float))).max() > ROUND_OFF
        ]
    assert left_out == []
    assert counted > 10
