"""Whatever comes in, it is used or refused with one of the package's own errors, which says why: never anything
else.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pydantic import BaseModel

import trbdyn as trb
from trbdyn.base.shipped import CASES
from trbdyn.errors import FileError, InputError, LoadError, StepError
from trbdyn.model.cases import paper_30310
from trbdyn.run.toml_case import case_from_dict, load_case

COMMON = settings(
    max_examples=150,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.function_scoped_fixture],
)

NUMBERS = st.one_of(
    st.floats(),
    st.sampled_from([0.0, -0.0, 1.0, -1.0, 1e-300, 1e300, math.nan, math.inf, -math.inf]),
    st.integers(-(10**20), 10**20),
)
ANYTHING = st.one_of(
    NUMBERS,
    st.none(),
    st.booleans(),
    st.text(max_size=8),
    st.binary(max_size=4),
    st.lists(NUMBERS, max_size=4),
    st.dictionaries(st.text(max_size=4), NUMBERS, max_size=2),
)


def say(error: Exception) -> None:
    """A refusal gives its reason."""
    assert str(error)


def leaves(values: Any, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    """Places of every value in nested tables, and of the tables themselves."""
    inner: Any = values.items() if isinstance(values, dict) else enumerate(values) if isinstance(values, list) else ()
    return [path, *(place for key, value in inner for place in leaves(value, (*path, key)))]


def put(values: Any, path: tuple[str | int, ...], value: Any) -> Any:
    """The same with one value changed."""
    if not path:
        return value
    copy = dict(values) if isinstance(values, dict) else list(values)
    copy[path[0]] = put(copy[path[0]], path[1:], value)
    return copy


RIG = trb.cases.rig_30310()


def full_scene() -> trb.Scene:
    """A scene with pockets, deviations, estimates, a history, a displacement and a state of its own."""
    pocket = trb.pocket_shapes.one_sided_pocket(RIG)
    bearing = RIG.replace(
        roller=RIG.roller.replace(diameter_deviation=tuple(1e-6 * (j % 3) for j in range(RIG.n_rollers))),
        cage=RIG.cage.replace(pocket=pocket, other_pockets=(trb.OtherPocket(index=3, pocket=pocket),)),
        cup_profile=trb.Profile.crowned(100.0),
        cone_profile=trb.Profile.iso(),
        estimates=trb.Bearing.from_catalogue(bore=0.05, outside=0.11, width=0.02925, C=125e3, e=0.35).estimates[:1],
    )
    shift = trb.History(times=(0.0, 1e-3), values=(-40e-6, -42e-6))
    scene = paper_30310(3000.0, 0.0, bearing=bearing, displacement=(0.0, 1e-6, shift), misalignment_x=1e-4)
    return scene.replace(start=trb.Start.state(trb.Simulation(scene).state.vector))


CERAMIC, PLASTIC = (trb.Material(youngs_modulus=E, poisson_ratio=nu) for E, nu in ((310e9, 0.27), (4e9, 0.4)))
SCENE = paper_30310(
    bearing=RIG.replace(
        roller=RIG.roller.replace(
            diameter_scatter=trb.Scatter(range=1e-6, seed=1), material=CERAMIC.replace(expansion=3e-6)
        ),
        cage=RIG.cage.replace(
            material=PLASTIC.replace(density=1300.0, expansion=50e-6, damping_ratio=0.02),
            mass=0.034,
            unbalance=1e-7,
            body=trb.cases.cage_body_30310().replace(
                small_rim_thickness=4e-3, large_rim_thickness=4.5e-3, height=3e-3, corner_radius=1e-3
            ),
        ),
    ),
    growth=trb.Growth.uniform(40.0),
    lubricant=trb.Lubricant(
        viscosity=0.03,
        pressure_coefficient=2e-8,
        temperature_coefficient=0.04,
        temperature_c=60.0,
        density=870.0,
        name="own",
    ),
).to_dict()
FULL = full_scene().to_dict()
FREE = SCENE | {
    "ring": "free",
    "ring_body": trb.RingBody.hollow_cylinder(mass=2.0, outer_diameter=0.06, length=0.1).to_dict(),
    "housing": trb.Housing.hollow_cylinder(mass=4.0, inner_diameter=0.11, outer_diameter=0.16, length=0.05)
    .replace(support_radial=2e8, support_axial=1e8)
    .to_dict(),
    "torque": 1.0,
}
PLACES = leaves(SCENE)[1:]
FREE_PLACES = [place for place in leaves(FREE)[1:] if place[0] in ("ring", "ring_body", "housing", "torque")]
FULL_PLACES = leaves(FULL)[1:]
CASES = {name: tomllib.loads(CASES.find(name).read_text(encoding="utf-8")) for name in CASES.names()}
CASE_PLACES = [(name, place) for name, case in CASES.items() for place in leaves(case)[1:]]


def choices(model: type[BaseModel], path: tuple[str, ...] = ()) -> list[tuple[tuple[str, ...], Any]]:
    """Every field of a model and of the models in it that takes one of a few words, with each word."""
    found: list[tuple[tuple[str, ...], Any]] = []
    for name, info in model.model_fields.items():
        kind = info.annotation
        if get_origin(kind) is Literal:
            found += [((*path, name), word) for word in get_args(kind)]
        elif isinstance(kind, type) and issubclass(kind, BaseModel):
            found += choices(kind, (*path, name))
    return found


def ramp(*values: float, end: float = 1.0) -> trb.History:
    return trb.History(times=tuple(np.linspace(0.0, end, len(values)).tolist()), values=values)


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: paper_30310(gravity=(0.0, ramp(-9.8, 1e300), 0.0)), "gravity[1]"),
        (lambda: paper_30310(gravity=(0.0, 0.0, -1e300)), "gravity[2]"),
        (lambda: ramp(1e308, -1e308, 1e308), "history.values[1]"),
        (lambda: ramp(0.0, 1e10, end=1e-300), "history.values[1]"),
        (lambda: ramp(3000.0, 1000.0, end=1e300), "history.times[1]"),
        (lambda: trb.Start(time=1e300), "start.time"),
        (lambda: trb.Simulation(paper_30310()).set_state(good_state(), 1e300), "time"),
        (lambda: trb.Effects(n_slices=1, back_rib=False), "effects.n_slices"),
    ],
)
def test_what_would_overflow_or_float_freely_is_refused_by_name(make: Callable[[], object], field: str) -> None:
    with pytest.raises(InputError) as found:
        make()
    assert found.value.field == field


def good_state() -> Any:
    return trb.Simulation(paper_30310()).state.vector


def fields_of(kind: Any, path: tuple[str, ...] = ()) -> list[tuple[str, ...]]:
    """Names of every field of a model and of the models in it, also in its sequences and choices."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        inside = [fields_of(info.annotation, (*path, name)) for name, info in kind.model_fields.items()]
        return [(*path, name) for name in kind.model_fields] + [field for found in inside for field in found]
    if get_origin(kind) is Literal:
        return []
    return [field for part in get_args(kind) if part is not trb.History for field in fields_of(part, path)]


def test_no_field_is_left_out() -> None:
    """What the properties below change is every field of every model."""
    full = {tuple(key for key in place if isinstance(key, str)) for place in FULL_PLACES}
    plain = {tuple(key for key in place if isinstance(key, str)) for place in PLACES}
    free = {tuple(key for key in place if isinstance(key, str)) for place in FREE_PLACES}
    left_out = set(fields_of(trb.Scene)) - full - plain - free
    # a load that rotates needs a path of equilibria, a second each: its fields are tested in tests/physics/test_ring_path.py;
    # modes of a cage take some tenths of one: tests/physics/test_elastic_cage.py
    # fields of a defect belong to its kind: tests/physics/test_defects.py; a drawing is a file: tests/geometry
    left_out = {field for field in left_out if field[:3] != ("bearing", "cage", "drawing")}
    assert {field[0] for field in left_out} <= {"rotating_load", "elastic_cage", "defects"}
    assert len(free) > 10


def full_places() -> st.SearchStrategy[tuple[str, tuple[str | int, ...]]]:
    """Places in the full scene; of a list's entries, those of the state vector are not the most likely ones."""
    short = [place for place in FULL_PLACES if place[:2] != ("start", "state_vector") or len(place) == 2]
    return st.tuples(st.just("full"), st.one_of(st.sampled_from(short), st.sampled_from(FULL_PLACES)))


@COMMON
@given(
    st.one_of(
        st.tuples(st.just("plain"), st.sampled_from(PLACES)),
        st.tuples(st.just("free"), st.sampled_from(FREE_PLACES)),
        full_places(),
    ),
    ANYTHING,
)
def test_any_value_in_any_field_of_a_scene(where: tuple[str, tuple[str | int, ...]], value: Any) -> None:
    kind, place = where
    try:
        scene = trb.Scene.from_dict(put({"full": FULL, "free": FREE, "plain": SCENE}[kind], place, value))
    except InputError as error:
        say(error)
    else:
        assert trb.Scene.from_json(scene.to_json()) == scene


@settings(parent=COMMON, max_examples=60)
@given(
    st.one_of(st.tuples(st.just("plain"), st.sampled_from(PLACES)), full_places()),
    st.floats(0.2, 5.0),
    st.sampled_from([1.0, -1.0]),
)
def test_what_is_accepted_can_be_stepped(where: tuple[str, tuple[str | int, ...]], factor: float, sign: float) -> None:
    """A scene with one number changed either steps, with finite states, or ends with a promised error."""
    kind, place = where
    scene = FULL if kind == "full" else SCENE
    value: Any = scene
    for key in place:
        value = value[key]
    if isinstance(value, bool) or not isinstance(value, int | float):
        value = not value if isinstance(value, bool) else value
    else:
        value = int(value * factor * sign) if isinstance(value, int) else value * factor * sign
    try:
        sim = trb.Simulation(trb.Scene.from_dict(put(scene, place, value)))
        for _ in range(20):
            sim.step()
    except (InputError, LoadError, StepError) as error:
        say(error)
    else:
        assert np.isfinite(sim.state.vector).all()


@COMMON
@given(
    st.sampled_from(["bearing", "lubricant", "effects", "scene", "start", "run", "other"]),
    st.one_of(st.text(max_size=12), st.sampled_from([str(place[-1]) for place in PLACES])),
    ANYTHING,
)
def test_any_key_of_a_case(table: str, key: str, value: Any) -> None:
    case: dict[str, Any] = {"bearing": {"case": "30310"}, "scene": {"speed_rpm": 3000.0, "axial_load": 4930.0}}
    case[table] = {**case.get(table, {}), key: value} if key else value
    try:
        case_from_dict(case)
    except InputError as error:
        say(error)


@COMMON
@given(st.sampled_from(CASE_PLACES), ANYTHING)
def test_any_value_at_any_key_of_a_shipped_case(where: tuple[str, tuple[str | int, ...]], value: Any) -> None:
    name, place = where
    try:
        case_from_dict(put(CASES[name], place, value))
    except InputError as error:
        say(error)


RUN_KEYS = sorted(trb.RunOptions.model_fields)


@COMMON
@given(st.dictionaries(st.sampled_from(RUN_KEYS), ANYTHING, min_size=1, max_size=3))
def test_any_options_of_a_run(options: dict[str, Any]) -> None:
    """Refused by name, or good for a short run."""
    try:
        trb.RunOptions(**options)
    except InputError as error:
        named = error.field.removeprefix("run.").split("[")[0]
        say(error) if named in options else pytest.fail(f"{error} names another field")


@COMMON
@given(st.text(max_size=200))
def test_any_text_as_a_case_file(tmp_path: Path, text: str) -> None:
    path = tmp_path / "case.toml"
    path.write_text(text, encoding="utf-8")
    try:
        load_case(path)
    except (InputError, FileError) as error:
        say(error)


@pytest.mark.parametrize(("path", "word"), choices(trb.Effects), ids=str)
def test_every_choice_of_effects_steps(path: tuple[str, ...], word: str) -> None:
    effects = trb.Effects.paper().replace(**{path[0]: word})
    sim = trb.Simulation(paper_30310(effects=effects))
    for _ in range(5):
        sim.step()
    assert np.isfinite(sim.state.vector).all()


@pytest.fixture(scope="module")
def sim() -> trb.Simulation:
    return trb.Simulation(paper_30310())


@pytest.mark.parametrize("integrator", ["bdf", "multirate"])
def test_numbers_that_are_too_large_for_a_step_never_enter_the_state(integrator: str) -> None:
    """A norm that is no number must not be hidden by the next body's."""
    sim = trb.Simulation(paper_30310(3000.0, 4930.0), integrator=integrator)
    good = sim.state.vector
    for entry in range(0, good.size, 7):
        for value in (2.855924064778409e21, -1e150, 1e300):
            try:
                sim.set_state(np.where(np.arange(good.size) == entry, value, good), 0.0)
                for _ in range(3):
                    sim.step()
            except (InputError, StepError) as error:
                say(error)
            assert np.isfinite(sim.state.vector).all(), (entry, value)


@COMMON
@given(data=st.data())
def test_any_state_vector(sim: trb.Simulation, data: st.DataObject) -> None:
    good = sim.scene and trb.Simulation(sim.scene).state.vector
    kind = data.draw(st.sampled_from(["one entry", "many entries", "wrong length", "not numbers"]))
    vector: Any = good.copy()
    if kind == "one entry":
        vector[data.draw(st.integers(0, vector.size - 1))] = data.draw(st.floats())
    elif kind == "many entries":
        vector += data.draw(st.floats(1e-9, 1e3)) * np.random.default_rng(data.draw(st.integers(0, 99))).normal(
            size=vector.size
        )
    elif kind == "wrong length":
        vector = data.draw(st.lists(st.floats(), max_size=300))
    else:
        vector = data.draw(ANYTHING)
    before = sim.state
    try:
        sim.set_state(vector, data.draw(st.one_of(st.none(), st.floats())))
    except InputError:
        after = sim.state
        assert after.time == before.time
        np.testing.assert_array_equal(after.vector, before.vector)
        return
    try:
        for _ in range(3):
            sim.step()
    except StepError as error:
        say(error)
    assert np.isfinite(sim.state.vector).all()
