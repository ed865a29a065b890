"""The catalogue of hard scenes: what each is, why it is hard, how long it runs, and what must hold."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any, Literal

import numpy as np

import trbdyn as trb
from trbdyn.errors import InputError, LoadError, StepError
from trbdyn.model.cases import paper_30310, rig_30310
from trbdyn.model.pocket import OtherPocket, Pocket
from trbdyn.model.pocket_shapes import chamfered_pocket, default_pocket, one_sided_pocket, stepped_pocket
from trbdyn.statics.state_view import StateView

Make = Callable[[], trb.Scene | trb.Assembly]


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


def cage(**changes: Any) -> trb.Bearing:
    bearing = rig_30310()
    return bearing.replace(cage=bearing.cage.replace(**changes))


def guided(land: dict[str, float], **changes: Any) -> trb.Bearing:
    """A bearing with a land of its own, and another cage."""
    bearing = cage(**changes)
    return bearing.replace(land=bearing.land.replace(**land))


def roller(**changes: Any) -> trb.Bearing:
    bearing = rig_30310()
    return bearing.replace(roller=bearing.roller.replace(**changes))


def with_pocket(pocket: Pocket, index: int | None = None) -> trb.Bearing:
    if index is None:
        return cage(pocket=pocket)
    return cage(other_pockets=(OtherPocket(index=index, pocket=pocket),))


def effects(**changes: Any) -> trb.Effects:
    return trb.Effects.paper().replace(**changes)


def history(*points: tuple[float, float]) -> trb.History:
    times, values = zip(*points, strict=True)
    return trb.History(times=times, values=values)


@cache
def loaded_place(axial_load: float = 4930.0) -> float:
    """Axial place of the ring under a load (m)."""
    return float(trb.Simulation(paper_30310(3000.0, axial_load)).equilibrium.displacement[2])


def from_state(change: Callable[[StateView, trb.Scene], None], **fields: Any) -> trb.Scene:
    """A scene that starts from a changed start."""
    scene = paper_30310(**fields)
    sim = trb.Simulation(scene)
    vector = sim.state.vector
    change(sim.view(vector), scene)
    return scene.replace(start=trb.Start.state(vector))


def cylindrical(flanges: Any, speed_rpm: float, clearance: float, **fields: Any) -> trb.Scene:
    bearing = trb.cases.bearing_nj210()
    bearing = bearing.replace(ribs=bearing.ribs.replace(flanges=flanges), radial_clearance=clearance)
    return trb.Scene(bearing, speed_rpm=speed_rpm, **fields)


def smaller_rollers(count: int) -> trb.Bearing:
    """As many rollers as fit round the pitch circle, if they are small enough."""
    bearing = rig_30310()
    diameter = 0.8 * bearing.pitch_diameter * math.sin(math.pi / count)
    scale = diameter / bearing.roller.diameter
    ribs, own = bearing.ribs, bearing.cage
    return bearing.replace(
        n_rollers=count,
        roller=bearing.roller.replace(diameter=diameter),
        ribs=ribs.replace(contact_height=scale * ribs.contact_height, edge_low=0.0, edge_high=scale * ribs.edge_high),
        cage=own.replace(
            bar_width=scale * own.bar_width,
            wall_inner=scale * own.wall_inner,
            wall_outer=scale * own.wall_outer,
            wall_half_width=scale * own.wall_half_width,
        ),
    )


def smooth_pockets() -> trb.Bearing:
    bearing = rig_30310()
    return bearing.replace(roughness=bearing.roughness.replace(pocket=5e-8))


def tight_pocket(interference: float) -> Pocket:
    """The default pocket with bars that press on the roller (m)."""
    pocket = default_pocket(rig_30310())
    faces = []
    for face in pocket.faces:
        if face.part == "flank":
            normal = np.cross(face.u, face.v)
            gap = rig_30310().cage.play_circumferential * math.cos(math.radians(1.87)) * math.cos(math.radians(26.39))
            face = face.replace(origin=tuple(np.array(face.origin) + (gap + interference) * normal))
        faces.append(face)
    return Pocket(faces=tuple(faces), allow_interference=True)


def skewed(state: StateView, scene: trb.Scene) -> None:
    limit = scene.bearing.cage.play_circumferential / (0.5 * scene.bearing.roller.effective_length)
    state["cage_x"] = state["cage_y"] = 0.0
    state["roller_skew"] = 0.9 * limit * np.where(np.arange(scene.bearing.n_rollers) % 2, 1.0, -1.0)


def in_corner(state: StateView, scene: trb.Scene) -> None:
    skewed(state, scene)
    state["cage_z"] += 0.35e-3
    state["cage_x"] = 0.02e-3


def slipping(share: float) -> Callable[[StateView, trb.Scene], None]:
    def change(state: StateView, scene: trb.Scene) -> None:
        state["roller_v_t"] *= 1.0 - share

    return change


def thrown(state: StateView, scene: trb.Scene) -> None:
    state["cage_v_x"], state["cage_v_y"] = 0.5, -0.3
    state["cage_omega_n"] += 20.0


def deep(state: StateView, scene: trb.Scene) -> None:
    state["roller_r"] += 50e-6


SHOCK = history((0.0, -9.80665), (5e-3, -9.80665), (5.05e-3, 4903.0), (5.95e-3, 4903.0), (6e-3, -9.80665))
S = paper_30310


def slow_films() -> trb.Effects:
    """For scenes that stand still: friction turns over slip of 0.5 mm/s and not 10 um/s, which is stick-slip of
    nanoseconds.
    """
    return effects(friction=trb.Effects.paper().friction.replace(speed_floor=0.05))


def _vg(**changes: Any) -> trb.Lubricant:
    return trb.lubricants.vg100(temperature_c=60.0).replace(**changes)


def free_ring(
    mass: float, speed_rpm: float = 3000.0, *, unbalance: float = 0.0, mass_offset: float = 0.0, **fields: Any
) -> trb.Scene:
    """A ring that is free, with a shaft of its mass."""
    body = trb.RingBody.hollow_cylinder(mass=mass, outer_diameter=0.06, length=0.09, mass_offset=mass_offset)
    given = {"axial_load": 4930.0} | fields
    return trb.Scene(
        rig_30310(), speed_rpm=speed_rpm, ring="free", ring_body=body.replace(unbalance=unbalance), **given
    )


def housing(mass: float, stiffness: float) -> trb.Housing:
    """A housing on a support of a radial stiffness."""
    block = trb.Housing.hollow_cylinder(mass=mass, inner_diameter=0.11, outer_diameter=0.15, length=0.04)
    return block.replace(support_radial=stiffness, support_axial=0.5 * stiffness, support_tilt=1e-3 * stiffness)


def elastic_cage(material: trb.Material, speed_rpm: float, cracked_bars: tuple[int, ...] = ()) -> trb.Scene:
    """A cage with 20 modes, damped by a hundredth of the critical damping, that begins near its rollers."""
    plays = {"play_radial": 0.25e-3, "play_circumferential": 0.12e-3}
    made = trb.Cage(**plays, body=trb.cases.cage_body_30310(), material=material)
    return trb.Scene(
        rig_30310().replace(cage=made),
        speed_rpm=speed_rpm,
        axial_load=4930.0,
        start=trb.Start.whirl(0.9),
        elastic_cage=trb.ElasticCage(n_modes=20, damping_ratio=0.01, cracked_bars=cracked_bars),
    )


HARD: tuple[Hard, ...] = (
    Hard(
        "no_load",
        "nothing holds rollers and rings together",
        lambda: S(axial_load=0.0),
        error=InputError,
        words="must be > 0",
    ),
    Hard(
        "more_radial_than_carried",
        "no equilibrium: the rings come apart",
        lambda: S(3000.0, 4930.0, 30000.0),
        error=InputError,
        words="all it can carry",
    ),
    Hard(
        "zero_pocket_play",
        "no room for a roller in its pocket",
        lambda: S(bearing=cage(play_circumferential=0.0)),
        error=InputError,
        words="must be > 0",
    ),
    Hard(
        "rollers_overlap",
        "more rollers than fit",
        lambda: S(bearing=rig_30310().replace(n_rollers=60)),
        error=InputError,
        words="overlap",
    ),
    Hard(
        "state_not_finite",
        "a start that is no state",
        lambda: from_state(lambda state, scene: state.__setitem__("cage_x", math.nan)),
        error=InputError,
        words="finite",
    ),
    Hard(
        "moment_beyond_capacity",
        "the moment tips the ring out of its rollers",
        lambda: S(3000.0, 500.0, moment_x=500.0),
        error=LoadError,
        words="equilibrium",
    ),
    Hard(
        "rollers_without_cage_touch",
        "nothing keeps rollers apart",
        lambda: S(
            1000.0,
            bearing=cage(play_circumferential=8e-3, play_radial=13e-3),
            effects=effects(bodies="rollers"),
            start=trb.Start.unequal(3, spread=1.0),
        ),
        error=StepError,
        words="touch",
    ),
    Hard(
        "unloaded_ring",
        "no contact carries: rollers float in a clearance of 30 um",
        lambda: S(3000.0, 0.0, displacement=(0.0, 0.0, 30e-6)),
        tolerances=0.5,
    ),
    Hard(
        "zero_clearance",
        "every contact at the point of touching",
        lambda: S(3000.0, 0.0, displacement=(0.0, 0.0, 0.0)),
        tolerances=0.8,
        steps=60.0,
    ),
    Hard("negative_clearance", "preloaded by 60 um", lambda: S(3000.0, 0.0, displacement=(0.0, 0.0, -60e-6))),
    Hard(
        "load_removed_and_back",
        "the ring lets go within 0.1 ms, and comes back within 0.1 ms",
        lambda: S(
            3000.0,
            0.0,
            displacement=(
                0.0,
                0.0,
                history(
                    (0.0, loaded_place()),
                    (5e-3, loaded_place()),
                    (5.1e-3, 30e-6),
                    (8e-3, 30e-6),
                    (8.1e-3, loaded_place()),
                ),
            ),
        ),
        duration=0.04,
        calm=0.02,
        steps=45.0,
        tolerances=0.3,
    ),
    Hard(
        "load_step",
        "1 % of the load and back within 0.1 ms",
        lambda: S(
            3000.0,
            axial_load=history((0.0, 4930.0), (5e-3, 4930.0), (5.1e-3, 49.3), (8e-3, 49.3), (8.1e-3, 4930.0)),
            ring="follows",
        ),
        duration=0.04,
        calm=0.02,
        steps=30.0,
        tolerances=0.2,
    ),
    Hard(
        "load_removed_in_one_step",
        "the ring lets go and comes back within 1 us each; damped, as nothing else ends the bouncing between races",
        lambda: S(
            3000.0,
            0.0,
            displacement=(
                0.0,
                0.0,
                history(
                    (0.0, loaded_place()),
                    (5e-3, loaded_place()),
                    (5.001e-3, 30e-6),
                    (8e-3, 30e-6),
                    (8.001e-3, loaded_place()),
                ),
            ),
            effects=trb.Effects.standard(),
        ),
        duration=0.03,
        calm=0.02,
        steps=45.0,
        # rollers bounce between the races, and single runs part: the means of several are compared
        tolerances=0.3,
        runs=8,
    ),
    Hard(
        "load_step_in_one_step",
        "1 % of the load and back within 1 us each, a step or two; damped",
        lambda: S(
            3000.0,
            axial_load=history((0.0, 4930.0), (5e-3, 4930.0), (5.001e-3, 49.3), (8e-3, 49.3), (8.001e-3, 4930.0)),
            ring="follows",
            effects=trb.Effects.standard(),
        ),
        duration=0.03,
        calm=0.02,
        steps=45.0,
        tolerances=0.2,
    ),
    Hard(
        "rollers_leave_contact",
        "half of the rollers unloaded at each turn",
        lambda: S(2000.0, 4930.0, 14000.0),
        duration=0.06,
    ),
    Hard(
        "start_from_rest",
        "films and slip ratios begin at zero speed",
        lambda: S(history((0.0, 0.0), (2e-3, 0.0), (0.03, 3000.0))),
        duration=0.05,
        tolerances=0.2,
        second="bdf5",
        path=0.05,
    ),
    Hard(
        "speed_reversal",
        "everything passes through zero speed",
        lambda: S(history((0.0, 1000.0), (0.005, 1000.0), (0.035, -1000.0))),
        duration=0.05,
        steps=40.0,
        tolerances=0.2,
    ),
    Hard(
        "stop",
        "rollers come to rest and stay",
        lambda: S(history((0.0, 3000.0), (0.005, 3000.0), (0.03, 0.0)), effects=slow_films()),
        duration=0.06,
        tolerances=0.2,
    ),
    Hard(
        "30000_rpm",
        "centrifugal force beyond the load, thermal reduction at its floor",
        lambda: S(30000.0),
        duration=0.01,
        steps=60.0,
        tolerances=0.3,
        path=1e-2,
    ),
    Hard(
        "10_rpm",
        "traction damping rises as speed falls",
        lambda: S(10.0),
        duration=0.2,
        second="bdf5",
        tolerances=0.3,
        path=1e-2,
        closure=0.15,
    ),
    Hard(
        "pocket_play_2_mm",
        "long free flights",
        lambda: S(bearing=cage(play_radial=2e-3, play_circumferential=1e-3), start=trb.Start.whirl(0.3)),
        tolerances=0.5,
        steps=300.0,
    ),
    Hard(
        "negative_pocket_play",
        "bars press on every roller",
        lambda: S(bearing=with_pocket(tight_pocket(3e-6))),
        duration=4e-3,
        path=1e-2,
        steps=300.0,
        tolerances=0.2,
        reason=UNDAMPED,
    ),
    Hard(
        "negative_pocket_play_damped",
        "the same with the damping that contacts have by default",
        lambda: S(bearing=with_pocket(tight_pocket(3e-6)), effects=trb.Effects.standard()),
        duration=4e-3,
        path=1e-2,
        steps=20.0,
        tolerances=0.2,
    ),
    Hard(
        "pmax_4_GPa",
        "stiffest contacts, negative numerator of the thermal factor",
        lambda: S(3000.0, 140e3),
        duration=0.01,
        steps=40.0,
    ),
    Hard(
        "pmax_4_GPa_30000_rpm",
        "load and speed at once",
        lambda: S(30000.0, 140e3),
        duration=4e-3,
        steps=80.0,
        tolerances=0.3,
        path=1e-2,
    ),
    Hard(
        "load_1_N_3000_rpm",
        "centrifugal force of the rollers lifts the ring: no equilibrium",
        lambda: S(3000.0, 1.0),
        error=LoadError,
        words="axial_load must be at least",
    ),
    Hard(
        "load_1_N",
        "hardly any contact",
        lambda: S(100.0, 1.0),
        duration=0.1,
        compared=0.03,
        # what little is lost hangs on when rollers that hardly touch let go: 0.3 of it between the two tolerances
        tolerances=0.5,
        second="bdf5",
        path=1e-2,
        steps=60.0,
    ),
    Hard(
        "misaligned",
        "peaks of pressure at the edges, as if a quarter of the slices of most rollers carried all",
        lambda: S(3000.0, 4930.0, misalignment_x=3e-3),
    ),
    Hard(
        "skew_at_the_limit",
        "alternate rollers skewed until the bars stop them",
        lambda: from_state(skewed),
        steps=200.0,
        tolerances=0.05,
        compared=5e-3,
        # many impacts: against ERK at 1e-9, BDF of order 2 is off by 6.8e-3, 2.4e-3 and 3.2e-4 at
        # tolerances of 1e-6, 1e-7 and 1e-8, so the two methods converge to one path
        path=1e-2,
        reason=UNDAMPED,
    ),
    Hard(
        "skew_at_the_limit_damped",
        "the same with the damping that contacts have by default",
        lambda: from_state(skewed, effects=trb.Effects.standard()),
        steps=20.0,
        tolerances=0.05,
        compared=5e-3,
        path=1e-2,
    ),
    Hard(
        "one_roller_20_um_larger",
        "one roller carries nearly all",
        lambda: S(bearing=roller(diameter_deviation=(20e-6,) + 11 * (0.0,))),
    ),
    Hard(
        "one_roller_20_um_smaller",
        "one roller never carries",
        lambda: S(bearing=roller(diameter_deviation=(-20e-6,) + 11 * (0.0,))),
        tolerances=0.2,
    ),
    Hard(
        "step_in_diameter",
        "half of the rollers 10 um larger",
        lambda: S(bearing=roller(diameter_deviation=6 * (10e-6,) + 6 * (0.0,))),
        tolerances=0.2,
    ),
    Hard(
        "deep_pits_at_6000_rpm",
        "each roller that passes loses its load and meets the far edge, on either ring; a roller has a pit, too; damped",
        lambda: S(
            6000.0,
            radial_load=2000.0,
            effects=effects(damping="hunt_crossley"),
            defects=tuple(trb.Pit(on=on, length=3e-3, width=12e-3, depth=1e-4) for on in ("outer", "inner", "roller")),
        ),
        duration=0.01,
        steps=60.0,
        tolerances=0.2,
    ),
    Hard(
        "waves_on_everything",
        "30 waves of 2 um on either ring and 9 on the rollers: loads of rollers from zero to twice their mean; damped",
        lambda: S(
            1000.0,
            effects=effects(damping="hunt_crossley"),
            defects=(
                trb.Waviness(on="outer", orders=(30,), amplitudes=(2e-6,)),
                trb.Waviness(on="inner", orders=(30,), amplitudes=(2e-6,)),
                trb.Waviness(on="roller", orders=(9,), amplitudes=(2e-6,)),
            ),
        ),
        duration=0.005,
        steps=60.0,
        tolerances=0.2,
    ),
    Hard(
        "missing_bar",
        "one roller without a bar before it",
        lambda: S(bearing=with_pocket(one_sided_pocket(rig_30310()), 3)),
    ),
    Hard(
        "cage_1_g",
        "a cage lighter than a roller: fast impacts",
        lambda: S(bearing=cage(mass=1e-3, inertia_axial=1.95e-6, inertia_transverse=1.05e-6)),
        steps=60.0,
        tolerances=0.2,
    ),
    Hard(
        "cage_2_5_kg",
        "a cage that rollers can hardly move",
        lambda: S(bearing=cage(mass=2.5, inertia_axial=4.875e-3, inertia_transverse=2.625e-3)),
        tolerances=0.3,
    ),
    Hard(
        "dry_through_zero",
        "Coulomb friction, sliding reversed ten times",
        lambda: S(
            history(*((2e-3 * k, 200.0 * (-1) ** k) for k in range(11))),
            effects=effects(lubrication="dry", traction="coulomb", thermal=False, rolling_resistance=False),
        ),
        duration=0.022,
        steps=60.0,
        tolerances=0.2,
        second="bdf5",
    ),
    Hard(
        "boundary_falling_branch",
        "friction that falls as slip rises: negative damping",
        lambda: from_state(
            slipping(0.02), effects=effects(lubrication="boundary", thermal=False, rolling_resistance=False)
        ),
        steps=60.0,
        tolerances=0.2,
    ),
    Hard(
        "standstill",
        "no speed at all: films, slip ratios and traction at zero; at standard tolerances rollers jitter with 0.1 mJ, where "
        "64 mJ are stored in the contacts",
        lambda: S(0.0, effects=slow_films()),
        duration=0.02,
        accuracy="reference",
        second="bdf5",
        # speeds of 5 mm/s, of the falling cage, at tolerances made for metres a second
        path=2e-2,
    ),
    Hard(
        "standstill_1_N",
        "no speed and hardly a load: each roller weighs ten times what holds it, and falls",
        lambda: S(0.0, 1.0, effects=slow_films()),
        second="bdf5",
        accuracy="reference",
        tolerances=0.1,
        steps=60.0,
        closure=0.1,
        # an energy of 0.7 mJ, at tolerances made for joules: 4.7e-3, 4.2e-4, 3.7e-5 at tolerances of 1e-6, 1e-7, 1e-8
        twin=1e-3,
        # speeds of 5 mm/s: against ERK at 1e-9, BDF of order 2 is off by 1.9e-2, 4.0e-3, 9e-4 at the same tolerances
        path=1e-2,
    ),
    Hard(
        "huge_viscosity",
        "10 Pa s: films of a tenth of a millimetre",
        lambda: S(lubricant=_vg(viscosity=10.0)),
        tolerances=0.2,
    ),
    Hard(
        "barus_overflow",
        "exp(alpha p) beyond any number without its cap",
        lambda: S(3000.0, 140e3, lubricant=_vg(pressure_law="barus", viscosity_exponent_cap=60.0)),
        duration=0.01,
        second="bdf5",
    ),
    Hard("3_rollers", "each holds a third of the ring", lambda: S(bearing=rig_30310().replace(n_rollers=3))),
    Hard(
        "60_rollers",
        "thin rollers, large system",
        lambda: S(bearing=smaller_rollers(60)),
        duration=0.01,
        tolerances=0.2,
        path=1e-2,
    ),
    Hard("1_slice", "a contact that cannot feel tilt", lambda: S(effects=effects(n_slices=1)), tolerances=0.3),
    Hard("200_slices", "many small forces", lambda: S(effects=effects(n_slices=200)), duration=0.01),
    Hard(
        "faces_meet_at_edges",
        "flank across the border of two lands",
        lambda: S(bearing=with_pocket(stepped_pocket(rig_30310(), step=20e-6)), start=trb.Start.whirl(0.9)),
        tolerances=0.2,
    ),
    Hard(
        "chamfered_bars",
        "outlines with eight corners",
        lambda: S(bearing=with_pocket(chamfered_pocket(rig_30310())), start=trb.Start.whirl(0.9)),
        tolerances=0.2,
    ),
    Hard(
        "rollers_in_corners",
        "ends and flanks touch at once, under 50 J of interference",
        lambda: from_state(in_corner),
        # nothing damps the rollers, which bounce between the races at 34 kHz: 800 impacts a millisecond, each of four steps or
        # more; Jacobians and factorisations as often as every fifth step leave the count the same
        steps=200.0,
        compared=5e-3,
        reason=UNDAMPED,
    ),
    Hard(
        "rollers_in_corners_damped",
        "the same with the damping that contacts have by default",
        lambda: from_state(in_corner, effects=trb.Effects.standard()),
        steps=20.0,
        compared=5e-3,
        path=1e-2,
    ),
    Hard(
        "cage_held_by_ends",
        "nothing guides the cage in its plane",
        lambda: S(effects=effects(pocket_bars=False)),
        tolerances=0.2,
    ),
    Hard("no_gravity", "nothing settles the cage", lambda: S(effects=effects(gravity=False))),
    Hard(
        "gravity_times_100",
        "rollers and cage pressed down hard",
        lambda: S(gravity=(0.0, -980.665, 0.0)),
        steps=60.0,
        tolerances=0.2,
    ),
    Hard(
        "soft_traction_modes",
        "modes of 2 to 30 kHz at 1 % damping, over a long run",
        lambda: S(3000.0, 1230.0, start=trb.Start.unequal(1)),
        duration=1.0,
        compared=0.1,
        slow=True,
    ),
    Hard(
        "traction_damping_4e6", "1000 rpm: the stiffest traction", lambda: S(1000.0, 4930.0), duration=0.06, window=2e-4
    ),
    Hard(
        "shock_500_g",
        "500 g for 1 ms",
        lambda: S(gravity=(0.0, SHOCK, 0.0)),
        duration=0.04,
        calm=0.03,
        steps=40.0,
        tolerances=0.2,
    ),
    Hard(
        "deep_interference",
        "starts with 50 um in the outer race: 100 kN a roller",
        lambda: from_state(deep),
        # nothing damps the rollers, which bounce between the races at 30 kHz: 700 impacts a millisecond, each of nine steps.
        # The bounces turn over far more energy than friction takes, so that the closure over the losses is coarse; the run warns
        closure=0.1,
        steps=320.0,
        compared=5e-3,
        path=1e-2,
        window=2e-4,
        reason=UNDAMPED,
    ),
    Hard(
        "deep_interference_damped",
        "the same with Hunt-Crossley damping, which ends the bouncing",
        lambda: from_state(deep, effects=trb.Effects.standard()),
        steps=20.0,
        calm=0.015,
        compared=5e-3,
        path=1e-2,
        window=2e-4,
    ),
    Hard(
        "whirl_standard_damping",
        "impacts with Hunt-Crossley damping",
        lambda: S(effects=trb.Effects.standard(), start=trb.Start.whirl(1.0)),
        duration=0.06,
    ),
    Hard(
        "thousand_revolutions",
        "errors that add up",
        lambda: S(start=trb.Start.whirl(0.9)),
        duration=20.0,
        slow=True,
        compared=0.2,
    ),
    Hard(
        "drag_flooded",
        "a flooded bearing at 12 000 rpm under a light load: drag of newtons slows the rollers, and they slip",
        lambda: S(12000.0, 3000.0, effects=trb.Effects.standard().replace(oil_fill=1.0, drag_coefficient=3.0)),
        compared=5e-3,
    ),
    Hard(
        "pocket_film_thick_oil",
        "pockets full of oil of 1 Pa s, which holds the rollers off the bars of a cage that whirls",
        lambda: S(
            1000.0,
            lubricant=_vg(viscosity=1.0),
            effects=trb.Effects.standard().replace(pocket_film=3e-4),
            start=trb.Start.whirl(0.9),
        ),
    ),
    Hard(
        "pocket_film_smooth_and_fast",
        "a film that begins at 20 um and carries down to 0.05 um, at 12 000 rpm",
        lambda: S(
            12000.0,
            bearing=smooth_pockets(),
            effects=trb.Effects.standard().replace(pocket_film=2e-5),
            start=trb.Start.whirl(0.9),
        ),
        duration=0.03,
    ),
    Hard(
        "land_thick_oil",
        "a heavy cage begins with the film of its land nearly closed, in oil of 1 Pa s and a clearance of 30 um",
        lambda: S(
            300.0,
            bearing=guided({"clearance": 30e-6}, mass=2.0, inertia_axial=3.9e-3, inertia_transverse=2.1e-3),
            lubricant=_vg(viscosity=1.0),
            effects=trb.Effects.standard().replace(guidance="inner_land"),
            start=trb.Start.whirl(0.1187),
        ),
    ),
    Hard(
        "land_without_oil",
        "a starved cage is thrown at the land of the outer ring and rattles on it with friction, tilting",
        lambda: from_state(
            thrown,
            bearing=guided({"fill": 0.0}),
            effects=trb.Effects.standard().replace(guidance="outer_land"),
        ),
    ),
    Hard(
        "free_ring_as_light_as_a_roller",
        "a ring of 25 g, as one roller, between twelve of them",
        lambda: free_ring(0.025),
    ),
    Hard(
        "free_ring_without_load",
        "the load of a free ring drops to zero for 15 ms: the ring floats, falls back upon its rollers and bounces",
        lambda: free_ring(2.0, axial_load=trb.History.step((2e-3, 17e-3), (3000.0, 0.0, 3000.0))),
        duration=0.03,
        compared=2e-3,
    ),
    Hard(
        "free_ring_out_of_balance",
        "an unbalance of 2 kg mm at 10 000 rpm: 2.2 kN that turn with the shaft",
        lambda: free_ring(6.0, 10000.0, unbalance=2e-3, axial_load=8000.0),
    ),
    Hard(
        "free_ring_run_up",
        "from standstill to 6000 rpm within 60 ms by a torque: rollers leave the speed at which their coordinates stand still",
        lambda: free_ring(2.0, 0.0, torque=9.0, axial_load=3000.0),
        duration=0.06,
    ),
    Hard(
        "free_ring_on_a_rotor",
        "a rotor of 300 kg, whose centre of mass lies 20 mm from the rollers' plane, tilts them under its weight",
        lambda: free_ring(300.0, mass_offset=0.02, axial_load=20000.0),
    ),
    Hard(
        "housing_as_light_as_its_ring",
        "an outer ring of 0.3 kg on springs a hundred times softer than the bearing, beside a free inner ring",
        lambda: free_ring(0.7, radial_load=2000.0, housing=housing(0.3, 1e7)),
    ),
    Hard(
        "housing_on_a_shaker",
        "a housing of 40 kg under 20 g at 400 Hz, near its frequency on the support, without any damping of the support",
        lambda: free_ring(
            6.0,
            housing=housing(40.0, 2.5e8),
            gravity=(0.0, trb.History.harmonic(-9.80665, 200.0, frequency_hz=400.0), 0.0),
        ),
    ),
    Hard(
        "hub_in_its_housing",
        "an outer ring of 3 kg that turns at 6000 rpm against the shaft and wobbles on a soft support",
        lambda: free_ring(2.0, outer_speed_rpm=-6000.0, moment_x=20.0, moment_y=0.0, housing=housing(3.0, 3e7)),
    ),
    Hard(
        "elastic_cage_of_plastic",
        "a whirling cage of PA66 at 30 000 rpm, hardly damped: Coriolis forces part its lowest frequencies by a third",
        lambda: elastic_cage(trb.Material.polyamide(), 30000.0),
    ),
    Hard(
        "elastic_cage_of_steel",
        "a cage that collides with its rollers rings at 20 frequencies up to 11 kHz, hardly damped",
        lambda: elastic_cage(trb.Material.steel(), 3000.0),
    ),
    Hard(
        "elastic_cage_with_a_cracked_bar",
        "a bar of a whirling cage is cracked through at one root: it hangs at the other rim, and rollers strike it",
        lambda: elastic_cage(trb.Material.steel(), 3000.0, (5,)),
        slow=True,
    ),
    Hard(
        "cylindrical_without_axial_hold",
        "an NU 210 at 15 000 rpm under 20 kN with 60 um of clearance: half of the rollers are thrown against the outer raceway",
        lambda: cylindrical("NU", 15000.0, 60e-6, radial_load=20000.0, displacement=(None, None, 0.0)),
        slow=True,
    ),
    Hard(
        "cylindrical_on_its_ribs",
        "an NJ 210 that carries 3 kN along its axis and 5 kN across it on a ring tilted by 0.5 mrad: ribs tilt all rollers",
        lambda: cylindrical("NJ", 3000.0, 20e-6, radial_load=5000.0, axial_load=3000.0, misalignment_x=5e-4),
        slow=True,
    ),
)
"""Every hard scene."""
