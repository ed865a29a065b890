"""The catalogue of hard scenes: what each is, why it is hard, how long it runs, and what must hold (hard_scenes.toml)."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any, Literal

import numpy as np

import trbdyn as trb
from trbdyn import errors
from trbdyn.model.cases import paper_30310, rig_30310
from trbdyn.model.pocket import Pocket
from trbdyn.model.pocket_shapes import default_pocket
from trbdyn.run.toml_case import case_from_dict
from trbdyn.statics.state_view import StateView

Make = Callable[[], trb.Scene | trb.Assembly]
Table = dict[str, Any]


UNDAMPED = (
    "the effects of the paper damp no contact, so that rollers go on to bounce at 35 kHz, and each bounce takes steps; with the "
    "damping that contacts have by default (Effects.standard) the same scene, ..._damped, takes at most ten times the steps"
)
"""Why scenes take many steps."""


@dataclass(frozen=True)
class Hard:
    """One hard scene.

    Attributes
    ----------
    name, why : str
        What it is called, and why it is hard.
    make : callable
        Makes the scene, or bearings on a shaft; may raise the promised error.
    duration : float
        Bearing time (s).
    error : type, optional
        The promised error, where the scene is impossible.
    words : str
        What the error's message must say.
    closure : float
        Bound of the energy audit's closure: residual over dissipated work, or over the largest energy where nothing is
        lost.
    twin : float
        Bound of the energy that the scene without friction makes or loses, over the largest energy in it.
    steps : float
        Bound of the steps a second of bearing time, in those of the smooth scene.
    calm : float or None
        When the event is over (s): from there on steps must be large again.
    tolerances : float
        Bound of what two tolerances differ by: mean loss, relative, over `compared`.
    runs : int
        Runs with each of both tolerances and others near them, whose mean loss is compared: more than one where single runs part.
    compared : float
        Bearing time over which two tolerances are compared, and the scene without friction runs (s), if less than
        `duration`.
    path : float
        Bound of what two methods differ by over `window`: speeds of rollers, cages and shaft, over the largest speed.
    window : float
        Bearing time over which two methods are compared (s).
    second : {'erk', 'bdf5'}
        The second method: explicit Runge-Kutta, or BDF of order up to 5 where explicit steps would be too many.
    accuracy : {'standard', 'reference'}
        Preset of the tolerances.
    slow : bool
        Takes more than a few seconds.
    reason : str
        Why it takes more than fifty times the steps of the smooth scene, and what to do.
    """

    name: str
    why: str
    make: Make
    duration: float = 0.02
    error: type[Exception] | None = None
    words: str = ""
    closure: float = 0.05
    twin: float = 2e-4
    steps: float = 40.0
    calm: float | None = None
    tolerances: float = 0.05
    runs: int = 1
    compared: float = math.inf
    path: float = 2e-3
    window: float = 5e-4
    second: str = "erk"
    accuracy: Literal["standard", "reference"] = "standard"
    slow: bool = False
    reason: str = ""


def smooth() -> trb.Scene:
    """What the others are measured against."""
    return paper_30310(3000.0, 4930.0)


# ---- changes of the state of the start: `state` of the table ----


def not_finite(state: StateView, scene: trb.Scene) -> None:
    state["cage_x"] = math.nan


def skewed(state: StateView, scene: trb.Scene) -> None:
    limit = scene.bearing.cage.play_circumferential / (0.5 * scene.bearing.roller.effective_length)
    state["cage_x"] = state["cage_y"] = 0.0
    state["roller_skew"] = 0.9 * limit * np.where(np.arange(scene.bearing.n_rollers) % 2, 1.0, -1.0)


def in_corner(state: StateView, scene: trb.Scene) -> None:
    skewed(state, scene)
    state["cage_z"] += 0.35e-3
    state["cage_x"] = 0.02e-3


def slipping(state: StateView, scene: trb.Scene) -> None:
    state["roller_v_t"] *= 0.98


def thrown(state: StateView, scene: trb.Scene) -> None:
    state["cage_v_x"], state["cage_v_y"] = 0.5, -0.3
    state["cage_omega_n"] += 20.0


def deep(state: StateView, scene: trb.Scene) -> None:
    state["roller_r"] += 50e-6


STATES = {change.__name__: change for change in (not_finite, skewed, in_corner, slipping, thrown, deep)}


# ---- tables of a case that are computed: `make` of the table ----


@cache
def loaded_place() -> float:
    """Axial place of the ring under its load (m)."""
    return float(trb.Simulation(smooth()).equilibrium.displacement[2])


def let_go(times: list[float], free: list[int]) -> Table:
    """A ring that is moved from its place under load to a clearance of 30 um, at the knots `free`, and back."""
    values = [30e-6 if knot in free else loaded_place() for knot in range(len(times))]
    return {"scene": {"axial_load": 0.0, "displacement": (0.0, 0.0, trb.History(times=times, values=values))}}


def thick_oil(viscosity: float) -> Table:
    """The usual oil with another viscosity (Pa s)."""
    return {"lubricant": trb.lubricants.vg100(60.0).replace(viscosity=viscosity).to_dict()}


def smaller_rollers(count: int) -> Table:
    """As many rollers as fit round the pitch circle, if they are small enough."""
    bearing = rig_30310()
    diameter = 0.8 * bearing.pitch_diameter * math.sin(math.pi / count)
    scale = diameter / bearing.roller.diameter
    ribs, own = bearing.ribs, bearing.cage
    cage = {name: scale * getattr(own, name) for name in ("bar_width", "wall_inner", "wall_outer", "wall_half_width")}
    heights = {"contact_height": scale * ribs.contact_height, "edge_low": 0.0, "edge_high": scale * ribs.edge_high}
    return {"bearing": {"n_rollers": count, "roller": {"diameter": diameter}, "ribs": heights, "cage": cage}}


def tight_pocket(interference: float) -> Table:
    """The default pocket with bars that press on the roller (m)."""
    pocket = default_pocket(rig_30310())
    faces = []
    for face in pocket.faces:
        if face.part == "flank":
            normal = np.cross(face.u, face.v)
            gap = rig_30310().cage.play_circumferential * math.cos(math.radians(1.87)) * math.cos(math.radians(26.39))
            face = face.replace(origin=tuple(np.array(face.origin) + (gap + interference) * normal))
        faces.append(face)
    return {"bearing": {"cage": rig_30310().cage.replace(pocket=Pocket(faces=tuple(faces), allow_interference=True))}}


def free_ring(
    mass: float,
    unbalance: float = 0.0,
    mass_offset: float = 0.0,
    housing: dict[str, float] | None = None,
    shaken: dict[str, float] | None = None,
) -> Table:
    """A ring that is free, with a shaft of its mass; a housing on a support of a radial stiffness, which gravity may shake."""
    body = trb.RingBody.hollow_cylinder(mass=mass, outer_diameter=0.06, length=0.09, mass_offset=mass_offset)
    scene: Table = {"ring": "free", "ring_body": body.replace(unbalance=unbalance)}
    if housing:
        block = trb.Housing.hollow_cylinder(mass=housing["mass"], inner_diameter=0.11, outer_diameter=0.15, length=0.04)
        radial = housing["stiffness"]
        scene["housing"] = block.replace(support_radial=radial, support_axial=0.5 * radial, support_tilt=1e-3 * radial)
    if shaken:
        scene["gravity"] = (0.0, trb.History.harmonic(-9.80665, **shaken), 0.0)
    return {"scene": scene}


def elastic_cage(material: str, cracked_bars: list[int] | tuple[int, ...] = ()) -> Table:
    """A cage with 20 modes, damped by a hundredth of the critical damping."""
    of = getattr(trb.Material, material)()
    made = trb.Cage(play_radial=0.25e-3, play_circumferential=0.12e-3, body=trb.cases.cage_body_30310(), material=of)
    modes = trb.ElasticCage(n_modes=20, damping_ratio=0.01, cracked_bars=tuple(cracked_bars))
    return {"bearing": {"cage": made}, "scene": {"elastic_cage": modes}}


MADE = {make.__name__: make for make in (let_go, thick_oil, smaller_rollers, tight_pocket, free_ring, elastic_cage)}


# ---- the catalogue ----

PLAIN: Table = {
    "bearing": {"case": "30310"},
    "effects": {"preset": "paper"},
    "scene": {"speed_rpm": 3000.0, "axial_load": 4930.0},
}
"""What a scene of the catalogue has where its table gives nothing."""
OF_CASE = ("bearing", "lubricant", "effects", "scene", "start")


def scene_of(entry: Table) -> trb.Scene:
    """The scene of an entry of the catalogue."""
    made = MADE[entry["make"]](**entry.get("given", {})) if "make" in entry else {}
    tables = {name: PLAIN.get(name, {}) | entry.get(name, {}) | made.get(name, {}) for name in OF_CASE}
    scene, _ = case_from_dict({name: table for name, table in tables.items() if table})
    if "state" in entry:
        sim = trb.Simulation(scene)
        vector = sim.state.vector
        STATES[entry["state"]](sim.view(vector), scene)
        scene = scene.replace(start=trb.Start.state(vector))
    return scene


def hard_of(name: str, entry: Table) -> Hard:
    """The hard scene of an entry of the catalogue; its scene is made when it is needed."""
    own = {key: value for key, value in entry.items() if key not in (*OF_CASE, "make", "given", "state")}
    if "error" in own:
        own["error"] = getattr(errors, own["error"])
    if own.get("reason") == "undamped":
        own["reason"] = UNDAMPED
    return Hard(name, make=partial(scene_of, entry), **own)


CATALOGUE = tomllib.loads(Path(__file__).with_name("hard_scenes.toml").read_text(encoding="utf-8"))
HARD = tuple(hard_of(name, entry) for name, entry in CATALOGUE.items())
"""Every hard scene."""
