"""The effects of a scene: how each is switched off and on, which counters it has, and where its code is.

Every field of `trbdyn.Effects` and of `trbdyn.Scene` is in a row of `EFFECTS`, or in `NUMBERS`; a test says which is not.

A patch takes the code of an effect out of a copy of the C sources: pairs of a regular expression and what replaces it, by
file. If the sources change so that an expression does not match, the build says so.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import trbdyn as trb
from trbdyn.model.effects import Effects

NODES: Final = {"quadrature": "gauss", "n_slices": 8}

EVERYTHING: Final = Effects.paper().replace(**NODES, rolling_pressure_force=True, damping="hunt_crossley")
"""All effects of the paper, and the pressure force and damping that it leaves out."""
NOTHING: Final = Effects.frictionless().replace(
    **NODES,
    gravity=False,
    back_rib=False,
    front_rib=False,
    pocket_bars=False,
    pocket_ends=False,
    pocket_edges=False,
)
"""Rollers between raceways, normal contact only, and a cage that nothing touches."""

RING: Final = trb.RingBody(mass=2.0, inertia_axial=2e-3, inertia_transverse=2e-3)

Patch = Mapping[str, tuple[tuple[str, str], ...]]

KERNEL: Final = "contact/raceway_kernel.c"
RIB: Final = "contact/rib_kernel.c"


@dataclass(frozen=True)
class Effect:
    """An effect.

    Attributes
    ----------
    name, text : str
        What it is.
    off : dict
        Changes of `EVERYTHING` that switch it off.
    on : dict
        Changes of `NOTHING` that switch it on.
    needs : dict
        Changes of `NOTHING` without which it cannot be on; what it costs alone is measured against those.
    added : dict
        Changes of `EVERYTHING` that switch on what is off in it; then `off` is empty.
    scene : dict
        Changes of the scene that switch on what is no switch of `Effects`.
    counters : tuple of str
        Counters of the core that must be zero where it is off.
    patch : dict, optional
        Takes its code out; None where no code is left out by the switch.
    """

    name: str
    text: str
    off: Mapping[str, Any]
    on: Mapping[str, Any]
    needs: Mapping[str, Any] = field(default_factory=dict)
    counters: tuple[str, ...] = ()
    patch: Patch | None = None
    added: Mapping[str, Any] = field(default_factory=dict)
    scene: Mapping[str, Any] = field(default_factory=dict)

    @property
    def fields(self) -> dict[str, set[str]]:
        """Fields of `Effects` and of `Scene` that the row switches."""
        scene = {name.partition(".")[0] for name in self.scene} - {"bearing"}
        return {"Effects": {*self.off, *self.on, *self.added}, "Scene": scene}

    @property
    def is_added(self) -> bool:
        """Whether it is off in `EVERYTHING`."""
        return bool(self.added or self.scene)

    def switched_on(self, scene: trb.Scene) -> trb.Scene:
        """A scene that has it, with all others of `EVERYTHING`."""
        return scene.replace({"effects": EVERYTHING.replace(**self.added), **self.scene})

    def switched_off(self, scene: trb.Scene) -> trb.Scene:
        """A scene that has all others of `EVERYTHING`, and not this one."""
        return scene.replace(effects=EVERYTHING.replace(**self.off))

    def alone(self, scene: trb.Scene) -> trb.Scene:
        """A scene that has this one, and of the others what it needs."""
        return scene.replace({"effects": NOTHING.replace(**{**self.needs, **self.added, **self.on}), **self.scene})


EFFECTS: Final = (
    Effect(
        "gravity",
        "weight of rollers and cage",
        {"gravity": False},
        {"gravity": True, "pocket_bars": True},
        {"pocket_bars": True},
        ("gravity_bodies",),
        {
            "body/drive.h": (
                (
                    r"(static inline int trb_has_gravity\(const trb_drive \*drive\)\n\{).*?\n\}",
                    r"\1\n  (void)drive;\n  return 0;\n}",
                ),
            )
        },
    ),
    Effect(
        "cage",
        "the cage and its pockets",
        {"bodies": "rollers"},
        {},
        counters=("pocket_tests", "pocket_nodes", "pocket_culled"),
    ),
    Effect(
        "boundary friction",
        "mixed lubrication's boundary share; off: full film",
        {"lubrication": "full_film"},
        {"lubrication": "mixed", "traction": "muraki_kimura"},
        {"traction": "muraki_kimura"},
        ("boundary_nodes",),
        {
            "contact/passes.h": (
                (
                    r"\n  if \(p->effects\.lubrication == TRB_LUBRICATION_MIXED && \(p->effects.mixed.*?\} else \{(.*?)\n  \}\n",
                    r"\1\n",
                ),
            )
        },
    ),
    Effect(
        "film traction",
        "Muraki and Kimura's traction; off: none",
        {"traction": "none"},
        {"traction": "muraki_kimura"},
        counters=("traction_nodes",),
        patch={
            "contact/passes.h": ((r"if \(p->effects\.traction == TRB_TRACTION_MURAKI_KIMURA\) \{.*?\n  \} else ", ""),)
        },
    ),
    Effect(
        "thermal",
        "thermal reduction of films",
        {"thermal": False},
        {"traction": "muraki_kimura", "thermal": True},
        {"traction": "muraki_kimura"},
        counters=("thermal_nodes",),
        patch={"contact/passes.h": ((r"\n    if \(m->params\.effects\.thermal > 0\.0\) \{.*?\n    \}", ""),)},
    ),
    Effect(
        "rolling resistance",
        "EHL rolling resistance and its pressure force",
        {"rolling_resistance": False, "rolling_pressure_force": False},
        {"rolling_resistance": True},
        counters=("rolling_nodes", "pressure_force_nodes"),
        patch={
            KERNEL: (
                (r"\n  if \(rolling\) \{.*?\n  \}", "\n  (void)rolling;"),
                (r"    sum_rolling\(in, c \* n, n, l, out\);", "    (void)sum_rolling;"),
                (r"\n    if \(m->params\.effects\.rolling_pressure_force > 0\.0.*?\n    \}", "\n    (void)counters;"),
            )
        },
    ),
    Effect(
        "rolling pressure force",
        "pressure force of the rolling film",
        {"rolling_pressure_force": False},
        {"rolling_resistance": True, "rolling_pressure_force": True},
        {"rolling_resistance": True},
        ("pressure_force_nodes",),
        {
            KERNEL: (
                (r"\n    if \(m->params\.effects\.rolling_pressure_force > 0\.0.*?\n    \}", "\n    (void)counters;"),
            )
        },
    ),
    Effect(
        "damping",
        "normal damping by films",
        {"damping": "off"},
        {"damping": "film"},
        counters=("damping_nodes",),
        patch={
            KERNEL: ((r"\n    if \(m->contact_damping > 0\.0\) \{.*?\n    \}", ""),),
            RIB: (
                (r"\n  if \(m->contact_damping > 0\.0\) load \*= [^\n]*", ""),
                (r"\n  if \(m->contact_damping > 0\.0\) counters[^\n]*", ""),
            ),
            "contact/friction.h": (
                (
                    r"return load \* trb_max\(1\.0 \+ coefficient \* rate, 0\.0\);",
                    "(void)coefficient, (void)rate; return load;",
                ),
            ),
        },
    ),
    Effect(
        "back rib",
        "large ends on the back-face rib",
        {"back_rib": False},
        {"back_rib": True},
        counters=("rib_tests", "rib_contacts"),
    ),
    Effect(
        "front rib",
        "small ends on the front rib",
        {"front_rib": False},
        {"front_rib": True},
        counters=("front_rib_tests", "front_rib_contacts"),
    ),
    Effect(
        "rib film",
        "the thicker of two films at the rib; off: piezoviscous-elastic",
        {"rib_film": "pe"},
        {"back_rib": True},
        {"back_rib": True, "rib_film": "pe"},
    ),
    Effect("pocket bars", "flanks on the bars of their pockets", {"pocket_bars": False}, {"pocket_bars": True}),
    Effect("pocket ends", "ends on the walls of their pockets", {"pocket_ends": False}, {"pocket_ends": True}),
    Effect(
        "pocket edges",
        "faces of pockets end at their outlines; off: unbounded planes",
        {"pocket_edges": False},
        {"pocket_edges": True, "pocket_bars": True, "pocket_ends": True},
        {"pocket_bars": True, "pocket_ends": True},
    ),
    Effect(
        "space",
        "axial motion and tilts; off: planar, they are frozen",
        {"planar": True},
        {"planar": False},
        {"planar": True},
        patch=None,
    ),
    Effect(
        "exponential mixing",
        "share of asperities by an exponential; off: a sixth power",
        {},
        {},
        {"traction": "muraki_kimura", "lubrication": "mixed"},
        added={"mixed_law": "exponential"},
        patch={
            "contact/passes.h": (
                (
                    r"\n  if \(m->params\.effects\.mixed_law > 0\.0\) \{.*?\} else \{(.*?)\n  \}",
                    r"\1\n  (void)b, (void)c;",
                ),
                (r"\(p->effects\.mixed_law > 0\.0 \|\| (thinnest\(n, l\) < p->friction\.lambda_full)\)", r"\1"),
            )
        },
    ),
    Effect(
        "supply",
        "share of rolling resistance that the supply of oil leaves",
        {},
        {},
        {"rolling_resistance": True},
        added={"supply": 0.83},
    ),
    Effect(
        "replenishment",
        "fast rollers leave less oil behind",
        {},
        {},
        {"rolling_resistance": True},
        added={"replenishment": "bath"},
    ),
    Effect(
        "oil height",
        "supply by the place of the meniscus",
        {},
        {},
        {"rolling_resistance": True},
        added={"oil_height": 2e-5},
        counters=("meniscus_nodes",),
    ),
    Effect(
        "flooded gaps",
        "gaps beside the loaded part resist rolling",
        {},
        {},
        {"rolling_resistance": True},
        added={"flooded_gaps": True},
        counters=("gap_nodes",),
    ),
    Effect(
        "hysteresis",
        "elastic hysteresis of the steel",
        {},
        {},
        {"rolling_resistance": True},
        added={"hysteresis": 0.01},
        counters=("hysteresis_nodes",),
    ),
    Effect(
        "thermal law",
        "heat of the inlet by Aihara; off: by Gupta",
        {},
        {},
        {"traction": "muraki_kimura", "thermal": True},
        added={"thermal_law": "aihara"},
    ),
    Effect(
        "rolling law",
        "rolling resistance by numerical solutions; off: Zhou and Hoeprich",
        {},
        {},
        {"rolling_resistance": True},
        added={"rolling_law": "line_solution", "rolling_load": "contact"},
    ),
    Effect(
        "film damping",
        "damping of raceways and ribs by their films; off: constant",
        {},
        {},
        {},
        added={"damping": "film"},
    ),
    Effect(
        "rib turning", "sliding turns within the rib's contact", {}, {}, {"back_rib": True}, added={"rib_turning": True}
    ),
    Effect(
        "pocket film",
        "film of the oil between roller and bar",
        {},
        {},
        {"pocket_bars": True, "gravity": True},
        added={"pocket_film": 5e-5},
        counters=("pocket_films",),
        patch={
            "contact/pocket.c": (
                (r", reach = p->pockets->film;", ", reach = 0.0;"),
                (r"\n    if \(reach > 0\.0\) trb_pocket_push_film\([^;]*;", ""),
                (r"is_flank \? p->pockets->film : 0\.0", "0.0"),
            ),
            "contact/facets.h": ((r" - p->pockets->film", ""),),
        },
    ),
    Effect(
        "drag",
        "drag of the oil on rollers and cage",
        {},
        {},
        {},
        added={"oil_fill": 0.1},
        counters=("drag_rollers", "drag_cages"),
    ),
    Effect(
        "guiding land",
        "a land of the inner ring guides the cage",
        {},
        {},
        {},
        added={"guidance": "inner_land"},
        counters=("land_films", "land_contacts"),
    ),
    Effect(
        "spacer",
        "a spacer in place of the cage",
        {},
        {},
        {},
        added={"bodies": "rollers_and_spacer"},
        counters=("spacers",),
    ),
    Effect(
        "elastic cage",
        "six natural modes of the cage",
        {},
        {},
        scene={
            "bearing": trb.cases.rig_30310().replace({"cage.body": trb.cases.cage_body_30310()}),
            "elastic_cage": trb.ElasticCage(n_modes=6),
        },
    ),
    Effect(
        "uneven surfaces",
        "waves of the inner raceway",
        {},
        {},
        scene={"defects": (trb.Waviness(on="inner", orders=(12,), amplitudes=(3e-7,)),)},
        counters=("uneven_contacts",),
        patch={
            "contact/raceway.c": ((r"\n *if \(at->spin != NULL\) add_uneven\([^\n]*", ""),),
            KERNEL: (
                (r"\n    if \(in->uneven != NULL\) [^\n]*", ""),
                (r"\n    if \(inputs\[c\]\.uneven != NULL\) [^\n]*", ""),
            ),
            "motion/rhs.c": ((r"  if \(d->spin == NULL\) return 0;.*?\n  return 0;", "  (void)m;\n  return 0;"),),
        },
    ),
    Effect("free ring", "the inner ring moves with its mass", {}, {}, scene={"ring": "free", "ring_body": RING}),
    Effect(
        "housing",
        "the outer ring moves with its housing",
        {},
        {},
        scene={
            "ring": "free",
            "ring_body": RING,
            "housing": trb.Housing(
                mass=5.0,
                inertia_axial=1e-2,
                inertia_transverse=1e-2,
                support_radial=1e8,
                support_axial=1e8,
                support_tilt=1e5,
            ),
        },
    ),
)

NUMBERS: Final = {
    "Effects": frozenset(
        {
            *("starvation_factor", "drag_coefficient", "film_damping", "film_damping_depth", "damping_race"),
            *("damping_cage", "quadrature", "n_slices", "friction"),
        }
    ),
    "Scene": frozenset(
        {
            *("bearing", "speed_rpm", "outer_speed_rpm", "axial_load", "radial_load", "radial_direction_deg"),
            *("misalignment_x", "misalignment_y", "moment_x", "moment_y", "rotating_load", "displacement", "unloaded"),
            *("lubricant", "effects", "start", "torque", "growth", "gravity"),
        }
    ),
}
"""Fields that are numbers, loads, motions or parts of a scene, and no effects that are on or off."""
