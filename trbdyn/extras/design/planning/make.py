"""Ask for an accuracy, get the cheapest simulation that has it.

The scene as it is given, with all effects that it has switched on, is taken for the truth; how well that model fits a real
bearing is another question. A first run of it tells how long the motion takes to settle and how much the averages scatter. Then
each simplification, alone, runs from the state that the first run has reached (`trbdyn.extras.design.planning.probes`): what it
changes, and what it saves. The cheapest set whose errors add up to less than the wish is chosen
(`trbdyn.extras.design.planning.choice`), and it is run once more as a whole against the most exact probe, since simplifications
may act together. Where that shows a larger error than promised, nothing is left out.

The run that is proposed starts from the same state. From the start of the scene a simplified model may go elsewhere: without
gravity a cage that begins in the middle stays there, where it is not stable, and what planar motion holds stays where it began.
"""

from __future__ import annotations

import math
import time as clock
from collections.abc import Mapping
from typing import Final

from trbdyn.base.expected import expect
from trbdyn.extras.design.planning.candidates import TRUE_ACCURACY, TRUE_NODES
from trbdyn.extras.design.planning.deciding import EXACT, USUAL, Decision, decide
from trbdyn.extras.design.planning.looking import Looker, Seen, Tried
from trbdyn.extras.design.planning.proposal import Plan, Row
from trbdyn.extras.design.planning.wishes import Wishes, changed, checked
from trbdyn.model.assembly import Assembly, Subject
from trbdyn.model.scene import Scene

EFFORT: Final = 15.0
"""Computing time for the probes (s)."""


def plan(scene: Subject, want: Mapping[str, float], *, budget: float | None = None, effort: float = EFFORT) -> Plan:
    """The cheapest simulation of a scene that gives some averages as exactly as is wanted.

    The scene with all effects that it has switched on is the truth that errors are counted from. The error is split over effects
    that are left out, nodes along the contacts, tolerances, settling, and the scatter of a mean over a run of finite length; each
    part is measured by short runs of this scene.

    Parameters
    ----------
    scene : Scene or Assembly
        What is simulated; with constant speed and loads. Bearings on a shaft are simplified together.
    want : mapping of str to float
        Wanted relative error by the name of an average of the summary, for instance ``{"torque": 0.02}`` for 2 %. Of bearings
        on a shaft, torque and power_loss are sums; others have the name of their bearing before them: ``left_cage_slip``.
    budget : float, optional
        Most computing time of the run (processor time, s): the most exact choice within it is made, errors weighed by `want`.
    effort : float
        Computing time for the probes, about (processor time, s). More effort tells smaller influences apart.

    Returns
    -------
    Plan
        Scene and options that are ready to run, what each effect gives and costs, and where the answer could be wrong. Print it.

    Raises
    ------
    InputError
        If a name or number cannot be used, or the scene has no constant speed and loads.
    LoadError
        If the bearing cannot carry the load.
    StepError
        If the scene cannot be run.

    Examples
    --------
    >>> import trbdyn as trb
    >>> scene = trb.cases.scene_30310(3000.0, 4930.0)
    >>> proposal = trb.plan(scene, {"torque": 0.05}, effort=2.0)
    >>> proposal.reached
    True
    """
    expect("scene", scene, Scene, Assembly)
    began = clock.process_time()
    wishes = checked(scene, want, budget, effort)
    looker = Looker(wishes)
    seen = looker.look()
    decision = decide(wishes, seen, looker)
    return _proposal(wishes, seen, decision, looker, began)


def _proposal(wishes: Wishes, seen: Seen, decision: Decision, looker: Looker, began: float) -> Plan:
    ground, choice = seen.ground, decision.choice
    given = next((one.probe.rate for one in seen.tried if one.candidate.kind == "as given"), seen.base.rate)
    length = looker.settle + choice.averaging
    settling, statistics, unseen = ground.drift, choice.errors - choice.bounds, decision.unseen
    parts = {
        name: {
            "model and numerics": float(choice.bounds[k] - settling[k] - unseen[k]),
            "settling": float(settling[k]),
            "not seen by a probe": float(unseen[k]),
            "statistics": float(statistics[k]),
        }
        for k, name in enumerate(wishes.names)
    }
    return Plan(
        scene=changed(looker.usual, decision.effects, ground.start),
        accuracy=decision.accuracy,
        duration=length,
        settle=looker.settle,
        save_every=looker.keep.save_every,
        save_groups=looker.keep.groups,
        want=dict(wishes.want),
        promised={name: float(choice.errors[k]) for k, name in enumerate(wishes.names)},
        parts=parts,
        value=dict(ground.value),
        size=dict(ground.size),
        reached=choice.within,
        rows=(
            *seen.rows,
            _row_of_the_usual(seen, decision),
            *(_row(one, wishes, seen, decision) for one in seen.tried),
        ),
        computing_s=choice.cost,
        computing_s_everything=decision.everything,
        computing_s_given=given * length if math.isfinite(given) else math.nan,
        spent_s=clock.process_time() - began,
        budget=wishes.budget,
        warnings=tuple(dict.fromkeys([*seen.notes, *_notes(seen, decision, looker)])),
    )


def _notes(seen: Seen, decision: Decision, looker: Looker) -> list[str]:
    """What the runs could not show."""
    notes = [f"in the probe of the choice: {text}" for text in decision.found.warned]
    follow, creep_time = looker.length.duration, seen.ground.creep_time
    if not creep_time <= follow:
        creep = "an unknown time" if math.isnan(creep_time) else f"{creep_time:.2g} s"
        notes.append(
            f"the probes followed each change for {follow:.2g} s, and the rollers creep within {creep}: an effect that "
            "acts only by this creep, on the whirl of the cage for instance, is not seen"
        )
    return notes


def _row_of_the_usual(seen: Seen, decision: Decision) -> Row:
    numbers = decision.choice.numerics
    said = "taken" if numbers == USUAL else f"taken: {numbers}" if numbers == EXACT else "not needed"
    name = f"{USUAL}, against {TRUE_NODES} and '{TRUE_ACCURACY}'"
    return Row(name, "truth", seen.usual_error, seen.base.rate / seen.truth.rate, said, numbers == USUAL)


def _row(one: Tried, wishes: Wishes, seen: Seen, decision: Decision) -> Row:
    ratio = math.nan if one.probe.failure else one.time_ratio
    chosen = one.candidate in decision.made
    said = _said(one, wishes, seen, decision)
    return Row(one.candidate.name, one.candidate.kind, one.change, ratio, said, chosen)


def _said(one: Tried, wishes: Wishes, seen: Seen, decision: Decision) -> str:
    """What the plan does with a candidate, and why."""
    if one.probe.failure:
        return f"cannot be run: {one.probe.failure}"
    is_effect = one.candidate.kind == "effect"
    taken, kept = ("left out", "kept") if is_effect else ("taken", "not taken")
    if one.candidate in decision.made:
        return taken
    large = [name for name, wish in wishes.want.items() if one.change[name].bound > wish]
    told = [name for name in large if abs(one.change[name].change) > one.change[name].half_width]
    if told:
        return f"{kept}: it matters for {', '.join(told)}"
    if large:
        return f"{kept}: not told apart from chance in {', '.join(large)}"
    if one.candidate.name in decision.rejected:
        return f"{kept}: together with the others the error was larger than the wish"
    if is_effect and one.time_ratio >= 1.0 - seen.least_saving:
        return f"{kept}: it saves no time"
    return f"{kept}: another choice is cheaper"
