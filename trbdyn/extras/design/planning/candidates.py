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

Kind = Literal["effect", "nodes", "tolerances", "as given"]

USUAL_NODES: Final = 16
TRUE_NODES: Final = 32
"""Nodes of the most exact probe."""
NODES: Final = (4, 6, 8, 12)
"""Fewer nodes than the usual ones that are tried."""
USUAL_ACCURACY: Final = "standard"
TRUE_ACCURACY: Final = "reference"


@dataclass(frozen=True)
class Switch:
    """An effect that may be left out."""

    name: str
    without: Mapping[str, Any]  # fields of `Effects` of a model without it
    needs_films: bool = False  # acts only where contacts have films
    needs_cage: bool = False  # acts only where there is a cage


SWITCHES: Final = (
    Switch("cage", {"bodies": "rollers_and_spacer", "guidance": "rollers"}),
    Switch("tilt and axial motion", {"planar": True}),
    Switch("gravity", {"gravity": False}),
    Switch("front rib", {"front_rib": False}),
    Switch("pocket ends", {"pocket_ends": False}, needs_cage=True),
    Switch("edges of pocket faces", {"pocket_edges": False}, needs_cage=True),
    Switch("boundary friction", {"lubrication": "full_film"}, needs_films=True),
    Switch("thermal reduction of films", {"thermal": False}, needs_films=True),
    Switch(
        "rolling resistance",
        {"rolling_resistance": False, "rolling_pressure_force": False},
        needs_films=True,
    ),
    Switch(
        "pressure force of the rolling film",
        {"rolling_pressure_force": False},
        needs_films=True,
    ),
    Switch("damping of contacts", {"damping": "off"}),
    Switch("drag of the oil", {"oil_fill": 0.0}),
    Switch("films in the pockets", {"pocket_film": 0.0}),
    Switch("land that guides the cage", {"guidance": "rollers"}, needs_cage=True),
)


@dataclass(frozen=True)
class Candidate:
    """One thing that a plan may choose: an effect that may be left out; fewer nodes; looser tolerances; nodes and tolerances as
    the scene has them.
    """

    name: str  # as the table names it
    kind: Kind
    effects: Mapping[str, Any] = field(default_factory=dict)  # fields of `Effects` that it changes
    accuracy: str = USUAL_ACCURACY  # preset of the tolerances


def numerics(nodes: int) -> dict[str, Any]:
    """Effects with a number of Gauss nodes."""
    return {"quadrature": "gauss", "n_slices": nodes}


def candidates(scene: Subject, *, wants_cage: bool) -> list[Candidate]:
    """All candidates of a scene, or of an assembly, whose bearings are simplified together. Where a wanted average is one of
    the cage, this cannot be left out.
    """
    parts: list[Any] = list(scene.parts.values())
    chosen = [
        Candidate(switch.name, "effect", switch.without)
        for switch in SWITCHES
        if any(_acts(switch, part.effects) for part in parts) and not (switch.name == "cage" and wants_cage)
    ]
    chosen += [Candidate(f"{nodes} nodes", "nodes", numerics(nodes)) for nodes in NODES]
    chosen.append(Candidate("tolerances 'fast'", "tolerances", accuracy="fast"))
    given, *others = [{"quadrature": one.effects.quadrature, "n_slices": contact_line.nodes(one)} for one in parts]
    if given != numerics(USUAL_NODES) and all(other == given for other in others):
        chosen.append(Candidate(f"{given['n_slices']} {given['quadrature']} nodes, as given", "as given", given))
    return chosen


def _acts(switch: Switch, effects: Effects) -> bool:
    """Whether the effect is on, and the model has what it acts on."""
    if (switch.needs_films and not effects.films) or (switch.needs_cage and not effects.has_cage):
        return False
    if "bodies" in switch.without and not effects.has_cage:
        return False
    try:
        return effects.replace(**switch.without) != effects
    except InputError:
        return False
