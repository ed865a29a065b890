"""What a cage does over speed and axial load, from two starts: a map of classes, with runs that end once they are decided."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, Unpack

import numpy as np

from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown
from trbdyn.extras.maps.whirl import TURNS, CageRuns, numbers_of, speeds_of
from trbdyn.extras.study.answer import Answer
from trbdyn.extras.study.runner import Running
from trbdyn.model.assembly import Assembly, Subject
from trbdyn.model.scene import Scene
from trbdyn.run.options import RunOptions

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True, repr=False)
class CageMap(Answer):
    """What a cage does over speed and load; print it for a table.

    Its picture has a field for each point, coloured by class, with the orbit over the radial play; one map for each start.

    Attributes
    ----------
    data : xarray.Dataset
        Dimensions start, axial_load and speed_rpm, loads ascending, speeds ascending in size. Variables: kind (text), orbit
        (over the radial play), hits (of rollers on the cage, 1/s), impulse (mean of a hit, N s), decided, turns (of the cage),
        message.
    """

    data: xarray.Dataset

    def _draw(self) -> Any:
        from trbdyn.extras.maps.cage_map_picture import draw_map

        return draw_map(self.data)

    def _shown(self) -> Shown:
        speeds = [f"{speed:g} rpm" for speed in self.data["speed_rpm"].values]
        rows = []
        for start in self.data["start"].values:
            for load in self.data["axial_load"].values:
                line = self.data.sel(start=start, axial_load=load)
                told = [
                    _told(str(kind), float(orbit), bool(decided), float(hits))
                    for kind, orbit, decided, hits in zip(
                        *(line[name].values for name in ("kind", "orbit", "decided", "hits")), strict=True
                    )
                ]
                rows.append((str(start), f"{load:g}", *told))
        failed = sorted({str(text) for text in self.data["message"].values.ravel() if text})
        open_runs = int(np.count_nonzero(~self.data["decided"].values)) - int(
            np.count_nonzero(self.data["message"].values)
        )
        notes = ["motion of the cage, its orbit over the radial play, and hits of rollers on it in a second"]
        if open_runs:
            notes.append(f"?: not decided in {float(self.data['turns'].max()):g} turns of the cage ({open_runs} runs)")
        return Shown(
            "Motion of the cage over speed and load",
            tuple(rows),
            ("start", "axial load (N)", *speeds),
            (*notes, *failed),
        )


def _told(kind: str, orbit: float, decided: bool, hits: float) -> str:
    return "failed" if np.isnan(orbit) else f"{kind} {orbit:.2f}{'' if decided else '?'}, {hits:.0f}/s"


def cage_map(
    subject: Subject,
    speeds: Sequence[float],
    axial_loads: Sequence[float],
    *,
    starts: Sequence[Literal["equal", "whirl"]] = ("equal", "whirl"),
    longest: float = TURNS[-1],
    options: RunOptions | None = None,
    **how: Unpack[Running],
) -> CageMap:
    """What the cage of a scene, or those of bearings on a shaft, do at each of some speeds and axial loads, from rest and from a
    large whirl.

    A run ends when it is decided: after 40 turns of the cage where the motion has settled or both starts agree; else after 160 or
    640, as in `whirl_onset`.

    Parameters
    ----------
    subject : Scene or Assembly
        Gives all but speed, axial load and start. Of several cages the one that moves most counts, as in `whirl_onset`.
    speeds : sequence of float
        Speeds of the shaft (rpm), all of one sign, none 0.
    axial_loads : sequence of float
        Axial loads (N); of an assembly forces along its shaft on the centre of mass, while what acts across it stays.
    starts : sequence of {'equal', 'whirl'}
        Starts.
    longest : float
        Turns of the cage of the longest runs (1).
    options : RunOptions, optional
        Accuracy and settings of each run, not its length; 'fast' by default.
    **how
        Folder, executor, workers and progress bar of the runs: `trbdyn.study.Running`.

    Returns
    -------
    CageMap

    Raises
    ------
    InputError
        If an argument cannot be used.

    Examples
    --------
    >>> import trbdyn as trb
    >>> scene = trb.cases.scene_30310(2000.0, 1230.0)
    >>> found = trb.cage_map(scene, [1000.0], [1230.0], starts=["equal"], longest=40.0)
    >>> str(found.data.kind.values[0, 0, 0])
    'stable'
    """
    expect("scene", subject, Scene, Assembly)
    turning, loads = speeds_of(speeds), sorted(numbers_of("axial_loads", axial_loads, "N"))
    runs = CageRuns(subject, starts, options, longest, how)
    points = [(start, speed, load) for start in runs.starts for load in loads for speed in turning]
    runs.add(points)
    places = {
        "start": runs.starts,
        "axial_load": ("axial_load", loads, {"units": "N"}),
        "speed_rpm": ("speed_rpm", turning, {"units": "rpm"}),
    }
    return CageMap(runs.dataset(points, places))
