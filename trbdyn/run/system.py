"""What a simulation consists of: its bodies, and the pairs of them that act on each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from trbdyn import _core
from trbdyn.base.shown import Shown, Tabled

ROLLER_COORDINATES: Final = 11
"""Coordinates of a roller in the state, without its spin angle."""


@dataclass(frozen=True)
class Body:
    """A body, or all rollers together.

    Attributes
    ----------
    name : str
        What it is.
    kind : str
        How it moves.
    coordinates : int
        Numbers in the state that say where it is and how it moves; 0 where it is placed.
    """

    name: str
    kind: str
    coordinates: int


@dataclass(frozen=True)
class Pair:
    """Two bodies that act on each other.

    Attributes
    ----------
    name : str
        As its quantities in results begin.
    text : str
        What touches what.
    surfaces : tuple of str
        The two surfaces.
    bodies : tuple of str
        The bodies that have them.
    on : bool
        Whether it is simulated; a pair that is off is not evaluated and costs nothing.
    """

    name: str
    text: str
    surfaces: tuple[str, str]
    bodies: tuple[str, str]
    on: bool


@dataclass(frozen=True, eq=False, repr=False)
class System(Tabled):
    """The bodies and pairs of a simulation.

    Attributes
    ----------
    bodies : tuple of Body
        Rollers first.
    pairs : tuple of Pair
        Those that are off as well.
    """

    bodies: tuple[Body, ...]
    pairs: tuple[Pair, ...]

    def _shown(self) -> Shown:
        size = sum(body.coordinates for body in self.bodies)
        rows = [
            (body.name, f"{body.coordinates} coordinates" if body.coordinates else "placed", body.kind)
            for body in self.bodies
        ]
        rows += [(pair.name, "on" if pair.on else "off", pair.text) for pair in self.pairs]
        on = sum(pair.on for pair in self.pairs)
        return Shown(
            f"{size} coordinates; {on} of {len(self.pairs)} pairs are on",
            tuple(rows),
            head=("name", "state", "what it is"),
            notes=("A pair that is off is a row that nothing evaluates: it costs no time.",),
        )


def system_of(model: _core.Model) -> System:
    """The system of a core's model.

    Parameters
    ----------
    model : _core.Model
        The model.
    """
    table = model.system_table()
    count = {name: shape[0] for name, _, shape in model.state_layout() if name == "spin_angle"}["spin_angle"]
    owner = dict(table["surfaces"])
    bodies = [Body("rollers", f"{count} rigid bodies", count * ROLLER_COORDINATES)]
    bodies += [Body(*row) for row in table["bodies"]]
    pairs = [Pair(name, text, (a, b), (owner[a], owner[b]), on) for name, text, a, b, on in table["pairs"]]
    return System(tuple(bodies), tuple(pairs))
