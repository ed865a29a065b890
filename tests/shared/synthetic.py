"""A whirling cage with known answers, as records in the core's layout; the core gives nothing but its table of fields."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trbdyn import _core
from trbdyn.model.motion import History
from trbdyn.results.fields import Field
from trbdyn.results.file_format import RunInfo
from trbdyn.results.result import Result
from trbdyn.results.sources import RecordsSource

Z, SLOTS = 12, 4
RADIAL_PLAY, AXIAL_PLAY = 0.25e-3, 0.4e-3
SHAFT_SPEED = 2 * np.pi * 50.0
CAGE_RATIO = 0.41662


@dataclass
class Synthetic:
    """Records of a made-up run, and what is known of them."""

    fields: tuple[Field, ...]
    layout: list[tuple[str, int, tuple[int, ...]]]
    records: NDArray[np.float64]
    whirl_radius: float
    whirl_frequency: float
    cage_frequency: float
    residual: float
    dissipated: float
    geometry: dict[str, float] = field(default_factory=dict)

    def ending(self) -> dict[str, Any]:
        """How the run ended, as the writers take it."""
        return {
            "success": True,
            "message": "reached the end",
            "stats": {"steps": 1234, "rhs_evaluations": 5678, "wall_s": 2.5},
            "counters": {"raceway": 99, "front_rib": 0},
            "final_time": float(self.column("time")[-1]),
            "final_state": np.arange(5.0),
        }

    def result(self, scene: Any, records: NDArray[np.float64] | None = None, **changes: Any) -> Result:
        """The run as a result in memory, with its own records or with others."""
        rows = self.records if records is None else records
        places = {name: (offset, shape) for name, offset, shape in self.layout}
        info = RunInfo(scene=scene.to_dict(), **{"geometry": self.geometry} | self.ending() | changes)
        return Result(RecordsSource([rows], self.fields, places), info, scene)

    def column(self, name: str) -> NDArray[np.float64]:
        """A field of the records."""
        offset, shape = next((o, s) for n, o, s in self.layout if n == name)
        return self.records[:, offset : offset + int(np.prod(shape))].reshape(-1, *shape)


def make_run(
    n: int = 4001,
    duration: float = 0.4,
    radius: float = 0.9 * RADIAL_PLAY,
    whirl_ratio: float = 1.0,
    centre: tuple[float, float] = (0.0, 0.0),
    residual: float = 2e-4,
) -> Synthetic:
    """A cage whirling on a circle, rollers in uneven places, forces that follow, and an audit with a known residual."""
    every = (Field(*row) for row in _core.field_table())
    fields = tuple(field for field in every if field.kind != "mode")  # the cage is rigid
    layout, offset = [], 0
    for entry in fields:
        shape = entry.shape(Z, SLOTS)
        layout.append((entry.name, offset, shape))
        offset += int(np.prod(shape))
    run = Synthetic(fields, layout, np.zeros((n, offset)), radius, 0.0, 0.0, residual, 0.0)
    rng = np.random.default_rng(1)
    t = np.linspace(0.0, duration, n)
    cage_speed = CAGE_RATIO * SHAFT_SPEED
    phase = whirl_ratio * cage_speed * t
    run.cage_frequency, run.whirl_frequency = cage_speed / (2 * np.pi), whirl_ratio * cage_speed / (2 * np.pi)
    run.geometry = {
        "cage_speed_ratio": CAGE_RATIO,
        "roller_spin_ratio": 2.8606,
        "outer_race_radius": 48.064e-3,
        "inner_race_radius": 34.325e-3,
        "large_end_diameter": 14.646e-3,
        "small_end_diameter": 13.354e-3,
    }

    def put(name: str, values: Any) -> None:
        run.column(name)[...] = values

    put("time", t)
    put("shaft_angle", SHAFT_SPEED * t)
    put("shaft_speed", SHAFT_SPEED)
    unit = np.column_stack([np.cos(phase), np.sin(phase)])
    put(
        "cage_position",
        np.column_stack([centre[0] + radius * unit[:, 0], centre[1] + radius * unit[:, 1], 3e-5 + 1e-5 * unit[:, 0]]),
    )
    put("cage_rail_position", 1.05 * run.column("cage_position"))
    put("cage_velocity", whirl_ratio * cage_speed * radius * np.column_stack([-unit[:, 1], unit[:, 0], np.zeros(n)]))
    put("cage_tilt", 2e-4 * np.column_stack([-unit[:, 1], unit[:, 0]]))
    put("cage_angle", cage_speed * t)
    put("cage_angular_velocity", [0.0, 0.0, cage_speed])
    uneven = np.radians(0.4) * np.sin(2 * np.pi * np.arange(Z) / Z)
    place = 2 * np.pi * np.arange(Z) / Z + uneven
    angle = place + cage_speed * t[:, None]
    put("roller_orbit_angle", angle)
    run.column("roller_position")[..., 0] = 41.26e-3 * np.cos(angle)
    run.column("roller_position")[..., 1] = 41.26e-3 * np.sin(angle)
    put("ring_force", [0.0, 0.0, 4930.0])
    put("roller_orbit_speed", 0.999 * cage_speed)
    put("roller_spin_speed", -2.8606 * SHAFT_SPEED)
    towards = np.cos(angle - phase[:, None])
    for name, load in (("outer", 1833.0), ("inner", 1812.0), ("rib", 122.0)):
        put(f"{name}_load", load * (1 + 0.01 * towards))
        put(f"{name}_pressure", 0.64e9 + 1e7 * towards)
        put(f"{name}_film", 0.75e-6)
        put(f"{name}_film_parameter", 4.0 + 0.1 * towards)
        put(f"{name}_slide_roll", 1e-4 * towards)
    force = run.column("pocket_force")
    force[:, :, 0] = 30.0 * np.clip(towards - 0.7, 0, None) * (1 + 0.3 * rng.random((n, Z)))
    force[:, :, 1] = 20.0 * np.clip(-towards - 0.8, 0, None) * (1 + 0.3 * rng.random((n, Z)))
    force[:, :, 2] = 4.0 * np.clip(towards - 0.95, 0, None)
    put("inner_torque_traction", 0.30 + 0.01 * unit[:, 0])
    put("inner_torque_rolling", 0.70)
    put("inner_torque_rib", 0.25)
    put("inner_torque", 1.25 + 0.01 * unit[:, 0])
    put("outer_torque", 1.6)
    losses = {"traction_outer": 40.0, "traction_inner": 60.0, "rolling": 220.0, "rib": 70.0, "pocket": 2.7}
    for name, watt in losses.items():
        put(f"power_{name}", watt)
        put(f"loss_{name}", watt * t)
    total = sum(losses.values())
    run.dissipated = total * duration
    put("power_loss", total)
    put("kinetic_energy", 12.0 + 0.01 * unit[:, 0])
    put("elastic_energy", 0.3)
    put("work_gravity", 0.002 * unit[:, 1])
    stored = run.column("kinetic_energy") + run.column("elastic_energy") - run.column("work_gravity")
    put("work_shaft", total * t + stored - stored[0] + residual * t / duration)
    return run


class StubScene:
    """What results read of a scene, without the core that a real one needs."""

    bearing = SimpleNamespace(
        name="stub",
        n_rollers=Z,
        pitch_diameter=82.389e-3,
        slot_names=("leading_bar", "trailing_bar", "large_end_wall", "small_end_wall"),
        geometry=SimpleNamespace(
            effective_modulus=226.37e9, outer_equivalent_radius=8.163e-3, inner_equivalent_radius=5.830e-3
        ),
        roller=SimpleNamespace(effective_length=19.8e-3),
        cage=SimpleNamespace(play_radial=RADIAL_PLAY, play_circumferential=0.12e-3, play_axial=AXIAL_PLAY),
    )
    ring_body = housing = elastic_cage = None
    effects = SimpleNamespace(
        guidance="rollers",
        oil_fill=0.0,
        bodies="rollers_and_cage",
        has_cage=True,
        has_pockets=True,
        films=True,
        traction="none",
        rolling_resistance=True,
        rolling_law="biboulet_houpert",
        rolling_pressure_force=False,
        friction=SimpleNamespace(lambda_full=1.5),
    )
    lubricant = SimpleNamespace(pressure_coefficient=1.973e-8, oil=None)
    axial_load, radial_load = 4930.0, 0.0
    rotating_load = None
    speed_rpm = turning_rpm = 3000.0
    outer_speed_rpm, outer_turns, turning_ring, torque = 0.0, False, "shaft", None
    growth = None
    misalignment_x = misalignment_y = 0.0

    def ring_quantities(self) -> dict[str, Any]:
        """A load that changes: ratings ask for constant ones."""
        return {"axial_load": History(times=(0.0, 1.0), values=(1.0, 2.0))}

    def to_dict(self) -> dict[str, Any]:
        """Any plain data."""
        return {"stub": True}
