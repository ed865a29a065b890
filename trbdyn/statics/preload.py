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
from trbdyn.model.motion import value_at
from trbdyn.model.on_shaft import ShaftLoad
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
        The assembly; its loads act, all but the forces along its axis, whose moments act as well.
    displacement : ndarray, shape (n,)
        Axial displacement of the shaft to the right (m).
    loads : dict of str to ndarray, shape (n,)
        Axial load of each bearing, towards the small ends of its rollers (N), by its name.
    axial_force : ndarray, shape (n,)
        Axial force on the shaft to the right that holds it there (N).
    preload : ShaftEquilibrium
        Where no axial force acts; the moments of axial forces that act off the axis do.
    operating : ShaftEquilibrium
        Where the axial forces of the assembly act as well: its equilibrium. The curves go through its loads.
    """

    assembly: Assembly
    displacement: Array
    loads: dict[str, Array]
    axial_force: Array
    preload: ShaftEquilibrium
    operating: ShaftEquilibrium

    def _shown(self) -> Shown:
        rows = tuple(
            (f"{1e6 * z:.4g}", f"{force:.5g}", *(f"{load[k]:.5g}" for load in self.loads.values()))
            for k, (z, force) in enumerate(zip(self.displacement, self.axial_force, strict=True))
        )
        head = ("displacement um", "axial force N", *(f"{name} N" for name in self.loads))
        loads = ", ".join(f"{one.name} {one.axial_load:.5g} N" for one in self.operating.bearings)
        note = f"Operating point, with the axial forces of the loads: {1e6 * self.operating.displacement()[2]:.4g} um, {loads}."
        return Shown(f"Preload diagram of {self.assembly}", (head, *rows), head=head, notes=(note,))


def preload_diagram(
    assembly: Assembly, displacements: Sequence[float] | None = None, *, time: float = 0.0
) -> PreloadDiagram:
    """Axial loads of the bearings over the axial displacement of the shaft: how a preload shares out an axial force.

    Parameters
    ----------
    assembly : Assembly
        The assembly. Radial loads and moments act at every point of the diagram, also the moments of axial forces off the axis,
        as those of a helical gear; axial forces themselves do not.
    displacements : sequence of float, optional
        Axial displacements of the shaft (m); by default evenly spaced around the place without axial force, so far that either
        side is unloaded, and up to the operating point.
    time : float
        Time of speed and loads (s).

    Raises
    ------
    InputError
        If a displacement is not allowed.
    LoadError
        If the bearings cannot carry the loads.

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
    loads = tuple(_without_thrust(load, time) for load in assembly.loads)
    across = assembly.replace(loads=loads, gravity=(*assembly.gravity[:2], 0.0))
    middle, operating = equilibrium(across, time=time), equilibrium(assembly, time=time)
    if displacements is None:
        centre, works = (float(one.displacement()[2]) for one in (middle, operating))
        half = 0.5 * sum(abs(one.end_play) for one in assembly.bearings) + BEYOND
        displacements = np.linspace(min(centre - half, works), max(centre + half, works), POINTS).tolist()
    places = np.array([number_of("displacements", place) for place in displacements])
    found = [equilibrium(across, time=time, axial_displacement=float(place)) for place in places]
    return PreloadDiagram(
        assembly=assembly,
        displacement=places,
        loads={name: np.array([one[name].axial_load for one in found]) for name in assembly.names},
        axial_force=np.array([one.axial_force for one in found]),
        preload=middle,
        operating=operating,
    )


def _without_thrust(load: ShaftLoad, time: float) -> ShaftLoad:
    """A load at a time without its force along the axis, and with that force's moment about the axis' point there."""
    fx, fy, fz = (float(value_at(part, time)) for part in load.force)
    mx, my = (float(value_at(part, time)) for part in load.moment)
    x, y = load.offset
    return load.replace(force=(fx, fy, 0.0), moment=(mx + y * fz, my - x * fz))
