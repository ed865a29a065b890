"""What designs of profiles are judged by where nothing is run: pressures of half spaces at the equilibria of load cases."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Final

from trbdyn.base.expected import expect
from trbdyn.errors import InputError, LoadError
from trbdyn.extras.study.definition import Base
from trbdyn.extras.study.drawn_bearing import belongs_together
from trbdyn.model.bearing import Bearing
from trbdyn.model.scene import Scene
from trbdyn.model.spectrum import Spectrum
from trbdyn.run.contact_pressure import RACES, contacts_of, one_contact

NUMBERS: Final = ("edge_pressure", "largest_pressure", "slice_edge_pressure", "slice_pressure")
"""What a design is judged by (Pa), each the largest over all load cases."""


def edge_numbers(scene: Scene) -> dict[str, float]:
    """The numbers of one load case: of each raceway the contacts with the largest load, and those whose slices press most
    at the small and at the large end.
    """
    _, contacts, time = contacts_of(scene, None)
    found = []
    for raceway, race in RACES.items():
        loads = contacts["raceway_load"][race].sum(axis=-1)
        ends = contacts["raceway_pressure"][race] * (contacts["raceway_load"][race] > 0.0)
        count = int((contacts["raceway_weight"][race] > 0.0).sum(axis=-1).max())
        chosen = {int(loads.argmax()), int(ends[:, 0].argmax()), int(ends[:, count - 1].argmax())}
        for roller in sorted(chosen):
            if loads[roller] > 0.0:
                found.append(one_contact(scene, contacts, raceway, roller, time))
    return {
        "edge_pressure": max(max(one.edges[0][0], one.edges[1][0]) for one in found),
        "largest_pressure": max(one.largest for one in found),
        "slice_edge_pressure": max(max(one.edges[0][1], one.edges[1][1]) for one in found),
        "slice_pressure": max(float(one.slice_pressure.max()) for one in found),
    }


class EdgeCases:
    """The load cases of a spectrum of one bearing, ready for changes of a design."""

    def __init__(self, over: Spectrum) -> None:
        expect("over", over, Spectrum)
        for index, one in enumerate(over.cases):
            expect(f"over.cases.{index}.subject", one.subject, Scene)
        self._bases = {one.name: Base.of(one.subject) for one in over.cases}

    def check(self, field: str, names: Iterable[str]) -> None:
        """Refuse names that no design is judged by."""
        for name in names:
            if name not in NUMBERS:
                raise InputError.of(field, name, f"must be one of {', '.join(NUMBERS)} where `over` is given")

    def numbers(self, overrides: Mapping[str, Any]) -> dict[str, float]:
        """The largest of each number over all cases with a design's changes."""
        found = []
        for name, base in self._bases.items():
            made = {**overrides, **belongs_together(Bearing.model_validate(base.tables["bearing"]), overrides, {}, "")}
            scene = base.build(made)[0]
            assert isinstance(scene, Scene)
            try:
                found.append(edge_numbers(scene))
            except LoadError as error:
                raise LoadError(f"load case {name}: {error}") from None
        return {name: max(one[name] for one in found) for name in NUMBERS}
