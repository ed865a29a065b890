"""A search for profiles whose edges press little: designs are judged by half spaces at the equilibria of load cases."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.expected import expect
from trbdyn.errors import InputError, LoadError
from trbdyn.model.bearing import Bearing
from trbdyn.model.scene import Scene
from trbdyn.model.spectrum import Spectrum
from trbdyn.run.contact_pressure import RACES, contacts_of, one_contact
from trbdyn.study.definition import Base
from trbdyn.study.drawn_bearing import belongs_together
from trbdyn.study.optimise import Search

Array = NDArray[np.float64]

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


class EdgeSearch(Search):
    """Designs that were judged so far."""

    def __init__(self, over: Spectrum, *rest: Any) -> None:
        expect("over", over, Spectrum)
        for index, one in enumerate(over.cases):
            expect(f"over.cases.{index}.subject", one.subject, Scene)
        self.over = over
        super().__init__(*rest)
        expect("subject", self.subject, Scene)
        self.cases = [Base.of(one.subject) for one in over.cases]
        self.names = [one.name for one in over.cases]

    def _judged(self, numbers: Sequence[int], length: float) -> tuple[list[dict[str, float]], Array]:
        import xarray

        for field, names in (("want", list(self.want)), ("limits", [name for name, *_ in self.limits])):
            for name in names:
                if name not in NUMBERS:
                    raise InputError.of(field, name, f"must be one of {', '.join(NUMBERS)} for `over`")
        tables, columns = [], []
        for number in numbers:
            rows: dict[str, list[Any]] = {
                name: [] for name in (*NUMBERS, "status", "message", "design", "draw", "length")
            }
            for draw, offset in enumerate(self.offsets):
                said = ""
                try:
                    values = self._of_cases(self._changes(number, offset)[1])
                except (InputError, LoadError) as error:
                    values, said = dict.fromkeys(NUMBERS, np.nan), str(error).splitlines()[0]
                state = {
                    "status": "failed" if said else "done",
                    "message": said,
                    "design": number,
                    "draw": draw,
                    "length": length,
                }
                for name, value in (values | state).items():
                    rows[name].append(value)
            data = xarray.Dataset({name: ("case", np.array(values)) for name, values in rows.items()})
            data = data.set_coords(["design", "draw", "length"])
            self.parts.append(data)
            table, column = self._judge(data)
            tables.append(table)
            columns.append(column)
        return tables, np.array(columns)

    def _of_cases(self, overrides: dict[str, Any]) -> dict[str, float]:
        found = []
        for name, base in zip(self.names, self.cases, strict=True):
            made = overrides | belongs_together(Bearing.model_validate(base.tables["bearing"]), overrides, {}, "")
            scene = base.build(made)[0]
            assert isinstance(scene, Scene)
            try:
                found.append(edge_numbers(scene))
            except LoadError as error:
                raise LoadError(f"load case {name}: {error}") from None
        return {name: max(one[name] for one in found) for name in NUMBERS}
