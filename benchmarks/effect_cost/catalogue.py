"""The effects of a scene: how each is switched off and on, which counters it has, and where its code is.

A patch takes the code of an effect out of a copy of the C sources: pairs of a regular expression and what replaces it, by
file. If the sources change so that an expression does not match, the build says so.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

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
                (r"\n  if \(p->lubrication == TRB_LUBRICATION_MIXED && \(p->mixed.*?\} else \{(.*?)\n  \}\n", r"\1\n"),
            )
        },
    ),
    Effect(
        "film traction",
        "Muraki and Kimura's traction; off: none",
        {"traction": "none"},
        {"traction": "muraki_kimura"},
        counters=("traction_nodes",),
        patch={"contact/passes.h": ((r"if \(p->traction == TRB_TRACTION_MURAKI_KIMURA\) \{.*?\n  \} else ", ""),)},
    ),
    Effect(
        "thermal",
        "thermal reduction of films",
        {"thermal": False},
        {"traction": "muraki_kimura", "thermal": True},
        {"traction": "muraki_kimura"},
        counters=("thermal_nodes",),
        patch={"contact/passes.h": ((r"\n    if \(m->params\.thermal > 0\.0\) \{.*?\n    \}", ""),)},
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
                (r"\n    if \(m->params\.rolling_pressure_force > 0\.0.*?\n    \}", "\n    (void)counters;"),
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
        {KERNEL: ((r"\n    if \(m->params\.rolling_pressure_force > 0\.0.*?\n    \}", "\n    (void)counters;"),)},
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
)
