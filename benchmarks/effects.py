"""What each effect costs and does: every effect of the scene alone off, and alone on.

    python benchmarks/effects.py [--quick | --without] [--json FILE]

Alone off: all effects but one, from states of a whirling cage in the middle of a collision: time, evaluations, and
what the effect changes in cage speed, whirl and torque. Alone on: that effect alone beside normal contact at the
raceways.

``time_ratio_off`` is the time of one force evaluation (``derivative``) of the scene without the effect, in the core as
it is, over that in a core that was compiled without the effect's code: 1 if an effect that is off costs nothing. Both
cores are compiled in this run from the same copy of the sources with the same flags, loaded side by side and timed in
turns. ``evaluations_off`` sums the effect's counters over a run without it. Effects whose switch only chooses data or
one of two loops (pocket faces, the rib's film, planar motion) have no code of their own to leave out, and no ratio.
``instructions_off`` and ``instructions_on`` are counted by callgrind, so that what else the machine does is not in them. An
effect that is off in the scene of all others (a film in the pockets, drag, a housing) is added to it, and its "all" is with it.
``--without`` gives ``instructions_ratio_off`` alone: instructions of a core in which an effect is off over those of one without
its code.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType
from typing import Any

import common
import numpy as np
from accuracy import measure, states
from effect_cost.build import BuildError, Builds
from effect_cost.catalogue import EFFECTS, EVERYTHING, NOTHING, Effect
from effect_cost.instructions import MANY, VARIANT, CannotCount, counted, described

from trbdyn import Scene, Simulation, Start, TrbError
from trbdyn.model.effects import Effects
from trbdyn.model.flatten import diameter_deviation, face_rows, parameter_block
from trbdyn.statics.ring_motion import ring_motion

COLUMNS = {
    "effect": "text: name of the effect",
    "text": "text: what it is",
    "us_off": "us: one force evaluation with all effects but this",
    "us_all": "us: one force evaluation with all effects",
    "us_on": "us: one force evaluation with this effect alone",
    "us_none": "us: one force evaluation with none (with what the effect needs)",
    "share": "1: share of the effect in a force evaluation, 1 - us_off/us_all",
    "instructions_ratio_off": "1: instructions without the effect over those of a core built without its code",
    "time_ratio_off": "1: force evaluation without the effect over that of a core built without its code",
    "instructions_off": "1000: instructions of one force evaluation with all effects but this, by callgrind with AVX2",
    "instructions_on": "1000: the same with this effect",
    "evaluations_off": "1: sum of the effect's counters in the run without it",
    "evaluations_on": "1: sum of the effect's counters in the run with all effects",
    "cpu_s_per_revolution_off": "s: processor time a revolution with all effects but this",
    "cpu_s_per_revolution_on": "s: processor time a revolution with this effect alone, rolling from equal spacing",
    "steps_per_revolution_off": "1: steps a revolution with all effects but this",
    "cage_speed_change": "1: what the effect adds to the turn of the cage over that of the shaft, over the value with all",
    "whirl_radius_change": "1: change of the cage centre's mean distance from the bearing axis over Cpr when the effect is added",
    "torque_change": "1: what the effect adds to the shaft's mean torque, over the torque with all",
    "whirl_radius_half_width": "1: half the 95 % confidence interval of the whirl radius without the effect",
    "effects": "object: time_ratio_off, evaluations_off and share by effect",
    "all": "object: figures with all effects",
    "none": "object: figures without any",
    "control_ratio": "1: the same ratio of two equal cores: how far timings can be trusted",
    "worst_time_ratio_off": "1: largest time_ratio_off",
}


@dataclass(frozen=True)
class Plan:
    """How much is run: states, turns of a run, rounds of paired timings, and the effects that a core is built
    without.
    """

    states: int
    revolutions: float
    rounds: int
    built: tuple[str, ...] | None
    effects: tuple[str, ...] | None = None
    counted: bool = True


FULL = Plan(5, 10.0, 41, None)
QUICK = Plan(2, 1.0, 15, None)
SMOKE = Plan(1, 0.1, 3, (), ("thermal", "gravity"), counted=False)


def scene_with(case: states.Case, effects: Effects) -> Scene:
    """The colliding case with other effects; starts from equal spacing unless a state is given."""
    return case.scene.replace(effects=effects, start=Start.equal())


def state_of(scene: Scene, case: states.Case) -> Any:
    """A state of the colliding cage, or that of the start where the scene has other coordinates."""
    start = Simulation(scene).state
    return case.states[0] if len(start.vector) == len(case.states[0].vector) else start


def evaluation_us(scene: Scene, vector: Any, repeats: int) -> float:
    """Time of one force evaluation (us); from the start where the state is that of other coordinates."""
    sim = Simulation(scene)
    vector = vector if len(vector) == len(sim.state.vector) else sim.state.vector
    return 1e6 * measure.least_per_call(lambda: sim.derivative(vector, 0.0), repeats=repeats)


def change(before: measure.Mean, after: measure.Mean, *, relative: bool) -> float:
    """What an effect adds; relative: over the value with it."""
    added = after.value - before.value
    return added / after.value if relative else added


class Evaluation:
    """One force evaluation of a scene in a given core."""

    def __init__(self, core: ModuleType, scene: Scene, vector: Any, variant: str) -> None:
        model = core.Model(parameter_block(scene), diameter_deviation(scene), face_rows(scene), variant)
        motion, _ = ring_motion(model, scene)
        self._core = core.Simulation((model,), (motion.table,), 0.0, vector, {})
        self._vector = vector

    def __call__(self) -> Any:
        return self._core.derivative(0.0, self._vector)


def check_alike(with_code: Evaluation, without: Evaluation) -> None:
    """Without the effect both cores give the same forces.

    Raises
    ------
    BuildError
        If not.
    """
    if not np.allclose(with_code(), without(), rtol=1e-9, atol=1e-9):
        raise BuildError("the core without the code gives other forces: more than the effect was taken out")


def ratio_of(with_code: Evaluation, without: Evaluation, rounds: int) -> float:
    """Ratio of the fastest loops, taken in turns."""
    check_alike(with_code, without)
    fastest = [float("inf")] * 2
    for _ in range(rounds):
        for place, one in enumerate((with_code, without)):
            fastest[place] = min(fastest[place], measure.least_per_call(one, repeats=3))
    return fastest[0] / fastest[1]


def instructions(case: states.Case, plan: Plan, report: common.Report) -> dict[str, dict[str, float]]:
    """Instructions of an evaluation without and with every effect; nothing, and a note, where they cannot be counted."""
    if not plan.counted:
        return {}
    plain, vector = scene_with(case, EVERYTHING), case.states[0].vector
    scenes = [plain, plain]  # the first evaluation of a process takes more
    for effect in EFFECTS:
        scenes.append(effect.switched_on(plain) if effect.is_added else effect.switched_off(plain))
    with tempfile.TemporaryDirectory() as folder:
        try:
            counts = counted([described(scene, vector) for scene in scenes], Path(folder))
        except CannotCount as error:
            report.notes.append(f"No instructions were counted: {error}.")
            return {}
    every = counts[1]
    out: dict[str, dict[str, float]] = {}
    for effect, count in zip(EFFECTS, counts[2:], strict=True):
        off, on = (every, count) if effect.is_added else (count, every)
        out[effect.name] = {"instructions_off": off, "instructions_on": on}
    return out


def counted_without(case: states.Case, effect: Effect, cores: Sequence[ModuleType], plan: Plan) -> float | None:
    """Instructions of an evaluation without an effect, over those in a core without its code; None where none are counted."""
    if not plan.counted:
        return None
    scene = described(effect.switched_off(scene_with(case, EVERYTHING)), case.states[0].vector)
    found = []
    for core in cores:
        with tempfile.TemporaryDirectory() as folder:
            try:
                found.append(counted([scene, scene], Path(folder), Path(str(core.__file__)), MANY)[-1])
            except CannotCount:
                return None
    return found[0] / found[1]


def with_code_to_take_out(plan: Plan) -> list[Effect]:
    """Effects that a core is built without."""
    wanted = [effect for effect in EFFECTS if effect.patch is not None]
    return [effect for effect in wanted if plan.built is None or effect.name in plan.built]


def without(case: states.Case, report: common.Report) -> None:
    """Rows of instructions alone: an effect that is off, over a core without its code."""
    whole_scene, vector = scene_with(case, EVERYTHING), case.states[0].vector
    with tempfile.TemporaryDirectory() as folder:
        builds = Builds(Path(folder), (VARIANT,))
        whole = builds.whole()
        for effect in with_code_to_take_out(FULL):
            assert effect.patch is not None
            core, off = builds.without(effect.name, effect.patch), effect.switched_off(whole_scene)
            check_alike(*(Evaluation(one, off, vector, VARIANT) for one in (whole, core)))
            counters = counters_of(off, case.states[0], QUICK)
            report.add(
                effect=effect.name,
                text=effect.text,
                instructions_ratio_off=counted_without(case, effect, (whole, core), FULL),
                evaluations_off=sum(counters[name] for name in effect.counters),
            )
            print(
                common.table(report.results[-1:], ("effect", "instructions_ratio_off", "evaluations_off")), flush=True
            )


def ratios(case: states.Case, plan: Plan, report: common.Report) -> dict[str, dict[str, float | None]]:
    """time_ratio_off and instructions_ratio_off of every effect that a core can be built without."""
    out: dict[str, dict[str, float | None]] = {}
    variant = Simulation(case.scene).instruction_set
    wanted = with_code_to_take_out(plan)
    if not wanted:
        return out
    vector = case.states[0].vector
    with tempfile.TemporaryDirectory() as folder:
        try:
            builds = Builds(Path(folder), (variant, VARIANT))
            whole = builds.whole()
        except BuildError as error:
            report.notes.append(f"No core was built, so there is no time_ratio_off: {error}.")
            return out
        whole_scene = scene_with(case, EVERYTHING)
        one, other = (Evaluation(core, whole_scene, vector, variant) for core in (whole, builds.without("nothing", {})))
        report.summary["control_ratio"] = ratio_of(one, other, plan.rounds)
        for effect in wanted:
            assert effect.patch is not None
            scene = scene_with(case, EVERYTHING.replace(**effect.off))
            try:
                core = builds.without(effect.name, effect.patch)
                with_code, without = (Evaluation(one, scene, vector, variant) for one in (whole, core))
                out[effect.name] = {
                    "time_ratio_off": ratio_of(with_code, without, plan.rounds),
                    "instructions_ratio_off": counted_without(case, effect, (whole, core), plan),
                }
            except (BuildError, TrbError) as error:
                report.notes.append(f"{effect.name}: no time_ratio_off: {error}.")
    return out


def one_effect(
    effect: Effect, case: states.Case, plan: Plan, whole: dict[str, Any], all_counters: dict[str, int]
) -> dict[str, Any]:
    """Figures of an effect alone off and alone on."""
    vector = case.states[0].vector
    plain = scene_with(case, EVERYTHING)
    off, every = effect.switched_off(plain), effect.switched_on(plain)
    row: dict[str, Any] = {"effect": effect.name, "text": effect.text}
    row["us_off"] = evaluation_us(off, vector, plan.rounds)
    row["us_all"] = evaluation_us(every, vector, plan.rounds)
    row["share"] = 1.0 - row["us_off"] / row["us_all"]
    row["us_none"] = evaluation_us(scene_with(case, NOTHING.replace(**effect.needs)), vector, plan.rounds)
    on = effect.alone(plain)
    row["us_on"] = evaluation_us(on, vector, plan.rounds)
    cost = measure.wall_time(off, case.states, {}, plan.revolutions, repeats=2)
    row["cpu_s_per_revolution_off"] = cost["cpu_s_per_revolution"]
    row["steps_per_revolution_off"] = cost["steps_per_revolution"]
    found = whole if effect.is_added else measure.long_run(case, {}, plan.revolutions, off)
    if effect.is_added:
        state = state_of(every, case)
        whole = measure.long_run(replace(case, states=(state,)), {}, plan.revolutions, every)
        all_counters = counters_of(every, state, plan)
    row["cage_speed_change"] = change(found["cage_speed_ratio"], whole["cage_speed_ratio"], relative=True)
    row["whirl_radius_change"] = change(found["whirl_radius"], whole["whirl_radius"], relative=False)
    row["whirl_radius_half_width"] = found["whirl_radius"].half_width
    row["torque_change"] = change(found["torque"], whole["torque"], relative=True)
    counters = counters_of(off, case.states[0], plan)
    row["evaluations_off"] = sum(counters[name] for name in effect.counters) if effect.counters else None
    row["evaluations_on"] = sum(all_counters[name] for name in effect.counters) if effect.counters else None
    try:
        start = [Simulation(on).state]
        row["cpu_s_per_revolution_on"] = measure.wall_time(on, start, {}, plan.revolutions, repeats=1)[
            "cpu_s_per_revolution"
        ]
    except TrbError:
        row["cpu_s_per_revolution_on"] = None
    return row


def counters_of(scene: Scene, state: Any, plan: Plan) -> dict[str, int]:
    """Counters of a run from a state."""
    sim = Simulation(states.at_state(scene, state))
    return sim.run(revolutions=min(plan.revolutions, 2.0), save_every=1e-3).counters


def run(plan: Plan, options: argparse.Namespace) -> common.Report:
    """Everything."""
    report = common.Report("effects", options, COLUMNS)
    case = states.load_case("collision").first(plan.states)
    everything = scene_with(case, EVERYTHING)
    report.inputs = {
        "scene": "30310 rig, 3000 rpm, 4930 N, 8 Gauss nodes a contact, standard accuracy",
        "states": plan.states,
        "revolutions": plan.revolutions,
        "instruction_set": Simulation(everything).instruction_set,
    }
    whole = measure.long_run(case, {}, plan.revolutions, everything)
    all_counters = counters_of(everything, case.states[0], plan)
    cost = measure.wall_time(everything, case.states, {}, plan.revolutions, repeats=2)
    vector = case.states[0].vector
    report.summary["all"] = {
        "us": evaluation_us(everything, vector, plan.rounds),
        "cpu_s_per_revolution": cost["cpu_s_per_revolution"],
        **{name: mean.value for name, mean in whole.items()},
        "whirl_radius_half_width": whole["whirl_radius"].half_width,
    }
    report.summary["none"] = {"us": evaluation_us(scene_with(case, NOTHING), vector, plan.rounds)}
    found, counts = ratios(case, plan, report), instructions(case, plan, report)
    for effect in EFFECTS:
        if plan.effects is None or effect.name in plan.effects:
            row = one_effect(effect, case, plan, whole, all_counters)
            report.add(**row, **found.get(effect.name, {}), **counts.get(effect.name, {}))
    report.summary["effects"] = {
        row["effect"]: {name: row.get(name) for name in ("time_ratio_off", "evaluations_off", "share")}
        for row in report.results
    }
    known = [ratio for one in found.values() if (ratio := one["time_ratio_off"]) is not None]
    report.summary["worst_time_ratio_off"] = max(known, default=None)
    report.notes.append(
        "Changes are those when the effect is added to all others; a change of the whirl radius smaller than the confidence "
        "interval is none. Times a revolution depend on the motion: an effect that calms it seems to cost nothing."
    )
    return report


def text_of(report: common.Report) -> str:
    """The tables."""
    whole = {
        "all effects (us)": report.summary["all"]["us"],
        "none (us)": report.summary["none"]["us"],
        "largest time_ratio_off": report.summary["worst_time_ratio_off"],
        "ratio of two equal cores": report.summary.get("control_ratio"),
    }
    counts = ("instructions_off", "instructions_on", "instructions_ratio_off", "evaluations_off", "evaluations_on")
    cost = ("effect", "us_off", "share", "us_none", "us_on", "time_ratio_off", *counts)
    walls = ("cpu_s_per_revolution_off", "cpu_s_per_revolution_on", "steps_per_revolution_off")
    changes = ("cage_speed_change", "whirl_radius_change", "whirl_radius_half_width", "torque_change")
    tables = (
        common.table([whole], whole),
        common.table(report.results, cost),
        common.table(report.results, ("effect", *walls, *changes)),
    )
    return "\n\n".join(tables)


def main(arguments: Sequence[str] | None = None) -> common.Report:
    parser = common.parser(__doc__)
    parser.add_argument(
        "--without", action="store_true", help="instructions beside cores without an effect's code alone"
    )
    options = parser.parse_args(arguments)
    if options.without:
        report = common.Report("effects", options, COLUMNS)
        without(states.load_case("collision").first(1), report)
        report.finish()
        return report
    report = run(SMOKE if options.smoke else QUICK if options.quick else FULL, options)
    report.readme = text_of(report)
    print(report.readme)
    report.finish()
    return report


if __name__ == "__main__":
    main()
