"""Preload diagram of an assembly: axial loads of its bearings over the axial place of the shaft."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown, Tabled
from trbdyn.base.validation import number_of
from trbdyn.model.assembly import Assembly
from trbdyn.statics.assembly import ShaftEquilibrium, equilibrium

Array = NDArray[np.float64]

POINTS: Final = 31
BEYOND: Final = 10e-6
"""How far the diagram goes beyond half of the preload on either side (m)."""


@dataclass(frozen=True, eq=False, repr=False)
class PreloadDiagram(Tabled):
    """Axial loads over the axial displacement of the shaft.

    Attributes
    ----------
    assembly : Assembly
        The assembly; its loads act, all but those along the axis.
    displacement : ndarray, shape (n,)
        Axial displacement of the shaft to the right (m).
    loads : dict of str to ndarray, shape (n,)
        Axial load of each bearing, towards the small ends of its rollers (N), by its name.
    axial_force : ndarray, shape (n,)
        Axial force on the shaft to the right that holds it there (N).
    preload : ShaftEquilibrium
        Where no axial force acts.
    """

    assembly: Assembly
    displacement: Array
    loads: dict[str, Array]
    axial_force: Array
    preload: ShaftEquilibrium

    def _shown(self) -> Shown:
        rows = tuple(
            (f"{1e6 * z:.4g}", f"{force:.5g}", *(f"{load[k]:.5g}" for load in self.loads.values()))
            for k, (z, force) in enumerate(zip(self.displacement, self.axial_force, strict=True))
        )
        head = ("displacement um", "axial force N", *(f"{name} N" for name in self.loads))
        return Shown(f"Preload diagram of {self.assembly}", (head, *rows), head=head)


def preload_diagram(
    assembly: Assembly, displacements: Sequence[float] | None = None, *, time: float = 0.0
) -> PreloadDiagram:
    """Axial loads of the bearings over the axial displacement of the shaft: how a preload shares out an axial force.

    Parameters
    ----------
    assembly : Assembly
        The assembly. Radial loads and moments act at every point of the diagram, axial forces do not.
    displacements : sequence of float, optional
        Axial displacements of the shaft (m); by default evenly spaced around the place without axial force, so far that either
        side is unloaded.
    time : float
        Time of speed and loads (s).

    Raises
    ------
    InputError
        If a displacement is not allowed.
    LoadError
        If the bearings cannot carry the radial loads.

    Examples
    --------
    >>> import trbdyn as trb
    >>> shaft = trb.Shaft.hollow_cylinder(mass=6.0, outer_diameter=0.05, length=0.3)
    >>> pair = trb.Assembly.pair(trb.cases.rig_30310(), "back to back", spread=0.15, end_play=-40e-6, shaft=shaft, speed_rpm=3000)
    >>> diagram = trb.preload_diagram(pair, [0.0, 10e-6])
    >>> [round(float(load[1]) / 1e3, 1) for load in diagram.loads.values()]
    [5.3, 1.5]
    """
    expect("assembly", assembly, Assembly)
    loads = tuple(load.replace(force=(*load.force[:2], 0.0)) for load in assembly.loads)
    across = assembly.replace(loads=loads, gravity=(*assembly.gravity[:2], 0.0))
    middle = equilibrium(across, time=time)
    if displacements is None:
        centre, play = float(middle.displacement()[2]), sum(abs(one.end_play) for one in assembly.bearings)
        half = 0.5 * play + BEYOND
        displacements = np.linspace(centre - half, centre + half, POINTS).tolist()
    places = np.array([number_of("displacements", place) for place in displacements])
    found = [equilibrium(across, time=time, axial_displacement=float(place)) for place in places]
    return PreloadDiagram(
        assembly=assembly,
        displacement=places,
        loads={name: np.array([one[name].axial_load for one in found]) for name in assembly.names},
        axial_force=np.array([one.axial_force for one in found]),
        preload=middle,
    )
