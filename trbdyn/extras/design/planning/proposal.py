"""What a plan proposes: a scene and options that are ready to run, and the bill."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from trbdyn.base.shown import Shown
from trbdyn.extras.design.planning.averaged import Records
from trbdyn.extras.design.planning.probes import Influence
from trbdyn.extras.study.answer import Answer
from trbdyn.model import contact_line
from trbdyn.run.options import RunOptions
from trbdyn.run.simulation import Simulation

if TYPE_CHECKING:
    from trbdyn.model.assembly import Subject
    from trbdyn.results.assembly import AssemblyResult
    from trbdyn.results.result import Result


@dataclass(frozen=True)
class Row:
    """An effect, or a choice of nodes or tolerances, as a plan saw it.

    Attributes
    ----------
    name : str
        Its name.
    kind : {'effect', 'nodes', 'tolerances', 'as given', 'truth', 'start'}
        An effect that may be left out; fewer nodes; looser tolerances; nodes and tolerances as the scene has them; the usual
        nodes and tolerances against the most exact probe. 'start': another start.
    influence : dict of str to Influence
        What it changes in each wanted average.
    time_ratio : float
        Computing time with the change over that without it; nan where it could not be run.
    decision : str
        What the plan does with it, and why.
    chosen : bool
        Whether the plan makes this simplification.
    """

    name: str
    kind: str
    influence: Mapping[str, Influence]
    time_ratio: float
    decision: str
    chosen: bool = False


@dataclass(frozen=True, repr=False)
class Plan(Answer):
    """The cheapest simulation of a scene that is as exact as was wanted, as made by `trbdyn.plan`.

    Its picture shows what each effect gives and costs.

    Attributes
    ----------
    scene : Scene or Assembly
        What to simulate: the scene with the chosen effects and nodes. It starts from the state that a run with everything on has
        reached from the start that was given, as the probes did: what they have shown holds from there.
    accuracy : str
        Preset of the tolerances.
    duration : float
        Length of the run (s).
    settle : float
        Part of it before the averaging (s).
    save_every : float
        Time between records (s).
    save_groups : tuple of str
        Groups of records: those that the wanted averages need.
    want : dict of str to float
        Wanted relative error of each average.
    promised : dict of str to float
        Relative error that is expected not to be exceeded in 95 of 100 cases; as far as `warnings` does not except it. Errors are
        shares of `size`.
    parts : dict of str to dict
        Where it comes from: of each average, 'model and numerics', 'settling', 'not seen by a probe' and 'statistics'.
    value : dict of str to float
        The averages with everything on, from the probes.
    size : dict of str to float
        What their errors are shares of: the size of the value, or the least one that means anything where it is smaller.
    reached : bool
        Whether every promise is within the wish, and the run within the budget.
    rows : tuple of Row
        What each effect and each choice gives and costs.
    computing_s, computing_s_everything, computing_s_given : float
        Expected processor time of the run (s); of one that is as exact with all effects, 32 nodes and the preset 'reference';
        and of one as long as this with the scene as it was given and the preset 'standard'.
    spent_s : float
        Processor time that the probes took (s).
    budget : float or None
        Most processor time that was allowed for the run (s).
    warnings : tuple of str
        Where the answer could be wrong.
    """

    scene: Subject
    accuracy: str
    duration: float
    settle: float
    save_every: float
    save_groups: tuple[Any, ...]
    want: dict[str, float]
    promised: dict[str, float]
    parts: dict[str, dict[str, float]]
    value: dict[str, float]
    size: dict[str, float]
    reached: bool
    rows: tuple[Row, ...]
    computing_s: float
    computing_s_everything: float
    computing_s_given: float
    spent_s: float
    budget: float | None
    warnings: tuple[str, ...]

    @property
    def options(self) -> RunOptions:
        """How to run it."""
        return RunOptions(
            accuracy=self.accuracy, duration=self.duration, save_every=self.save_every, save_groups=self.save_groups
        )

    @property
    def left_out(self) -> tuple[str, ...]:
        """Effects that the plan leaves out."""
        return tuple(row.name for row in self.rows if row.chosen and row.kind == "effect")

    def run(self, **arguments: Any) -> Any:
        """Run it; average over the records after `settle`.

        Parameters
        ----------
        **arguments
            Those of `Simulation.run`, for instance `output`, or `save_groups` to keep more than the plan needs.
        """
        kept = {name: getattr(self, name) for name in ("duration", "save_every", "save_groups")}
        return Simulation(self.scene, accuracy=self.accuracy).run(**kept | arguments)

    def averages(self, result: Result | AssemblyResult) -> dict[str, float]:
        """The wanted averages of a run of this plan, over the part that it was made for.

        Parameters
        ----------
        result : Result or AssemblyResult
            What `run` gave.
        """
        records = Records.of(self.scene, result)
        found = records.window(float(records.time[0]) + self.settle).averages()
        return {name: float(found[name]) for name in self.want}

    def _draw(self) -> Any:
        from trbdyn.extras.design.planning.picture import draw

        return draw(self)

    def _shown(self) -> Shown:
        asked = tuple(
            (
                name,
                f"{self.value[name]:.4g}",
                f"{100.0 * wish:.3g} %",
                f"{100.0 * self.promised[name]:.2g} %{self._of_what(name)}",
                ", ".join(f"{part} {100.0 * size:.2g} %" for part, size in self.parts[name].items()),
            )
            for name, wish in self.want.items()
        )
        more = "This is more than was wanted, or dearer than the budget: it is the most exact that was found."
        notes = [more] * (not self.reached) + _run_lines(self) + [f"Note: {text}" for text in self.warnings]
        return Shown(
            f"Plan: {', '.join(self.want)}",
            asked,
            ("average", "value", "wanted within", "promised within", "of which"),
            tuple(notes),
            (_simplifications(self),),
        )

    def _of_what(self, name: str) -> str:
        """What the percents of an average are of, where its value is too small to mean anything."""
        least = self.size[name]
        return f" of {least:g}, as a smaller {name} means nothing" if least > abs(self.value[name]) else ""

    def __str__(self) -> str:
        """With the table of simplifications, which other answers leave to a notebook."""
        shown = self._shown()
        return "\n\n".join(part.text(names=True) for part in (shown, *shown.parts))


def _run_lines(plan: Plan) -> list[str]:
    nodes, kind = contact_line.nodes(plan.scene.part), plan.scene.part.effects.quadrature
    began = (plan.scene.start or plan.scene.part.start).time
    said = ", ".join(plan.left_out) or "nothing"
    return [
        f"run: {plan.duration:.3g} s of bearing time from the state that the first run reached at {began:.3g} s, "
        f"averages after {plan.settle:.3g} s",
        f"effects left out: {said}; {nodes} {kind} nodes, tolerances '{plan.accuracy}'",
        f"computing time: about {plan.computing_s:.2g} s; as long with the scene as given {plan.computing_s_given:.2g} s; "
        f"as exact with all effects, 32 nodes and 'reference' {plan.computing_s_everything:.2g} s",
        f"the probes took {plan.spent_s:.2g} s",
    ]


def _simplifications(plan: Plan) -> Shown:
    """Influence on each average, time, and what was decided."""
    rows = []
    for row in plan.rows:
        changes = [words(row.influence.get(name)) for name in plan.want]
        ratio = "-" if math.isnan(row.time_ratio) else f"x {row.time_ratio:.2f}"
        rows.append((_name(row), *changes, ratio, row.decision))
    return Shown(
        "What each simplification changes and saves", tuple(rows), ("simplification", *plan.want, "time", "decision")
    )


def _name(row: Row) -> str:
    return f"without {row.name}" if row.kind == "effect" else row.name


def words(found: Influence | None) -> str:
    """An influence in percent."""
    if found is None or not math.isfinite(found.change):
        return "-"
    return f"{_digits(found.change, '+')} ± {_digits(found.half_width)} %"


def _digits(share: float, sign: str = "") -> str:
    """A share in percent with two digits, without an exponent."""
    percent = 100.0 * share
    return f"{percent:{sign}.0f}" if abs(percent) >= 10.0 else f"{percent:{sign}.2g}"
