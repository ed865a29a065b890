"""`trbdyn.contact_pressure`: the contact of a roller with a raceway as that of two half spaces."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import NDArray

from trbdyn import laws
from trbdyn.base.display import amount, displayed
from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown, Tabled
from trbdyn.base.validation import number_of
from trbdyn.errors import InputError, unknown_name
from trbdyn.half_space.influence import guilbault_factor
from trbdyn.half_space.line import Line, press_line
from trbdyn.half_space.stress import Shear, largest_shear
from trbdyn.model.contact_line import line_length, stations
from trbdyn.model.profiles import profile_drop, raceway_drops
from trbdyn.model.scene import Scene
from trbdyn.results.result import Result
from trbdyn.run.replay import Replay
from trbdyn.statics.contacts_at_start import contacts_at_start

Array = NDArray[np.float64]
Contacts = dict[str, Array]

RACES: Final = {"outer": 0, "inner": 1}
ENDS: Final = {"faces": "at the roller's end faces", "line": "at the ends of the contact line", "none": "nowhere"}
CELLS: Final = (24, 128)
"""Cells across and along the grid: with these the largest pressures of a line and of a logarithmic profile are within 0.5 % of
those with twice as many (tests/physics/test_contact_pressure.py)."""
MOST_CELLS: Final = 4096
EDGE: Final = 0.1
"""Share of the line's length, at each end, that counts as its edge."""
OFF: Final = 0.1
"""Difference from the slices, over these, from which they are said to be off at an edge."""
HIGH: Final = 0.5
"""Share of the largest pressure below which a pressure at an edge is of no concern."""
SHARP: Final = 0.1
"""Change of the pressure at an edge from a grid with cells twice as large, from which the edge counts as sharp."""
YIELDING: Final = 4.0e9
"""Pressure of the static rating of roller bearings (Pa), ISO 76:2006."""


@dataclass(frozen=True, repr=False)
class ContactPressure(Tabled):
    """Pressure between a roller and a raceway. Prints as a table.

    Attributes
    ----------
    raceway : {'outer', 'inner'}
        The raceway.
    roller : int
        Number of the roller.
    time : float
        Time (s).
    load, moment : float
        Load (N), and its moment about mid length, positive with more load at the large end (N m): those of the slices.
    x, y : ndarray, shape (n,) and (m,)
        Places of the cells across the line, in the direction in which rollers orbit, and along it, from mid length towards the
        large end (m).
    pressure : ndarray, shape (m, n)
        Pressure (Pa).
    slice_pressure, slice_load_per_length : ndarray, shape (m,)
        Largest pressure across (Pa) and load per length (N/m) of slices that do not feel each other.
    radius : ndarray, shape (m,)
        Equivalent radius (m).
    coarse : ndarray, shape (m / 2,)
        Largest pressure across, with cells twice as wide and long (Pa).
    approach, tilt : float
        How much closer the bodies came at mid length (m), and how much more towards the large end (rad): from where the profiles
        would just touch. Approaches of a half space are relative to points far away, so that they differ from those of slices.
    poisson_ratio, effective_modulus : float
        Poisson's ratio of the ring (1), and E' of both bodies (Pa).
    warnings : tuple of str
        What to be careful about.
    """

    raceway: str
    roller: int
    time: float
    load: float
    moment: float
    x: Array
    y: Array
    pressure: Array
    slice_pressure: Array
    slice_load_per_length: Array
    radius: Array
    coarse: Array
    approach: float
    tilt: float
    poisson_ratio: float
    effective_modulus: float
    warnings: tuple[str, ...]

    @property
    def cell(self) -> tuple[float, float]:
        """Width and length of a cell (m)."""
        return float(self.x[1] - self.x[0]), float(self.y[1] - self.y[0])

    @property
    def along(self) -> Array:
        """Largest pressure across the line at each place along it (Pa), shape (m,)."""
        return np.asarray(self.pressure.max(axis=1))

    @property
    def load_per_length(self) -> Array:
        """Load per length along the line (N/m), shape (m,)."""
        return np.asarray(self.pressure.sum(axis=1) * self.cell[0])

    @property
    def largest(self) -> float:
        """Largest pressure (Pa)."""
        return float(self.pressure.max())

    @property
    def place(self) -> tuple[float, float]:
        """Where the pressure is largest: across, and along the line from mid length towards the large end (m)."""
        row, column = np.unravel_index(int(self.pressure.argmax()), self.pressure.shape)
        return float(self.x[column]), float(self.y[row])

    @property
    def edges(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Largest pressure in the outer tenth of the line, and that of slices there (Pa): at the small and at the large end."""
        small, large = self.y < self._edge[0], self.y > self._edge[1]
        found = [(float(self.along[end].max()), float(self.slice_pressure[end].max())) for end in (small, large)]
        return found[0], found[1]

    @property
    def edge_ratios(self) -> tuple[float, float]:
        """The first over the second of `edges` (1); inf or nan where slices have no pressure there."""
        with np.errstate(divide="ignore", invalid="ignore"):
            small, large = (float(np.divide(one, other)) for one, other in self.edges)
        return small, large

    @property
    def _edge(self) -> tuple[float, float]:
        half = 0.5 * (self.y[-1] - self.y[0] + self.cell[1])
        return -(1.0 - 2.0 * EDGE) * half, (1.0 - 2.0 * EDGE) * half

    @property
    def slices_are_off(self) -> tuple[bool, bool]:
        """Whether slices are off by more than 10 % at the small and at the large end, if more than half of the largest
        pressure acts there.
        """
        most = max(self.largest, float(self.slice_pressure.max()))
        small, large = (abs(one - other) > OFF * other and max(one, other) > HIGH * most for one, other in self.edges)
        return small, large

    @property
    def sharp_edges(self) -> tuple[bool, bool]:
        """Whether the small and the large end press with a sharp edge, where the pressure rises without bound as cells become
        shorter.
        """
        along, coarse = self.along, self.coarse
        small, large = (bool(along[end] > max(HIGH * self.largest, (1.0 + SHARP) * coarse[end])) for end in (0, -1))
        return small, large

    @cached_property
    def shear(self) -> Shear:
        """Largest shear stresses below the ring's surface at each place along the line, without friction."""
        halves = np.sqrt(8.0 * self.load_per_length * self.radius / (math.pi * self.effective_modulus))
        return largest_shear(self.pressure, self.cell, float(halves.max()), self.poisson_ratio)

    def equivalent_loads(self, count: int) -> Array:
        """Loads of laminas (N), shape (count,), under which lines of contact would have these pressures by Hertz."""
        per_length = 2.0 * math.pi * self.radius * self.along**2 / self.effective_modulus
        edges = np.append(self.y - 0.5 * self.cell[1], self.y[-1] + 0.5 * self.cell[1])
        total = np.concatenate([[0.0], np.cumsum(per_length) * self.cell[1]])
        return np.diff(np.interp(np.linspace(edges[0], edges[-1], count + 1), edges, total))

    def _shown(self) -> Shown:
        along = self.place[1]
        rows: list[tuple[str, ...]] = [
            ("largest pressure", *displayed(self.largest, "Pa"), f"{1e3 * along:.4g} mm from mid length"),
            (
                "largest pressure of slices",
                *displayed(float(self.slice_pressure.max()), "Pa"),
                "Hertz, each by itself",
            ),
            ("load", *displayed(self.load, "N", 5), f"moment about mid length {amount(self.moment, 'N m', 3)}"),
        ]
        for name, (one, other), ratio in zip(("small end", "large end"), self.edges, self.edge_ratios, strict=True):
            said = (
                f"{ratio:.3g} times that of slices, {amount(other, 'Pa')}" if other > 0.0 else "slices have none there"
            )
            rows.append((f"pressure at the {name}", *displayed(one, "Pa"), said))
        title = f"Roller {self.roller} on the {self.raceway} raceway at {self.time:.4g} s"
        return Shown(title=title, rows=tuple(rows), notes=self.warnings)


def contact_pressure(
    subject: Scene | Result,
    *,
    raceway: Literal["outer", "inner"] = "inner",
    roller: int | None = None,
    time: float | None = None,
    free_ends: Literal["faces", "line", "none"] = "faces",
    mirrored: float | None = None,
    cells: tuple[int, int] = CELLS,
) -> ContactPressure:
    """Pressure between a roller and a raceway, computed as that between two elastic half spaces, with profile, skew and tilt.

    Slices, by which runs compute, do not feel each other; at the ends of rollers the pressure therefore differs from theirs. Load
    and moment of the contact are those of the slices; how the bodies approach and tilt under them follows.

    Parameters
    ----------
    subject : Scene or Result
        Of a scene its start, else a record; a result needs the groups cage and rollers.
    raceway : {'outer', 'inner'}
        The raceway.
    roller : int, optional
        Number of the roller; by default the one with the largest load on this raceway.
    time : float, optional
        Time of a result (s), whose nearest record is taken; the last one by default.
    free_ends : {'faces', 'line', 'none'}
        Where the roller ends: at its end faces, at the ends of the contact line, as if a chamfer took all material beyond it, or
        nowhere. The raceway goes on.
    mirrored : float, optional
        Factor of the pressure that is mirrored at the roller's ends (1); by default that of Guilbault, 1.39 for steel. 1 leaves
        normal stress on the end faces, so that the roller is too stiff.
    cells : tuple of int
        Cells across and along the grid, even.

    Returns
    -------
    ContactPressure
        Map and largest values; `trbdyn.plot.contact_pressure` draws it.

    Raises
    ------
    InputError
        If an argument is not allowed, a group is missing, or the contact carries nothing.
    LoadError
        If the pressure is not found.

    Notes
    -----
    Polonsky and Keer (1999), Wear 231, 206-219; Love (1929); Guilbault (2011), J. Tribology 133, 031402;
    docs/theory/contacts.md#pressure-at-the-ends-of-rollers.

    Examples
    --------
    >>> import trbdyn as trb
    >>> found = trb.contact_pressure(trb.cases.scene_32216())
    >>> bool(found.largest < 1.1 * found.slice_pressure.max())
    True
    """
    expect("subject", subject, Scene, Result)
    if raceway not in RACES:
        raise InputError.of("raceway", raceway, unknown_name(str(raceway), RACES))
    scene, contacts, when = contacts_of(subject, time)
    loads = contacts["raceway_load"][RACES[raceway]].sum(axis=-1)
    chosen = int(loads.argmax()) if roller is None else roller
    if isinstance(chosen, bool) or not isinstance(chosen, int) or not 0 <= chosen < loads.size:
        raise InputError.of("roller", roller, f"must be a whole number from 0 to {loads.size - 1}")
    return one_contact(
        scene, contacts, raceway, chosen, when, free_ends=free_ends, mirrored=mirrored, cells=_grid(cells)
    )


def contacts_of(subject: Scene | Result, time: float | None) -> tuple[Scene, Contacts, float]:
    """A scene, what its contacts are at its start or at a record, and the time of this (s)."""
    if isinstance(subject, Scene):
        if time is not None:
            raise InputError.of("time", time, "is of a result; of a scene the start is taken")
        return subject, contacts_at_start(subject), subject.start.time
    times = np.asarray(subject["time"])
    index = times.size - 1 if time is None else int(np.abs(times - number_of("time", time)).argmin())
    if time is not None and not times[0] <= time <= times[-1]:
        raise InputError.of("time", time, f"must be within the run, {times[0]:.6g} to {times[-1]:.6g} (s)")
    return subject.scene, Replay(subject).contacts(index), float(times[index])


def _grid(cells: Any) -> tuple[int, int]:
    whole = (
        isinstance(cells, tuple | list) and len(cells) == 2 and all(isinstance(n, int) and n % 2 == 0 for n in cells)
    )
    if not whole or not 8 <= min(cells) <= max(cells) <= MOST_CELLS:
        raise InputError.of("cells", cells, f"must be two even whole numbers from 8 to {MOST_CELLS}")
    return cells[0], cells[1]


def one_contact(
    scene: Scene,
    contacts: Contacts,
    raceway: str,
    roller: int,
    time: float,
    *,
    free_ends: str = "faces",
    mirrored: float | None = None,
    cells: tuple[int, int] = CELLS,
) -> ContactPressure:
    """The pressure of one contact of those of a scene."""
    if free_ends not in ENDS:
        raise InputError.of("free_ends", free_ends, unknown_name(str(free_ends), ENDS))
    if mirrored is not None and not 0.0 <= number_of("mirrored", mirrored) <= 3.0:
        raise InputError.of("mirrored", mirrored, "must be from 0 to 3 (1)")
    race, bearing = RACES[raceway], scene.bearing
    nodes = stations(scene)
    of = {name: contacts[f"raceway_{name}"][race, roller][: nodes.size] for name in NEEDED}
    load = float(of["load"].sum())
    if not load > 0.0:
        raise InputError.of("roller", roller, f"does not touch the {raceway} raceway at {time:g} s")
    ratio = bearing.roller_material.poisson_ratio
    factor = guilbault_factor(ratio) if mirrored is None else mirrored
    beyond = max(0.5 * (bearing.roller.total_length - line_length(scene)), 0.0) if free_ends == "faces" else 0.0
    line, per_length, uneven = _line(scene, race, nodes, of, cells[1])
    line = replace(line, mirrored=0.0 if free_ends == "none" else factor, beyond=beyond)
    moment = float(of["load"] @ nodes)
    found = press_line(line, load=load, moment=moment, per_length=per_length, cells=cells[0])
    modulus = bearing.geometry.effective_modulus
    out = ContactPressure(
        raceway=raceway,
        roller=roller,
        time=time,
        load=load,
        moment=moment,
        x=found.x,
        y=found.y,
        pressure=found.found.pressure,
        slice_pressure=laws.line_pressure(load_per_length=per_length, radius=line.radius, effective_modulus=modulus),
        slice_load_per_length=per_length,
        radius=line.radius,
        coarse=found.coarse,
        approach=found.found.approach,
        tilt=found.found.tilt,
        poisson_ratio=bearing.material.poisson_ratio,
        effective_modulus=modulus,
        warnings=(),
    )
    return replace(out, warnings=_warnings(out, uneven))


FEWEST: Final = 5
"""Nodes near the contact from which on these alone tell how the bodies lie."""
NEEDED: Final = ("interference", "load", "load_per_length", "radius", "py")


def _line(scene: Scene, race: int, nodes: Array, of: Contacts, count: int) -> tuple[Line, Array, float]:
    """The contact line at cells of equal length, the load per length of slices there (N/m), and how far surfaces with defects are
    off their true form (m): from the interferences of the nodes.

    Profiles taken away, the interference along a line is a polynomial of the second degree: approach, tilt, and skew. What
    defects leave is taken as the same all across the contact, and linear between nodes.
    """
    bearing, length = scene.bearing, line_length(scene)
    places = length * ((np.arange(count) + 0.5) / count - 0.5)

    def drops(at: Array) -> Array:
        return np.asarray(profile_drop(bearing, at) + raceway_drops(bearing, at)[race])

    smooth, deepest = of["interference"] + drops(nodes), float(of["interference"].max())
    near = of["interference"] > -deepest
    near = near if near.sum() >= FEWEST else np.ones_like(near)
    fitted = np.polynomial.Polynomial.fit(nodes[near], smooth[near], 2)
    radius, shift = (np.polynomial.Polynomial.fit(nodes, of[name], 2)(places) for name in ("radius", "py"))
    left = fitted(nodes) - smooth if scene.defects else np.zeros_like(nodes)
    interference = fitted(places) - drops(places) - np.interp(places, nodes, left)
    per_length = laws.line_load(
        interference=interference,
        effective_modulus=bearing.geometry.effective_modulus,
        length=bearing.roller.effective_length,
    )
    elastic = [(1.0 - one.poisson_ratio**2) / one.youngs_modulus for one in (bearing.roller_material, bearing.material)]
    line = Line(places, -interference, radius, shift - shift.mean(), (elastic[0], elastic[1]))
    return line, per_length, float(np.abs(left[near]).max())


def _warnings(found: ContactPressure, uneven: float) -> tuple[str, ...]:
    """What to be careful about."""
    said, names = [], ("small", "large")
    for name, off, (one, other) in zip(names, found.slices_are_off, found.edges, strict=True):
        if off:
            said.append(
                f"Slices are off at the {name} end: {amount(other, 'Pa', 3)} there, {amount(one, 'Pa', 3)} as half spaces."
            )
    sharp = [name for name, is_sharp in zip(names, found.sharp_edges, strict=True) if is_sharp]
    if sharp:
        said.append(
            f"Sharp edge at the {' and the '.join(sharp)} end: the pressure there rises without bound as cells become shorter; "
            f"that of cells {1e6 * found.cell[1]:.0f} µm long is shown."
        )
    if found.largest > YIELDING:
        said.append(
            f"The largest pressure is above {1e-9 * YIELDING:.3g} GPa, where bearing steel yields below the surface: the bodies "
            "are taken as elastic."
        )
    if uneven:
        said.append(
            f"Defects lie here, up to {1e6 * uneven:.3g} µm deep at a node: they are taken as the same all across the contact, "
            "and linear between nodes."
        )
    return tuple(said)


def edge_warnings(result: Result) -> list[str]:
    """Where slices are off by more than 10 % at an edge at the last record, of the contacts with the largest loads."""
    if any(group not in result.groups for group in ("cage", "rollers")) or result.scene.modes_from_file:
        return []
    try:
        scene, contacts, time = contacts_of(result, None)
    except InputError:  # a ring that moves was not recorded
        return []
    out = []
    for raceway, race in RACES.items():
        loads = contacts["raceway_load"][race].sum(axis=-1)
        if not loads.max() > 0.0:
            continue
        found = one_contact(scene, contacts, raceway, int(loads.argmax()), time)
        for end, off, (one, other) in zip(("small", "large"), found.slices_are_off, found.edges, strict=True):
            if off:
                out.append(
                    f"Slices are off at the {end} end of roller {found.roller} on the {raceway} raceway: they give "
                    f"{amount(other, 'Pa', 3)} there, half spaces {amount(one, 'Pa', 3)} (trb.contact_pressure)."
                )
    return out
