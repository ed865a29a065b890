"""Random scenes over the whole admitted space, each from a seed. A scene is a flat table, so that it can be kept and shrunk."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import trbdyn as trb
from trbdyn.model.cases import bearing_32216, bearing_nj210, cage_body_30310, rig_30310
from trbdyn.model.lubricants import iso_vg, vg100

Table = dict[str, Any]

ORDINARY: Table = {
    "bearing": "30310",
    "speed_rpm": 3000.0,
    "axial_load": 4930.0,
    "radial_share": 0.0,
    "direction_deg": 90.0,
    "temperature_c": 60.0,
    "effects": "paper",
    "accuracy": "standard",
    "start": "equal",
    "seed": 0,
    "eccentricity": 0.9,
    "start_time": 0.0,
    "nodes": 8,
    "gravity": True,
    "misalignment_x": 0.0,
    "misalignment_y": 0.0,
    "displacement_x": None,
    "displacement_y": 0.0,
    "displacement_z": 0.0,
    "cage_mass": 1.0,
    "play": 1.0,
    "scatter": 0.0,
    "damping": None,
    "film_damping": None,
    "film_damping_depth": 3e-7,
    "starvation": 1.0,
    "lubrication": None,
    "traction": None,
    "thermal": None,
    "rolling_resistance": None,
    "back_rib": None,
    "front_rib": None,
    "planar": None,
    "dry_friction": None,
    "coulomb_speed": None,
    "end_speed_rpm": None,
    "end_axial_load": None,
    "history_s": 0.005,
    "drop_share": None,
    "drop_rise": 1e-3,
    "oil": None,
    "oil_fill": 0.0,
    "pocket_film": 0.0,
    "rotating_share": 0.0,
    "rotating_turns": 1.0,
    "repeating": None,
    "repeating_hz": 50.0,
    "repeating_share": 0.2,
    "pieces": 1,
    "duration_s": None,
    "guidance": "rollers",
    "land_clearance": 1.0,
    "land_film": 1.0,
    "land_fill": 1.0,
    "outer_speed_rpm": 0.0,
    "ring_mass": None,
    "ring_length": 1.0,
    "ring_offset": 0.0,
    "unbalance_share": 0.0,
    "ring_damping": 0.0,
    "support_stiffness": None,
    "support_tilt": 1.0,
    "support_position": 0.0,
    "moment_share": 0.0,
    "torque": None,
    "housing_mass": None,
    "housing_length": 1.0,
    "housing_offset": 0.0,
    "housing_stiffness": 3e8,
    "housing_damping": 0.0,
    "elastic_modes": None,
    "cage_material": "steel",
    "rim_width": 1.0,
    "cracked_bars": 0,
    "pit_on": None,
    "pit_length": 2e-3,
    "pit_depth": 30e-6,
    "pit_angle_deg": 0.0,
    "waves_on": None,
    "waves": 12,
    "wave_height": 3e-7,
    "flanges": None,
    "axial_share": 0.0,
    "radial_clearance": 20e-6,
    "rib_clearance": 16e-6,
    "end_radius": 0.55,
}
"""What a table that says nothing means; shrinking a failure leads back to these."""

CATALOGUE: dict[str, Table] = {
    "30205": {"bore": 0.025, "outside": 0.052, "width": 0.01625, "C": 30.8e3, "e": 0.37},
    "32008": {"bore": 0.040, "outside": 0.068, "width": 0.019, "C": 52.8e3, "e": 0.37},
    "33213": {"bore": 0.065, "outside": 0.120, "width": 0.041, "C": 194e3, "e": 0.40},
    "1 m": {"bore": 0.6, "outside": 1.0, "width": 0.25, "C": 7.1e6, "e": 0.43},
}
"""Bearings of catalogue pages; loads, displacements and speeds of a table are scaled to them."""
SCALED = ("play_radial", "play_circumferential", "play_axial")


def usual(rng: np.random.Generator) -> Table:
    """A scene of practice: shipped bearings at 1 to 20 000 rpm, 0.5 to 32 kN, oil at 10 to 110 C, two presets of effects."""
    table = {
        "bearing": _one_of(rng, "30310", "32216"),
        "speed_rpm": _log(rng, 1.0, 2e4),
        "axial_load": _log(rng, 500.0, 32e3),
        "temperature_c": float(rng.uniform(10.0, 110.0)),
        "effects": _one_of(rng, "paper", "standard"),
    }
    if rng.random() < 0.5:
        table |= {"radial_share": float(rng.uniform(0.05, 0.95)), "direction_deg": float(rng.uniform(-180.0, 180.0))}
    table |= _start(rng)
    return table


def wide(rng: np.random.Generator) -> Table:
    """Anything that a scene admits: very slow and very fast, held rings, histories, odd clearances, every switch."""
    table = usual(rng)
    table["speed_rpm"] = _log(rng, 0.01, 1e5) * _one_of(rng, 1.0, 1.0, 1.0, -1.0)
    table["accuracy"] = _one_of(rng, "fast", "standard", "standard", "reference")
    table["effects"] = _one_of(rng, "paper", "standard", "paper", "standard", "minimal", "frictionless")
    if rng.random() < 0.2:
        table |= {
            "displacement_x": float(rng.uniform(-80e-6, 80e-6)),
            "displacement_y": float(rng.uniform(-80e-6, 80e-6)),
            "displacement_z": float(rng.uniform(-60e-6, 80e-6)),
            "radial_share": 0.0,
        }
    options: dict[str, Any] = {
        "misalignment_x": lambda: float(rng.uniform(-2e-3, 2e-3)),
        "misalignment_y": lambda: float(rng.uniform(-2e-3, 2e-3)),
        "gravity": lambda: False,
        "cage_mass": lambda: _log(rng, 0.01, 20.0),
        "play": lambda: _log(rng, 0.2, 4.0),
        "scatter": lambda: _log(rng, 1e-7, 2e-5),
        "damping": lambda: _log(rng, 1e-3, 10.0),
        "starvation": lambda: _log(rng, 0.01, 1.0),
        "lubrication": lambda: _one_of(rng, "mixed", "full_film", "boundary", "dry"),
        "traction": lambda: _one_of(rng, "muraki_kimura", "coulomb", "none"),
        "thermal": lambda: bool(rng.random() < 0.5),
        "rolling_resistance": lambda: bool(rng.random() < 0.5),
        "back_rib": lambda: False,
        "front_rib": lambda: False,
        "planar": lambda: True,
        "dry_friction": lambda: _log(rng, 0.005, 0.5),
        "coulomb_speed": lambda: _log(rng, 1e-5, 0.1),
        "nodes": lambda: int(rng.integers(2, 40)),
    }
    for name, draw in options.items():
        if rng.random() < 0.12:
            table[name] = draw()
    if rng.random() < 0.12:
        table |= {
            "end_speed_rpm": table["speed_rpm"] * float(rng.uniform(-1.0, 2.0)),
            "history_s": _log(rng, 1e-4, 2e-2),
        }
    elif rng.random() < 0.08 and table.get("displacement_x") is None:
        table |= {
            "end_axial_load": table["axial_load"] * float(rng.uniform(0.7, 2.0)),
            "history_s": _log(rng, 1e-3, 2e-2),
        }
    # drawn last, so that a seed's other entries stay what they were
    if rng.random() < 0.15:
        table["bearing"] = _one_of(rng, *CATALOGUE)
    if rng.random() < 0.12:
        table["oil"] = _one_of(rng, 32, 68, 220, 460)
    if rng.random() < 0.12:
        table["oil_fill"] = _log(rng, 1e-3, 1.0)
    if rng.random() < 0.1 and table.get("displacement_x") is None and table.get("end_speed_rpm") is None:
        table |= {"rotating_share": _log(rng, 1e-2, 0.5), "rotating_turns": float(rng.uniform(-2.0, 3.0))}
    return table


def guided(rng: np.random.Generator) -> Table:
    """As `wide`, with a cage that a land of a ring guides."""
    return wide(rng) | {
        "guidance": _one_of(rng, "inner_land", "outer_land"),
        "land_clearance": _log(rng, 0.1, 5.0),
        "land_film": _log(rng, 0.1, 10.0),
        "land_fill": float(rng.uniform(0.0, 1.0)),
    }


def filmed(rng: np.random.Generator) -> Table:
    """Films between rollers and pockets, from a trace of oil to full pockets."""
    table = _one_of(rng, usual, wide, guided)(rng)
    return table | {"pocket_film": _log(rng, 2e-6, 5e-4), "lubrication": _one_of(rng, None, "full_film")}


def light(rng: np.random.Generator) -> Table:
    """Rollers that hardly any load holds: 10 to 1500 N, half of them combined, half of them in oil that drags, every preset."""
    table: Table = {
        "bearing": _one_of(rng, "30310", "32216"),
        "speed_rpm": _log(rng, 200.0, 4000.0),
        "axial_load": _log(rng, 10.0, 1500.0),
        "temperature_c": float(rng.uniform(30.0, 90.0)),
        "effects": "standard",
        "accuracy": _one_of(rng, "fast", "fast", "standard", "reference"),
    }
    if rng.random() < 0.5:
        table |= {"radial_share": float(rng.uniform(0.1, 0.95)), "direction_deg": float(rng.uniform(-180.0, 180.0))}
    if rng.random() < 0.5:
        table["oil_fill"] = _log(rng, 1e-2, 0.5)
    return table | _start(rng)


def damped(rng: np.random.Generator) -> Table:
    """Films that damp raceways and ribs from a hundredth to ten times as much as usual, and from other interferences on."""
    table = _one_of(rng, usual, light, cylindrical)(rng)
    return table | {
        "effects": "standard",
        "film_damping": _log(rng, 1e-7, 1e-4),
        "film_damping_depth": _log(rng, 1e-8, 1e-5),
    }


def repeating(rng: np.random.Generator) -> Table:
    """Speeds and loads that repeat, and loads that rotate, without end; runs that begin before t = 0 or long after it."""
    table = usual(rng) | {"speed_rpm": _log(rng, 100.0, 6000.0), "accuracy": _one_of(rng, "fast", "standard")}
    what = _one_of(rng, "speed", "axial_load", "rotating")
    if what == "rotating":
        table |= {"rotating_share": _log(rng, 1e-2, 0.9), "rotating_turns": float(rng.uniform(-2.0, 3.0))}
    else:
        table |= {
            "repeating": what,
            "repeating_hz": _log(rng, 2.0, 500.0),
            "repeating_share": _log(rng, 0.01, 0.5 if what == "speed" else 0.3),
        }
    if rng.random() < 0.4:
        table["start_time"] = _one_of(rng, -_log(rng, 1e-5, 0.02), -_log(rng, 1e-5, 0.02), _log(rng, 1e3, 9e5))
    return table


def pieces(rng: np.random.Generator) -> Table:
    """One simulation that is run in many short pieces."""
    table = _one_of(rng, light, light, wide)(rng)
    return table | {"pieces": int(rng.integers(4, 17))}


def free(rng: np.random.Generator) -> Table:
    """A ring that is a body: light or heavy, out of balance, off its centre, turned by a torque, under loads that come and go."""
    table = _one_of(rng, usual, light, guided)(rng)
    for name in ("displacement_x", "misalignment_x", "misalignment_y", "end_speed_rpm", "end_axial_load"):
        table.pop(name, None)
    table |= {"speed_rpm": _log(rng, 10.0, 1e4), "ring_mass": _log(rng, 0.1, 300.0), "rotating_share": 0.0}
    options: dict[str, Any] = {
        "ring_length": lambda: _log(rng, 0.3, 10.0),
        "ring_offset": lambda: float(rng.uniform(-0.1, 0.1)),
        "unbalance_share": lambda: _log(rng, 1e-3, 0.3),
        "ring_damping": lambda: _log(rng, 1.0, 1e5),
        "moment_share": lambda: float(rng.uniform(-0.3, 0.3)),
        "end_axial_load": lambda: table["axial_load"] * _one_of(rng, 0.0, float(rng.uniform(0.2, 2.0))),
    }
    for name, draw in options.items():
        if rng.random() < 0.3:
            table[name] = draw()
    if "end_axial_load" in table:
        table["history_s"] = _log(rng, 1e-3, 2e-2)
    if rng.random() < 0.25:
        table |= {"torque": float(rng.uniform(-0.5, 2.0)), "unbalance_share": 0.0}
    return table


def outer(rng: np.random.Generator) -> Table:
    """An outer ring that turns, with the inner ring, against it, or alone."""
    table = _one_of(rng, usual, light, guided, free)(rng)
    table |= {"outer_speed_rpm": _log(rng, 10.0, 1e4) * _one_of(rng, -1.0, 1.0), "oil_fill": 0.0}
    if rng.random() < 0.3:
        table |= {"speed_rpm": 0.0, "rotating_share": 0.0}
        table.pop("end_speed_rpm", None)
    return table


def housed(rng: np.random.Generator) -> Table:
    """An outer ring that moves with its housing: light or heavy, on soft or stiff springs, beside a ring that is held or free."""
    table = _one_of(rng, usual, light, guided, free, outer)(rng)
    if "ring_mass" not in table:
        for name in ("end_axial_load", "rotating_share"):
            table.pop(name, None)
    table |= {"speed_rpm": _log(rng, 10.0, 1e4), "housing_mass": _log(rng, 0.2, 300.0)}
    options: dict[str, Any] = {
        "housing_stiffness": lambda: _log(rng, 1e6, 1e10),
        "housing_length": lambda: _log(rng, 0.3, 5.0),
        "housing_offset": lambda: float(rng.uniform(-0.1, 0.1)),
        "housing_damping": lambda: _log(rng, 1.0, 1e5),
    }
    for name, draw in options.items():
        if rng.random() < 0.5:
            table[name] = draw()
    return table


def pitted(rng: np.random.Generator) -> Table:
    """Surfaces off their true form: a pit, short or long, shallow or deep, waves, or both, whatever the rings do."""
    table = _one_of(rng, usual, light, wide, guided, free, outer, housed)(rng)
    what = _one_of(rng, "pit", "pit", "waves", "both")
    if what != "waves":
        table |= {
            "pit_on": _one_of(rng, "outer", "inner", "roller"),
            "pit_length": _log(rng, 3e-4, 1e-2),
            "pit_depth": _log(rng, 1e-6, 3e-4),
            "pit_angle_deg": float(rng.uniform(0.0, 360.0)),
        }
    if what != "pit":
        table |= {
            "waves_on": _one_of(rng, "outer", "inner", "roller"),
            "waves": int(_log(rng, 1.0, 60.0)),
            "wave_height": _log(rng, 1e-8, 3e-6),
        }
    return table


def supported(rng: np.random.Generator) -> Table:
    """A free ring whose shaft a spring holds, soft or stiff, with or without stiffness against tilt, near it or far from it."""
    return free(rng) | {
        "support_stiffness": _log(rng, 1e5, 1e9),
        "support_tilt": _one_of(rng, 0.0, _log(rng, 0.01, 10.0)),
        "support_position": float(rng.uniform(-0.2, 0.2)),
    }


def drop(rng: np.random.Generator) -> Table:
    """A load that goes in part or whole and comes back, or rises to some times its size, within 0.1 ms to some milliseconds."""
    table = _one_of(rng, usual, light, guided, free, supported, housed)(rng)
    for name in ("displacement_x", "end_speed_rpm", "end_axial_load", "rotating_share"):
        table.pop(name, None)
    table |= {
        "speed_rpm": _log(rng, 30.0, 8000.0),
        "drop_share": _one_of(rng, 0.0, float(rng.uniform(0.0, 0.5)), _log(rng, 1.2, 5.0)),
        "history_s": _log(rng, 2e-3, 3e-2),
    }
    if "housing_mass" in table:
        table.setdefault("ring_mass", _log(rng, 0.1, 300.0))  # a load that changes then moves both rings
    return table | {"drop_rise": _log(rng, 1e-4, 0.3 * table["history_s"])}


def elastic(rng: np.random.Generator) -> Table:
    """A cage that deforms: steel or polyamide, narrow or wide rims, a few modes or many, whole or with cracked bars."""
    table = _one_of(rng, usual, light, wide, free, outer, housed, drop)(rng)
    for name in ("cage_mass", "guidance", "land_clearance", "land_film", "land_fill"):
        table.pop(name, None)
    return table | {
        "bearing": "30310",
        "planar": False,
        "elastic_modes": int(_log(rng, 1.0, 25.0)),
        "cage_material": _one_of(rng, "steel", "polyamide"),
        "rim_width": _log(rng, 0.6, 1.5),
        "cracked_bars": _one_of(rng, 0, 0, 0, 1, 2),
    }


def hub(rng: np.random.Generator) -> Table:
    """A wheel hub: the outer ring turns, the inner ring is at rest, on an axle of its own or driven by a torque from there on."""
    table = _one_of(rng, usual, light, free, supported, housed, drop, elastic)(rng)
    for name in ("end_speed_rpm", "rotating_share", "unbalance_share", "torque"):
        table.pop(name, None)
    table |= {"speed_rpm": 0.0, "outer_speed_rpm": _log(rng, 10.0, 3000.0) * _one_of(rng, -1.0, 1.0), "oil_fill": 0.0}
    if "ring_mass" in table and rng.random() < 0.3:
        table["torque"] = float(rng.uniform(-0.5, 0.5))
    return table


def cylindrical(rng: np.random.Generator) -> Table:
    """Cylindrical rollers: all types of ribs, loose or tight, round or nearly flat ends. The load that others have along the axis
    acts across it, and a share of it along the axis where ribs can carry it.
    """
    table = _one_of(rng, usual, light, wide, guided, filmed, free, outer, housed, pitted, drop, hub)(rng)
    for name in ("displacement_x", "back_rib", "elastic_modes"):
        table.pop(name, None)
    table |= {"flanges": _one_of(rng, "NU", "NJ", "NUP", "N"), "bearing": "nj210"}
    if table["flanges"] in ("NJ", "NUP"):
        table |= {"axial_share": _log(rng, 0.01, 0.5), "front_rib": True}
    options: dict[str, Any] = {
        "radial_clearance": lambda: _one_of(rng, 0.0, _log(rng, 1e-6, 2e-4), -_log(rng, 1e-6, 4e-5)),
        "rib_clearance": lambda: _one_of(rng, 0.0, _log(rng, 1e-6, 3e-4)),
        "end_radius": lambda: _log(rng, 0.03, 20.0),
    }
    for name, make_one in options.items():
        if rng.random() < 0.4:
            table[name] = make_one()
    return table


KINDS = {
    "supported": supported,
    "drop": drop,
    "elastic": elastic,
    "hub": hub,
    "cylindrical": cylindrical,
    "pitted": pitted,
    "housed": housed,
    "outer": outer,
    "free": free,
    "usual": usual,
    "wide": wide,
    "guided": guided,
    "filmed": filmed,
    "light": light,
    "damped": damped,
    "repeating": repeating,
    "pieces": pieces,
}


def draw(kind: str, seed: int) -> Table:
    """The scene of a seed."""
    return KINDS[kind](np.random.default_rng([seed, sum(kind.encode())]))


def make(table: Table) -> trb.Scene:
    """The scene that a table stands for.

    Raises
    ------
    TrbError
        If it is refused.
    """
    t = ORDINARY | table
    bearing = _bearing(t)
    if t["bearing"] in CATALOGUE:
        # what means the same for a bearing of another size: load by the rating, speed and displacement by the pitch diameter
        load, length = CATALOGUE[t["bearing"]]["C"] / 130e3, bearing.pitch_diameter / 0.08
        scales = {"speed_rpm": 1.0 / length, "end_speed_rpm": 1.0 / length, "axial_load": load, "end_axial_load": load}
        scales |= {f"displacement_{axis}": length for axis in "xyz"}
        t |= {name: t[name] * scale for name, scale in scales.items() if t[name] is not None}
    fields: Table = {
        "lubricant": vg100(t["temperature_c"]) if t["oil"] is None else iso_vg(t["oil"], t["temperature_c"]),
        "effects": _effects(t),
        "speed_rpm": _quantity(t, "speed", t["speed_rpm"], t["end_speed_rpm"]),
        "outer_speed_rpm": t["outer_speed_rpm"] * (0.08 / bearing.pitch_diameter if t["bearing"] in CATALOGUE else 1.0),
        "misalignment_x": t["misalignment_x"],
        "misalignment_y": t["misalignment_y"],
    }
    if t["flanges"] is not None:
        fields |= _across(t)
    elif t["displacement_x"] is not None:
        fields["displacement"] = (t["displacement_x"], t["displacement_y"], t["displacement_z"])
    else:
        slope = math.tan(math.radians(bearing.cup_half_angle_deg))
        lowest = min(t["axial_load"], (t["ring_mass"] is None and t["end_axial_load"]) or math.inf)
        if t["repeating"] == "axial_load":
            lowest *= 1.0 - t["repeating_share"]
        fields |= {
            "axial_load": _quantity(t, "axial_load", t["axial_load"], t["end_axial_load"]),
            "radial_load": _quantity(t, "radial_load", t["radial_share"] * lowest / slope, None),
            "radial_direction_deg": t["direction_deg"],
        }
        if t["rotating_share"] > 0.0:
            fields["rotating_load"] = trb.RotatingLoad(t["rotating_share"] * lowest / slope, turns=t["rotating_turns"])
        if _follows(t):
            fields["ring"] = "follows"
    if t["ring_mass"] is not None:
        fields |= _free_ring(t, bearing)
    if t["housing_mass"] is not None:
        fields["housing"] = _housing(t, bearing)
    if t["drop_share"] is not None and t["ring_mass"] is None and t["flanges"] is None:
        fields["unloaded"] = "rests"
    fields["elastic_cage"] = _elastic_cage(t)
    fields["defects"] = _defects(t, bearing)
    return trb.Scene(bearing, start=_start_of(t), **fields)


def _across(t: Table) -> Table:
    """Loads of a cylindrical bearing, and what holds its ring along the axis where no rib does."""
    fields: Table = {
        "radial_load": _quantity(t, "axial_load", t["axial_load"], t["end_axial_load"]),
        "radial_direction_deg": t["direction_deg"],
    }
    if t["axial_share"] > 0.0:
        fields["axial_load"] = t["axial_share"] * t["axial_load"]
    elif t["ring_mass"] is None:
        fields["displacement"] = (None, None, t["displacement_z"])
    if t["rotating_share"] > 0.0:
        fields["rotating_load"] = trb.RotatingLoad(t["rotating_share"] * t["axial_load"], turns=t["rotating_turns"])
    if _follows(t):
        fields["ring"] = "follows"
    return fields


def _follows(t: Table) -> bool:
    """Whether a ring without mass has a load that changes."""
    changes = t["end_axial_load"] is not None or t["drop_share"] is not None or t["repeating"] == "axial_load"
    return bool(changes or t["rotating_share"] > 0.0)


def _free_ring(t: Table, bearing: trb.Bearing) -> Table:
    """A shaft as thick as half the pitch diameter; its mass, its torque and its moments go with the bearing's size and load."""
    pitch = bearing.pitch_diameter
    size = pitch / 0.08
    mass, speed = t["ring_mass"] * size**3, abs(t["speed_rpm"]) * math.pi / 30.0
    body = trb.RingBody.hollow_cylinder(
        mass=mass, outer_diameter=0.5 * pitch, length=t["ring_length"] * pitch, mass_offset=t["ring_offset"] * size
    )
    body = body.replace(
        unbalance=t["unbalance_share"] * t["axial_load"] / max(speed, 10.0) ** 2, damping=t["ring_damping"]
    )
    if t["support_stiffness"] is not None:
        stiffness = t["support_stiffness"] * size
        body = body.replace(
            support_radial=stiffness,
            support_axial=0.5 * stiffness,
            support_tilt=t["support_tilt"] * stiffness * (0.5 * pitch) ** 2,
            support_position=t["support_position"] * size,
        )
    if t["flanges"] is not None and t["axial_share"] == 0.0:
        body = body.replace(support_axial=1e7 * size)
    moment = t["moment_share"] * t["axial_load"] * 0.1 * pitch
    torque = None if t["torque"] is None else t["torque"] * 5e-3 * t["axial_load"] * pitch
    return {"ring": "free", "ring_body": body, "moment_x": moment, "moment_y": 0.0, "torque": torque}


def _housing(t: Table, bearing: trb.Bearing) -> trb.Housing:
    """A block around the outer ring; its mass, its springs and its damper go with the size of the bearing."""
    pitch = bearing.pitch_diameter
    size = pitch / 0.08
    mass, stiffness = t["housing_mass"] * size**3, t["housing_stiffness"] * size
    block = trb.Housing.hollow_cylinder(
        mass=mass,
        inner_diameter=1.3 * pitch,
        outer_diameter=2.0 * pitch,
        length=t["housing_length"] * pitch,
        mass_offset=t["housing_offset"] * size,
    )
    springs = {
        "support_radial": stiffness,
        "support_axial": 0.5 * stiffness,
        "support_tilt": stiffness * (0.5 * pitch) ** 2,
    }
    return block.replace(damping=t["housing_damping"] * size**2, **springs)


def _defects(t: Table, bearing: trb.Bearing) -> tuple[trb.Pit | trb.Waviness, ...]:
    """A pit over half of a roller's length, and waves as high as rollers of the bearing can follow; both go with its size."""
    size, found = bearing.pitch_diameter / 0.08, []
    if t["pit_on"] is not None:
        width = 0.5 * bearing.roller.effective_length
        place = {"on": t["pit_on"], "angle_deg": t["pit_angle_deg"]}
        found.append(
            trb.Pit(length=t["pit_length"] * size, width=width, depth=min(t["pit_depth"] * size, 1e-3), **place)
        )
    if t["waves_on"] is not None:
        steepest = 0.05 * (bearing.roller.diameter if t["waves_on"] == "roller" else bearing.pitch_diameter)
        height = min(t["wave_height"], steepest / t["waves"] ** 2)
        waves = trb.Waviness(on=t["waves_on"], orders=(t["waves"],), amplitudes=(height,), seed=t["seed"])
        return (*found, waves)
    return tuple(found)


def _bearing(t: Table) -> trb.Bearing:
    if t["bearing"] in CATALOGUE:
        bearing = trb.Bearing.from_catalogue(**CATALOGUE[t["bearing"]], name=t["bearing"])
    elif t["flanges"] is not None:
        bearing = bearing_nj210()
        ribs = bearing.ribs.replace(flanges=t["flanges"], clearance=t["rib_clearance"])
        roller = bearing.roller.replace(end_radius=t["end_radius"])
        bearing = bearing.replace(ribs=ribs, roller=roller, radial_clearance=t["radial_clearance"])
    else:
        bearing = rig_30310() if t["bearing"] == "30310" else bearing_32216()
    cage = bearing.cage
    weights = {name: getattr(cage, name) * t["cage_mass"] for name in ("mass", "inertia_axial", "inertia_transverse")}
    plays = {name: getattr(cage, name) * t["play"] for name in SCALED}
    cage = cage.replace(**weights, **plays) if t["elastic_modes"] is None else _cage_of_beams(t, plays)
    roller = bearing.roller
    if t["scatter"] > 0.0:
        deviations = np.random.default_rng(t["seed"]).uniform(-0.5, 0.5, bearing.n_rollers) * t["scatter"]
        roller = roller.replace(diameter_deviation=tuple(deviations.tolist()))
    land = bearing.land
    land = land.replace(
        clearance=land.clearance * t["land_clearance"],
        contact_film=land.contact_film * t["land_clearance"] * t["land_film"],
        fill=t["land_fill"],
    )
    return bearing.replace(cage=cage, roller=roller, land=land)


def _cage_of_beams(t: Table, plays: dict[str, float]) -> trb.Cage:
    """The cage of the 30310 with rims and bars of a material, from which its mass and its modes follow."""
    body = cage_body_30310()
    rims = {name: getattr(body, name) * t["rim_width"] for name in ("small_rim_width", "large_rim_width")}
    material = {"steel": trb.Material.steel, "polyamide": trb.Material.polyamide}[t["cage_material"]]()
    return trb.Cage(**plays, body=body.replace(**rims), material=material)


def _elastic_cage(t: Table) -> trb.ElasticCage | None:
    """Cracked bars lie opposite each other, or nearly so."""
    if t["elastic_modes"] is None:
        return None
    return trb.ElasticCage(n_modes=t["elastic_modes"], cracked_bars=tuple(9 * k for k in range(t["cracked_bars"])))


def _effects(t: Table) -> trb.Effects:
    effects = {
        "paper": trb.Effects.paper,
        "standard": trb.Effects.standard,
        "minimal": trb.Effects.minimal,
        "frictionless": trb.Effects.frictionless,
    }[t["effects"]]()
    changes: Table = {"gravity": t["gravity"], "starvation_factor": t["starvation"]}
    changes |= {"quadrature": "gauss", "n_slices": t["nodes"], "oil_fill": t["oil_fill"], "guidance": t["guidance"]}
    changes |= {"pocket_film": t["pocket_film"]}
    for name in ("lubrication", "traction", "thermal", "rolling_resistance", "back_rib", "front_rib", "planar"):
        if t[name] is not None:
            changes[name] = t[name]
    if changes.get("rolling_resistance") is False:
        changes["rolling_pressure_force"] = False
    if t["damping"] is not None:
        changes |= {"damping": "hunt_crossley", "damping_race": t["damping"], "damping_cage": t["damping"]}
    if t["film_damping"] is not None:
        changes |= {name: t[name] for name in ("film_damping", "film_damping_depth")}
    friction = {name: t[name] for name in ("dry_friction", "coulomb_speed") if t[name] is not None}
    if friction:
        changes["friction"] = effects.friction.replace(**friction)
    return effects.replace(**changes)


def _start(rng: np.random.Generator) -> Table:
    kind = _one_of(rng, "equal", "equal", "unequal", "whirl")
    table: Table = {"start": kind, "seed": int(rng.integers(1000))}
    if kind == "whirl":
        table["eccentricity"] = float(rng.uniform(0.1, 1.0))
    return table


def _start_of(t: Table) -> trb.Start:
    if t["start"] == "unequal":
        start = trb.Start.unequal(t["seed"])
    elif t["start"] == "whirl":
        start = trb.Start.whirl(t["eccentricity"])
    else:
        start = trb.Start.equal()
    return start.replace(time=t["start_time"])


def _quantity(t: Table, name: str, begin: float, end: float | None) -> float | trb.History:
    """A number, a ramp, or a harmonic change of the quantity of this name."""
    if t["repeating"] == name:
        return trb.History.harmonic(begin, t["repeating_share"] * abs(begin), frequency_hz=t["repeating_hz"])
    duration = t["history_s"]
    if t["drop_share"] is not None and name != "speed":
        return dropped(begin, t["drop_share"], duration, t["drop_rise"])
    return begin if end is None else trb.History.ramp(0.2 * duration, 1.2 * duration, begin, end)


def dropped(begin: float, share: float, duration: float, rise: float) -> trb.History:
    """What falls or rises to a share of itself and comes back, within a time."""
    return trb.History.step((0.3 * duration, 0.7 * duration), (begin, share * begin, begin), rise=rise)


def _log(rng: np.random.Generator, low: float, high: float) -> float:
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))


def _one_of(rng: np.random.Generator, *choices: Any) -> Any:
    return choices[int(rng.integers(len(choices)))]
