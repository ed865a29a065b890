"""Critical speeds of a shaft on two tapered roller bearings, with ROSS; its bearings are those of trbdyn.

    python examples/rotor_ross/critical_speeds.py

Two 30310 face each other on a shaft of 60 mm. `trb.stiffness` gives each bearing as springs at its pressure centre. ROSS knows
springs across and along a shaft, but none against tilt: two springs of half the stiffness, at such a distance that they resist
tilt as the bearing does, stand for it. With a shaft that hardly bends ROSS and `Stiffness.modes` must agree; then the steel
shaft bends.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import ross

import trbdyn as trb

SPEED_RPM = 3000.0
AXIAL_LOAD = 4930.0
"""Preload of either bearing (N)."""
SPACING, DIAMETER, LENGTH, START = 0.15, 0.06, 0.25, -0.05
"""Between the roller-centre planes; of the shaft; of its end from the first of these planes (m)."""
DENSITY, STEEL, STIFF = 7810.0, 2.11e11, 2.11e14


def springs_of() -> dict[str, float]:
    scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=SPEED_RPM, axial_load=AXIAL_LOAD)
    return trb.stiffness(scene).springs


def rotor(springs: dict[str, float], modulus: float) -> ross.Rotor:
    """The shaft between nodes at the springs, each bearing as two of them."""
    half = math.sqrt(springs["tilt"] / springs["radial"])
    centres = (springs["position"], SPACING - springs["position"])
    places = [centre + side * half for centre in centres for side in (-1.0, 1.0)]
    nodes = sorted({START, START + LENGTH, 0.5 * SPACING, *places})
    steel = ross.Material("steel", rho=DENSITY, E=modulus, Poisson=0.3)
    shaft = [ross.ShaftElement(end - begin, 0.0, DIAMETER, material=steel) for begin, end in pairwise(nodes)]
    bearings = [
        ross.BearingElement(nodes.index(place), 0.5 * springs["radial"], 0.0, kzz=0.5 * springs["axial"])
        for place in places
    ]
    return ross.Rotor(shaft, bearing_elements=bearings)


def frequencies(found: ross.Rotor, count: int) -> np.ndarray:
    """Natural frequencies at speed (Hz), without the free turn of the shaft."""
    modal = found.run_modal(SPEED_RPM * math.pi / 30.0, num_modes=24, sparse=False)
    values = np.sort(np.abs(np.asarray(modal.wd)) / (2.0 * math.pi))
    return np.unique(values[values > 10.0].round(3))[:count]


def rigid(springs: dict[str, float]) -> np.ndarray:
    """The same of a rigid shaft, by trbdyn, without what the rollers add to its mass."""
    mass = DENSITY * 0.25 * math.pi * DIAMETER**2 * LENGTH
    body = trb.RingBody.hollow_cylinder(
        mass=mass, outer_diameter=DIAMETER, length=LENGTH, mass_offset=START + 0.5 * LENGTH
    )
    held = {f"support_{name}": springs[name] for name in ("radial", "axial", "tilt")}
    body = body.replace(**held, support_position=SPACING - springs["position"])
    scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=SPEED_RPM, axial_load=AXIAL_LOAD)
    found = trb.stiffness(scene)
    bare = type(found)(**{**vars(found), "roller_mass": np.zeros((5, 5))})
    return bare.modes(body).frequencies


def main() -> None:
    springs = springs_of()
    print("one bearing as springs:", {name: float(f"{value:.4g}") for name, value in springs.items()})
    print("rigid shaft, trbdyn:      ", rigid(springs).round(1), "Hz")
    print("shaft that hardly bends:  ", frequencies(rotor(springs, STIFF), 5).round(1), "Hz")
    print("shaft of steel, ROSS:     ", frequencies(rotor(springs, STEEL), 5).round(1), "Hz")
    speeds = rotor(springs, STEEL).run_critical_speed(num_modes=16).wd()
    print("critical speeds:", (np.sort(np.abs(np.asarray(speeds)))[:4] * 30.0 / math.pi).round(0), "rpm")


if __name__ == "__main__":
    main()
