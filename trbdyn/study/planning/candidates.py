"""What a plan may choose: effects that can be left out, nodes along a contact, and tolerances, one table each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, Literal

from trbdyn.errors import InputError
from trbdyn.model import contact_line

if TYPE_CHECKING:
    from trbdyn.model.assembly import Subject
    from trbdyn.model.effects import Effects

Kind = Literal["effect", "off", "nodes", "tolerances", "as given"]

USUAL_NODES: Final = 16
TRUE_NODES: Final = 32
"""Nodes of the most exact probe."""
NODES: Final = (4, 6, 8, 12)
"""Fewer nodes than the usual ones that are tried."""
USUAL_ACCURACY: Final = "standard"
TRUE_ACCURACY: Final = "reference"


@dataclass(frozen=True)
class Switch:
    """An effect: what the model has without it and with it.

    Attributes
    ----------
    name : str
        Short name.
    without, with_it : mapping
        Fields of `Effects`. Where ``with_it`` is empty, the effect needs numbers that only the user knows.
    needs_films : bool
        Whether it acts only where contacts have films.
    needs_cage : bool
        Whether it acts only where there is a cage.
    """

    name: str
    without: Mapping[str, Any]
    with_it: Mapping[str, Any] = field(default_factory=dict)
    needs_films: bool = False
    needs_cage: bool = False


SWITCHES: Final = (
    Switch("cage", {"bodies": "rollers_and_spacer", "guidance": "rollers"}, {"bodies": "rollers_and_cage"}),
    Switch("tilt and axial motion", {"planar": True}, {"planar": False}),
    Switch("gravity", {"gravity": False}, {"gravity": True}),
    Switch("front rib", {"front_rib": False}, {"front_rib": True}),
    Switch("pocket ends", {"pocket_ends": False}, {"pocket_ends": True}, needs_cage=True),
    Switch("edges of pocket faces", {"pocket_edges": False}, {"pocket_edges": True}, needs_cage=True),
    Switch("boundary friction", {"lubrication": "full_film"}, {"lubrication": "mixed"}, needs_films=True),
    Switch("thermal reduction of films", {"thermal": False}, {"thermal": True}, needs_films=True),
    Switch(
        "rolling resistance",
        {"rolling_resistance": False, "rolling_pressure_force": False},
        {"rolling_resistance": True},
        needs_films=True,
    ),
    Switch(
        "pressure force of the rolling film",
        {"rolling_pressure_force": False},
        {"rolling_pressure_force": True, "rolling_resistance": True},
        needs_films=True,
    ),
    Switch("damping of contacts", {"damping": "off"}, {"damping": "film"}),
    Switch("drag of the oil", {"oil_fill": 0.0}),
    Switch("films in the pockets", {"pocket_film": 0.0}),
    Switch("land that guides the cage", {"guidance": "rollers"}, needs_cage=True),
)


@dataclass(frozen=True)
class Candidate:
    """One thing that a plan may choose.

    Attributes
    ----------
    name : str
        As the table names it.
    kind : {'effect', 'off', 'nodes', 'tolerances', 'as given'}
        An effect that may be left out; one that the scene itself leaves out, which is looked at and stays out; fewer nodes;
        looser tolerances; nodes and tolerances as the scene has them.
    effects : mapping
        Fields of `Effects` that it changes.
    accuracy : str
        Preset of the tolerances.
    """

    name: str
    kind: Kind
    effects: Mapping[str, Any] = field(default_factory=dict)
    accuracy: str = USUAL_ACCURACY


def numerics(nodes: int) -> dict[str, Any]:
    """Effects with a number of Gauss nodes."""
    return {"quadrature": "gauss", "n_slices": nodes}


def candidates(scene: Subject, *, wants_cage: bool) -> list[Candidate]:
    """All candidates of a scene or an assembly, whose bearings are simplified together.

    Parameters
    ----------
    scene : Scene or Assembly
        What is simulated.
    wants_cage : bool
        Whether a wanted average is one of the cage, so that it cannot be left out.
    """
    parts: list[Any] = list(scene.parts.values())
    chosen = []
    for switch in SWITCHES:
        each = [one for one in (_of_switch(switch, part.effects) for part in parts) if one is not None]
        if each and not (switch.name == "cage" and wants_cage):
            chosen.append(next((one for one in each if one.kind == "effect"), each[0]))
    chosen += [Candidate(f"{nodes} nodes", "nodes", numerics(nodes)) for nodes in NODES]
    chosen.append(Candidate("tolerances 'fast'", "tolerances", accuracy="fast"))
    given, *others = [{"quadrature": one.effects.quadrature, "n_slices": contact_line.nodes(one)} for one in parts]
    if given != numerics(USUAL_NODES) and all(other == given for other in others):
        chosen.append(Candidate(f"{given['n_slices']} {given['quadrature']} nodes, as given", "as given", given))
    return chosen


def _of_switch(switch: Switch, effects: Effects) -> Candidate | None:
    """Without an effect that is on, or with one that is off; None where it cannot act, or its numbers are not known."""
    if (switch.needs_films and not effects.films) or (switch.needs_cage and not effects.has_cage):
        return None
    is_off = all(getattr(effects, name) == value for name, value in switch.without.items())
    is_off |= "bodies" in switch.without and not effects.has_cage
    if not is_off:
        return None if _same(effects, switch.without) else Candidate(switch.name, "effect", switch.without)
    return Candidate(switch.name, "off", switch.with_it) if switch.with_it else None


def _same(effects: Effects, changes: Mapping[str, Any]) -> bool:
    try:
        return effects.replace(**changes) == effects
    except InputError:
        return True
