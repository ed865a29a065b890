"""Whether two builds compute the same bits: final states, records and peaks of short runs of many scenes.

Write a file with one build, then compare another build with it::

    python benchmarks/bit_identity.py --write before.json
    python benchmarks/bit_identity.py --against before.json

The program ends with 1 if a scene differs. Both files must come from the same kind of processor: compilers, mathematical
libraries and instruction sets round differently.
"""

from __future__ import annotations

import argparse
import hashlib
import importlib.util
import json
import sys
import warnings
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from common import HERE, machine, table

import trbdyn as trb
from trbdyn.model.cases import paper_30310, scene_32216

SCHEMA = "trbdyn-bits-2"
DURATION = 6e-3
"""Bearing time that each scene runs (s)."""
EVERY = 2e-4
"""Bearing time between records (s)."""
HARD = (
    "load_step_in_one_step",
    "rollers_leave_contact",
    "speed_reversal",
    "negative_pocket_play_damped",
    "skew_at_the_limit_damped",
    "missing_bar",
    "cage_1_g",
    "3_rollers",
    "60_rollers",
    "faces_meet_at_edges",
    "whirl_standard_damping",
    "drag_flooded",
    "land_thick_oil",
    "land_without_oil",
)
"""Scenes of tests/stability/hard_scenes.toml."""
TOLERANCES = {
    "position": ("atol_position", ("r", "x", "y", "z")),
    "angle": ("atol_angle", ("psi", "skew", "tilt")),
    "velocity": ("atol_velocity", ("v_r", "v_t", "v_x", "v_y", "v_z")),
    "spin": ("atol_spin", ("omega_n", "omega_t", "omega_a")),
}
"""Absolute tolerance and names of the coordinates of each kind."""

Make = Callable[[], trb.Scene]


def paper(**changes: Any) -> trb.Effects:
    """The effects of the paper with changes."""
    return trb.Effects.paper().replace(**changes)


def own_scenes() -> dict[str, tuple[Make, dict[str, Any]]]:
    """What `trb.cases` offers, with options of the run that take other ways through the core."""
    whirl = trb.Start.whirl(1.0)
    return {
        "paper_30310": (paper_30310, {}),
        "paper_30310 fast": (lambda: paper_30310(start=whirl), {"accuracy": "fast"}),
        "paper_30310 reference": (lambda: paper_30310(start=whirl), {"accuracy": "reference"}),
        "paper_30310 erk": (lambda: paper_30310(start=whirl), {"integrator": "erk"}),
        "paper_30310 combined load": (lambda: paper_30310(2000.0, 4930.0, 5530.0, start=whirl), {}),
        "paper_30310 planar": (lambda: paper_30310(effects=paper(planar=True)), {}),
        "paper_30310 no cage": (lambda: paper_30310(effects=paper(bodies="rollers")), {}),
        "paper_30310 whirl": (lambda: paper_30310(start=whirl), {}),
        "paper_30310 scalar": (lambda: paper_30310(start=whirl), {"instruction_set": "scalar"}),
        "paper_30310 base": (lambda: paper_30310(start=whirl), {"instruction_set": "base"}),
        "scene_32216": (scene_32216, {}),
    }


def hard_scenes() -> ModuleType:
    """The catalogue of hard scenes, which belongs to the tests."""
    path = HERE.parent / "tests" / "stability" / "hard_scenes.py"
    spec = importlib.util.spec_from_file_location("hard_scenes", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["hard_scenes"] = module
    spec.loader.exec_module(module)
    return module


def scenes() -> dict[str, tuple[Make, dict[str, Any]]]:
    """All scenes by name: what makes each, and options of its run."""
    catalogue = {hard.name: hard for hard in hard_scenes().HARD}
    hard = {name: (catalogue[name].make, {"accuracy": catalogue[name].accuracy}) for name in HARD}
    return own_scenes() | hard


def digest(arrays: Iterable[tuple[str, np.ndarray]]) -> str:
    """SHA-256 of names, shapes and bits of arrays."""
    out = hashlib.sha256()
    for name, values in arrays:
        array = np.ascontiguousarray(values)
        out.update(f"{name} {array.dtype.str} {array.shape};".encode())
        out.update(array.tobytes())
    return out.hexdigest()


def tolerance_of(simulation: trb.Simulation) -> list[float]:
    """Absolute tolerance of every coordinate of rollers and cage; infinite for spin angles and quadratures."""
    out = np.full(simulation.state.vector.size, np.inf)
    for name, offset, shape in simulation.bearings[0].model.state_layout():
        body, _, coordinate = name.partition("_")
        for setting, coordinates in TOLERANCES.values():
            if body in ("roller", "cage") and coordinate in coordinates:
                n, stride = shape if len(shape) == 2 else (1, 1)
                out[offset : offset + n * stride : stride] = getattr(simulation.options.tolerances, setting)
    return out.tolist()


def run(make: Make, options: Mapping[str, Any]) -> dict[str, Any]:
    """What a build computes of a scene."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        simulation = trb.Simulation(make(), **options)
        result = simulation.run(duration=DURATION, save_every=EVERY)
    state = simulation.state.vector
    peaks = result.peaks
    return {
        "records": {field.name: digest([(field.name, result[field.name])]) for field in result.fields},
        "peaks": digest((name, peaks[name]) for name in sorted(peaks)),
        "state": digest([("state", state)]),
        "steps": int(simulation.statistics["steps"]),
        "instruction_set": simulation.instruction_set,
        "values": [value.hex() for value in state.tolist()],
        "tolerances": tolerance_of(simulation),
    }


def compare(now: Mapping[str, Any], before: Mapping[str, Any] | None) -> dict[str, Any]:
    """A row of the table."""
    if before is None:
        return {"bits": "not in the file", "off": None, "steps": str(now["steps"])}
    differ = [part for part in ("state", "peaks") if now[part] != before[part]]
    # a quantity that one of the builds alone records says nothing
    common = now["records"].keys() & before["records"].keys()
    others = sorted(name for name in common if now["records"][name] != before["records"][name])
    if others:
        differ.append(
            f"records of {', '.join(others[:3])}" + (f" and {len(others) - 3} more" if len(others) > 3 else "")
        )
    steps = str(now["steps"]) if now["steps"] == before["steps"] else f"{before['steps']} -> {now['steps']}"
    if now["instruction_set"] != before["instruction_set"]:
        differ.append(f"instruction set {before['instruction_set']} -> {now['instruction_set']}")
    if not differ:
        return {"bits": "same bits", "off": 0.0, "steps": steps}
    values = [np.array([float.fromhex(text) for text in found["values"]]) for found in (before, now)]
    off = None
    if values[0].shape == values[1].shape:
        with np.errstate(invalid="ignore"):
            off = float(np.max(np.abs(values[1] - values[0]) / np.array(now["tolerances"])))
    return {"bits": "other " + ", ".join(differ), "off": off, "steps": steps}


def main() -> int:
    """Run all scenes; write what was found, or compare it."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", maxsplit=1)[0])
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--write", type=Path, metavar="FILE", help="write what this build computes to a JSON file")
    what.add_argument("--against", type=Path, metavar="FILE", help="compare this build with such a file")
    parser.add_argument("--only", nargs="+", metavar="SCENE", help="these scenes alone")
    options = parser.parse_args()
    every = scenes()
    unknown = sorted(set(options.only or ()) - set(every))
    if unknown:
        parser.error(f"no such scene: {', '.join(unknown)}; there are {', '.join(every)}")
    chosen = {name: every[name] for name in options.only or every}
    before: dict[str, Any] | None = None
    if options.against is not None:
        file = json.loads(options.against.read_text(encoding="utf-8"))
        if file.get("schema") != SCHEMA:
            parser.error(f"{options.against} was not written by this script")
        before = file["scenes"]
    found = {name: run(*case) for name, case in chosen.items()}
    if before is None:
        out = {"schema": SCHEMA, "machine": machine(), "scenes": found}
        options.write.write_text(json.dumps(out, indent=1) + "\n", encoding="utf-8")
        print(f"wrote {options.write}: {len(found)} scenes")
        return 0
    rows = [{"scene": name} | compare(now, before.get(name)) for name, now in found.items()]
    shown = {
        "scene": "scene",
        "bits": "state, records, peaks",
        "off": "largest difference (tolerances)",
        "steps": "steps",
    }
    print(table([{text: row[name] for name, text in shown.items()} for row in rows], shown.values()))
    same = sum(row["bits"] == "same bits" for row in rows)
    print(f"{same} of {len(rows)} scenes: same bits in final state, records and peaks")
    return 0 if same == len(rows) else 1


if __name__ == "__main__":
    sys.exit(main())
