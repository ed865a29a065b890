"""Which of the estimated inputs matter for a chosen result: each is moved through its band, alone, and the runs are
compared.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from trbdyn.errors import InputError, LoadError, StepError, unknown_name
from trbdyn.model.estimated import Estimated
from trbdyn.model.scene import Scene, Start
from trbdyn.run.simulation import Simulation

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing
    from trbdyn.results.result import Result


@dataclass(frozen=True)
class Influence:
    """What an estimated input does to the chosen result.

    Attributes
    ----------
    estimated : Estimated
        The input with its band.
    at_low, at_high : float or None
        The result with the input at the ends of its band; None where such a bearing cannot be built or run.
    span : float
        Largest difference of the result from its value with the estimate, in the result's unit.
    told_apart : bool
        Whether the span is larger than the scatter of the result itself.
    note : str
        Why an end of the band could not be run; empty if both could.
    """

    estimated: Estimated
    at_low: float | None
    at_high: float | None
    span: float
    told_apart: bool
    note: str = ""


@dataclass(frozen=True)
class Sensitivity:
    """Influence of each estimated input on a result, the largest first.

    Attributes
    ----------
    quantity : str
        Name of the result.
    value : float
        The result with all estimates as they are.
    scatter : float
        How far the result moves by itself: its change when nothing but the start differs.
    influences : tuple of Influence
        One an input.
    """

    quantity: str
    value: float
    scatter: float
    influences: tuple[Influence, ...]

    def __str__(self) -> str:
        lines = [f"{self.quantity} = {self.value:.4g}; it moves by {self.scatter:.2g} by itself"]
        width = max((len(entry.estimated.path) for entry in self.influences), default=0)
        for entry in self.influences:
            ends = " to ".join("not possible" if end is None else f"{end:.4g}" for end in (entry.at_low, entry.at_high))
            mark = "" if entry.told_apart else "  (not told apart from scatter)"
            share = f"{100.0 * entry.span / abs(self.value):6.1f} %" if self.value else f"{entry.span:.3g}"
            lines.append(f"{entry.estimated.path:<{width}}  {share}  {ends}{mark}")
        return "\n".join(lines)


def sensitivity(
    scene: Scene,
    quantity: str | Callable[[Result], float] = "torque",
    *,
    revolutions: float = 5.0,
    accuracy: str = "fast",
    paths: Sequence[str] | None = None,
) -> Sensitivity:
    """Which estimated inputs of the scene's bearing matter for a result.

    Every estimate (`Bearing.estimated`) is put to the low and the high end of its band, alone, and a short run is made
    for each end. A cage that collides is chaotic, so a result moves a little whatever is changed: this scatter is
    measured by a run that starts otherwise, and smaller influences are marked as not told apart.

    Parameters
    ----------
    scene : Scene
        What is simulated; its bearing has estimates.
    quantity : str or callable
        Name of an entry of `Result.summary`, or a function that gives a number for a result.
    revolutions : float
        Turns of the shaft of each run.
    accuracy : {'fast', 'standard', 'reference'}
        Preset of the tolerances.
    paths : sequence of str, optional
        Only these inputs; all estimates by default.

    Returns
    -------
    Sensitivity
        Print it for a table.

    Raises
    ------
    InputError
        If the bearing has no estimates, a name is unknown, or the result is no number.

    Examples
    --------
    >>> import trbdyn as trb
    >>> bearing = trb.Bearing.from_catalogue(bore=0.050, outside=0.110, width=0.02925, C=125e3, e=0.35, name="30310")
    >>> scene = trb.Scene(bearing, speed_rpm=2000, axial_load=3000.0)
    >>> found = trb.sensitivity(scene, "outer_load_mean", revolutions=0.5, paths=["cup_half_angle_deg", "cage.mass"])
    >>> found.influences[0].estimated.path
    'cup_half_angle_deg'
    """
    chosen = _chosen(scene.bearing, paths)
    name = quantity if isinstance(quantity, str) else getattr(quantity, "__name__", "result")

    def measured(run_scene: Scene) -> float:
        return _number(Simulation(run_scene, accuracy=accuracy).run(revolutions=revolutions), quantity, name)

    value = measured(scene)
    scatter = abs(measured(scene.replace(start=_other_start(scene))) - value)
    influences = [_influence(scene, entry, value, scatter, measured) for entry in chosen]
    influences.sort(key=lambda entry: -entry.span)
    return Sensitivity(name, value, scatter, tuple(influences))


def _chosen(bearing: Bearing, paths: Sequence[str] | None) -> list[Estimated]:
    known = {entry.path: entry for entry in bearing.estimated}
    if not known:
        raise InputError.of(
            "scene", bearing.name, "must have a bearing with estimates, as Bearing.from_catalogue makes it"
        )
    for path in paths or ():
        if path not in known:
            raise InputError.of("paths", path, unknown_name(path, known))
    return list(known.values()) if paths is None else [known[path] for path in paths]


def _number(result: Result, quantity: str | Callable[[Result], float], name: str) -> float:
    if isinstance(quantity, str):
        values = result.summary()
        numbers = [
            key for key, value in values.items() if isinstance(value, int | float) and not isinstance(value, bool)
        ]
        if quantity not in numbers:
            raise InputError.of("quantity", quantity, unknown_name(quantity, numbers))
        return float(values[quantity])
    found: Any = quantity(result)
    try:
        return float(found)
    except (TypeError, ValueError):
        raise InputError.of("quantity", name, f"must give a number, not {found!r}") from None


def _other_start(scene: Scene) -> Any:
    start = scene.start
    if start.kind == "whirl":
        return start.replace(direction_deg=start.direction_deg + 37.0)
    if start.kind == "unequal":
        return start.replace(seed=start.seed + 1)
    return Start.unequal(1, spread=0.3)


def _influence(
    scene: Scene, entry: Estimated, value: float, scatter: float, measured: Callable[[Scene], float]
) -> Influence:
    ends: list[float | None] = []
    notes = []
    for target in (entry.low, entry.high):
        if target == entry.value:
            ends.append(value)
            continue
        try:
            ends.append(measured(scene.replace(bearing=changed(scene.bearing, entry.path, target))))
        except (InputError, LoadError, StepError) as error:
            ends.append(None)
            notes.append(f"{target:.4g}: {str(error).splitlines()[0]}")
    span = max((abs(end - value) for end in ends if end is not None), default=0.0)
    return Influence(entry, ends[0], ends[1], span, span > scatter, "; ".join(notes))


def changed(bearing: Bearing, path: str, value: float) -> Bearing:
    """The bearing with one input changed, by its path; a longer contact line makes the roller longer by as much.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    path : str
        For instance ``roller.diameter``.
    value : float
        The new value.

    Raises
    ------
    InputError
        If there is no such input, or the bearing cannot be built with it.
    """
    *parents, last = path.split(".")
    models: list[Any] = [bearing]
    for part in parents:
        models.append(getattr(models[-1], part, None))
    if models[-1] is None or last not in type(models[-1]).model_fields:
        raise InputError.of("path", path, "must be the path of an input, for instance roller.diameter")
    changes: dict[str, Any] = {last: int(value) if last == "n_rollers" else value}
    if path == "roller.effective_length":
        changes["total_length"] = bearing.roller.total_length + value - bearing.roller.effective_length
    new = models.pop().replace(**changes)
    for model, part in zip(reversed(models), reversed(parents), strict=True):
        new = model.replace(**{part: new})
    found: Bearing = new
    return found
