"""The package is built in layers: modules are found by their old names, tables of the core say units and ranges, nothing is
loaded before it is needed.
"""

from __future__ import annotations

import importlib
import importlib.util
import json
import pickle
import re
import subprocess
import sys
from pathlib import Path
from types import FunctionType, ModuleType

import pytest
from pydantic import ValidationError

import trbdyn as trb
from trbdyn import _core
from trbdyn.base.validation import Model
from trbdyn.cli import case
from trbdyn.model.core_table import PARAMETERS, SETTINGS
from trbdyn.model.flatten import (
    bearing_entries,
    effects_entries,
    elastic_entries,
    housing_entries,
    lubricant_entries,
    rib_entries,
    ring_entries,
)
from trbdyn.run.options import ACCURACY, RunOptions, Tolerances
from trbdyn.run.simulation import Simulation

ROOT = Path(__file__).parents[2]


def in_a_new_process(code: str) -> str:
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def kinds_of(model: type[Model]) -> list[type[Model]]:
    """Every input model of the package, below this one."""
    return [
        kind for own in model.__subclasses__() for kind in (own, *kinds_of(own)) if own.__module__.startswith("trbdyn.")
    ]


def test_pickled_objects_can_be_read() -> None:
    scene = trb.Scene(
        trb.cases.rig_30310(),
        speed_rpm=3000,
        axial_load=trb.History(times=(0.0, 1.0), values=(900.0, 990.0)),
        ring="follows",
    )
    state = Simulation(trb.cases.scene_30310(1000.0, 3080.0)).state
    again, state_again = pickle.loads(pickle.dumps((scene, state)))
    assert again == scene
    assert state_again.time == state.time


def test_public_modules_are_attributes() -> None:
    for name in ("animation", "cases", "errors", "laws", "lubricants", "observables", "plot", "pocket_shapes", "study"):
        assert isinstance(getattr(trb, name), ModuleType)
    with pytest.raises(AttributeError, match="no attribute 'paper'"):
        _ = trb.paper
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("trbdyn.paper")


@pytest.mark.parametrize(
    "module",
    [trb, trb.study, trb.plot, trb.cases, trb.pocket_shapes, trb.errors, trb.laws, trb.animation, trb.observables],
    ids=lambda m: m.__name__,
)
def test_completion_shows_what_users_need(module: ModuleType) -> None:
    """It listed `Any`, `TYPE_CHECKING`, `importlib` and the like."""
    shown = {name for name in dir(module) if not name.startswith("_")}
    values = {name: getattr(module, name) for name in shown}
    modules = {name: value.__name__ for name, value in values.items() if isinstance(value, ModuleType)}
    named = {name: value.__module__ for name, value in values.items() if isinstance(value, type | FunctionType)}
    assert {name for name, home in (modules | named).items() if not home.startswith("trbdyn")} == set()
    assert not shown & {"TYPE_CHECKING", "Any", "importlib", "annotations", "np", "plt", "dataclass"}
    assert len(shown) > 1


def test_modules_have_one_name() -> None:
    """Nothing has been released, so no former name leads anywhere."""
    for name in ("plotting", "cases", "bearing"):
        with pytest.raises(ModuleNotFoundError):
            importlib.import_module(f"trbdyn.{name}")


def test_help_comes_without_numpy_and_pydantic() -> None:
    code = "import sys, trbdyn.cli as c; c.make_parser(); print([n for n in ('numpy', 'pydantic', 'h5py') if n in sys.modules])"
    assert in_a_new_process(code).strip() == "[]"


def test_every_parameter_of_the_core_has_an_input() -> None:
    given = {**bearing_entries(trb.cases.rig_30310()), **lubricant_entries(trb.lubricants.vg100())}
    given |= effects_entries(trb.Effects()) | rib_entries(trb.cases.rig_30310(), trb.Effects())
    of_housing = housing_entries(trb.cases.paper_30310())
    given |= ring_entries(trb.cases.paper_30310()) | elastic_entries(trb.cases.paper_30310()) | of_housing
    named = {
        extra["parameter"]
        for model in kinds_of(Model)
        for field in model.model_fields.values()
        if isinstance(extra := field.json_schema_extra, dict) and "parameter" in extra
    }
    # a housing has the parameters of a free ring, by another name
    assert {name.replace("outer_", "ring_", 1) for name in of_housing} <= {
        *named,
        "ring_free",
        "ring_carried",
        "ring_turned",
    }
    numbers = {name for name, row in PARAMETERS.items() if row.unit != "choice"}
    of_other_bodies = {f"{body}_{name}" for body in ("roller", "cage") for name in ("youngs_modulus", "poisson_ratio")}
    assert named == numbers - of_other_bodies - set(of_housing) - {
        "cup_half_angle",
        "cage_face_inner",
        "cage_face_outer",
        "ring_unbalance_angle",
        "ring_shift",
        "replenishment",
    }  # in degrees; of a seat; by a constant of SKF and the bearing's size
    assert set(given) | {"outer_turns", "replenishment"} == set(PARAMETERS)  # follow from the scene


def test_the_numbers_of_a_model_belong_to_one_part() -> None:
    """The core's table says whose each number is; a model has those of one part, and a housing those of a ring that moves.

    A row of pockets has its own roughness, damping and film in the core; users give them with the roughnesses and effects.
    """
    parts = {}
    for model in kinds_of(Model):
        extras = (field.json_schema_extra for field in model.model_fields.values())
        named = {extra["parameter"] for extra in extras if isinstance(extra, dict) and "parameter" in extra}
        if named:
            parts[model.__name__] = {PARAMETERS[name].part for name in named}
    of_two = {name: found for name, found in parts.items() if len(found) != 1}
    assert of_two == {"Roughness": {"roughness", "pocket"}, "Effects": {"effects", "pocket"}}
    expected = {
        "Bearing": "bearing",
        "Roller": "roller",
        "Ribs": "rib",
        "Cage": "cage",
        "Land": "land",
        "Lubricant": "oil",
    }
    assert {name: next(iter(parts[name])) for name in expected} == expected
    assert {row.part for row in PARAMETERS.values()} == {found for one in parts.values() for found in one} | {
        "outer_ring"
    }


def test_ranges_and_units_are_those_of_the_core() -> None:
    code = """
import trbdyn._core as core
rows = core.parameter_table()
core.parameter_table = lambda: [(n, "furlong" if n == "crown_radius" else u, 7.0 if n == "crown_radius" else a, b, t, p)
                                for n, u, a, b, t, p in rows]
import trbdyn as trb
try:
    trb.Profile.crowned(5.0)
except trb.InputError as error:
    print(error)
"""
    assert "must be >= 7 (furlong)" in in_a_new_process(code)


def test_one_default_for_each_setting() -> None:
    assert RunOptions().settings() == {
        "integrator": "auto",
        **{
            name: SETTINGS[name].default
            for name in (
                *Tolerances.model_fields,
                "max_order",
                "first_step",
                "rings_share",
                "impact_share",
            )
        },
    }
    assert ACCURACY["standard"].rtol == {row[0]: row[1] for row in _core.setting_table()}["rtol"]
    with pytest.raises((trb.InputError, ValidationError), match="max_order"):
        RunOptions(max_order=int(SETTINGS["max_order"].upper) + 1)


def test_the_command_line_hands_on_every_option_of_a_case(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    seen: list[RunOptions] = []

    def look(self: Simulation, **arguments: object) -> None:
        seen.append(self.options)

    monkeypatch.setattr(Simulation, "run", look)
    options = RunOptions(duration=1e-3, when_wrong="go_on", integrator="erk", max_order=1, rings_share=0.0)
    scene = trb.cases.paper_30310(1000.0, 3080.0)
    case.simulate(scene, options, tmp_path / "a.h5", quiet=True, overwrite=False)
    assert seen[0].of_simulation() == options.of_simulation()
    assert seen[0].when_wrong == "go_on"


def load_rules() -> ModuleType:
    pytest.importorskip("grimp", reason="grimp comes with make lint")
    return pytest.importorskip("lint_imports", reason="the checks are not part of a source distribution")


def test_a_circle_of_imports_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rules = load_rules()
    package = tmp_path / "ringed"
    package.mkdir()
    for name, text in {
        "__init__": "",
        "one": "from ringed import two",
        "two": "def late():\n    from ringed.three import late\n",
        "three": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from ringed import one\n",
    }.items():
        (package / f"{name}.py").write_text(text)
    monkeypatch.syspath_prepend(str(tmp_path))
    assert rules.circle("ringed") == []
    (package / "three.py").write_text("from ringed.one import two\n")
    assert set(rules.circle("ringed")) == {"ringed.one", "ringed.three", "ringed.two"}


def test_imports_run_in_no_circle() -> None:
    assert load_rules().circle("trbdyn") == []


def test_the_page_on_design_tells_the_knots_of_types() -> None:
    """`make lint` holds the table against the imports."""
    sizes = load_rules().KNOTS
    page = (ROOT / "docs" / "design.md").read_text(encoding="utf-8")
    told = re.search(r"There are knots of (.*?) and (\w+) of two;", page, re.DOTALL)
    assert told is not None
    large = {
        "trbdyn." + place.replace("/", "."): int(n) for n, place in re.findall(r"(\d+)[^,`]* in `([\w/]+)/`", told[1])
    }
    assert large == {folder: own[0] for folder, own in sizes.items() if own[0] > 2}
    assert told[2] == {4: "four", 3: "three", 2: "two"}[sum(own.count(2) for own in sizes.values())]


def test_files_hold_the_version_that_the_package_has() -> None:
    assert json.loads(json.dumps(trb.__version__)) == importlib.import_module("trbdyn.base.version").__version__
