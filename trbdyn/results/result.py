"""The result of a run: its records, and what engineers read from them."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.shown import Displayed, Shown
from trbdyn.errors import FileError
from trbdyn.results import numbers
from trbdyn.results.records import Records
from trbdyn.results.summary import Summary, summary
from trbdyn.results.to_xarray import dataset

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]

SHOWN_RECORDS: Final = 20_000
"""Most records of a result whose numbers a notebook shows unasked: they are computed from all of them."""


class Result(Records, Displayed):
    """Result of a run.

    Every recorded field is an attribute: a read-only float64 array with time as its first axis, in SI units
    (``result.cage_position`` has shape (T, 3)); ``result.fields`` lists them with their units and texts. A result that
    was loaded reads a field from its file when it is first used.

    Parameters
    ----------
    source : Source
        Where the fields come from.
    info : RunInfo
        Settings, length and messages of the run.
    scene : Scene, optional
        The scene; by default it is made from ``info.scene`` when first asked for.
    """

    def __repr__(self) -> str:
        state = "success" if self.success else "failed"
        return f"<Result: {state}, {len(self)} records, groups {', '.join(self.groups)}: {self.message}>"

    def _shown(self) -> Shown:
        rows: list[tuple[str, ...]] = [
            ("how it ended", self.message),
            ("records", f"{len(self)}"),
            ("groups of fields", ", ".join(self.groups)),
        ]
        rows += [("warning", text) for text in self.warnings]
        try:
            parts = [replace(self.scene._shown(), title=f"scene: {self.scene.title}")]
        except FileError as error:
            parts = [Shown("scene", notes=(str(error),))]
        if len(self) <= SHOWN_RECORDS:
            shown = self.summary()._shown()
            first = {row.name for row in numbers.rows("result")}
            rows += [row[:3] for row in shown.rows if len(row) == 4 and row[3] in first]
            parts.insert(0, replace(shown, title="all numbers: result.summary()"))
        else:
            parts.insert(0, Shown("numbers", notes=("result.summary() computes them from all records.",)))
        title = f"Result: {'success' if self.success else 'failed'}"
        return Shown(title, tuple(rows), ("quantity", "value", "unit"), parts=tuple(parts))

    def summary(self) -> Summary:
        """The numbers an engineer asks for first: a dictionary that prints as a table (see `trbdyn.results.summary`)."""
        with self._source.held_open():
            return summary(self)

    def numbers(self) -> dict[str, Any]:
        """The entries of `summary`, with those of its tables as ``table_entry``."""
        return numbers.of_table(self.summary())

    @property
    def overview(self) -> str:
        """The summary as a table."""
        return str(self.summary())

    def to_xarray(self) -> xarray.Dataset:
        """Every recorded field in an xarray Dataset.

        Returns
        -------
        xarray.Dataset
            Dimensions time, roller, xyz, xy, wxyz and slot; attributes ``units`` and ``long_name`` as xarray's plots
            use them. The numbers of the summary are attributes of the dataset.
        """
        return dataset(self)

    def export(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
        """Write the records for another program; the ending of the file's name says for which.

        Parameters
        ----------
        path : path-like
            ``NAME.csv``: a table with a row for each record. ``NAME.mat``: MATLAB. ``NAME.vtkhdf``: ParaView from 5.12 on;
            centres of rollers and cage that move in time, with every number of a roller and the forces of the raceways on it.
        overwrite : bool
            Replace a file that is there; never the file of this result.

        Returns
        -------
        Path
            The file.

        Raises
        ------
        InputError
            If the ending is another one, or VTK lacks a recorded group.
        FileError
            If the file is there and shall not be replaced, or cannot be written.

        Examples
        --------
        >>> import tempfile, trbdyn as trb
        >>> result = trb.Simulation(trb.cases.scene_30310(3000.0, 4930.0)).run(revolutions=0.1)
        >>> path = result.export(tempfile.mkdtemp() + "/run.csv")
        >>> path.read_text().startswith("time [s],")
        True
        """
        from trbdyn.results.export import export

        return export(self, path, overwrite=overwrite)


def load_bearing(path: str | os.PathLike[str], bearing: str = "") -> Result:
    """The result of a bearing in the file of several; without a name that in a file of one bearing."""
    from trbdyn.results.file_source import FileSource

    source = FileSource(path, bearing)
    return Result(source, source.info)
