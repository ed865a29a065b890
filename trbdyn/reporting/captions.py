"""What each picture of the report shows, in a sentence."""

from __future__ import annotations

from typing import Final

CAPTIONS: Final[dict[str, str]] = {
    "cage_locus": "Path of the cage's centre. The outer circle is the radial play Cpr; a whirl along it uses up the play.",
    "orbit_radius": "Distance of the cage's centre from its own mean place over time, and from where averages are taken.",
    "axial_motion": "Place of the cage between the roller ends: 0 is against the large ends.",
    "tilt": "Tilt of the cage's axis over the last turns.",
    "spectrum": "At which frequencies the cage's centre moves.",
    "spacing_angles": "Angles between neighbouring rollers: flat lines mean that the rollers keep their distance.",
    "pocket_forces": "Forces between rollers and cage over the last turns, pocket by pocket.",
    "pocket_statistics": "Usual and largest force in each pocket.",
    "contact_loads": "Load of a roller on its way around the bearing.",
    "film_parameter": "Film thickness over roughness on the way around the bearing; above the marked limit the film carries all.",
    "torque_split": "Where the shaft's torque comes from.",
    "power_split": "Where the heat comes from.",
    "energy_audit": "Work, losses and stored energy; the residual is the error of the books and should lie far below the losses.",
    "load_zone": "Load of a roller by its place: a circle is an even load, a drop shape a loaded zone.",
    "pressure_map": "Pressure along the rollers: bright edges are edge loads.",
    "film_map": "Film parameter along the rollers: dark places have the thinnest films.",
    "attitude": "Skew and tilt of the rollers on their way around the bearing.",
    "pocket_polar": "Which pockets are hit, and how hard.",
    "poincare": "The cage's centre once a turn: one point is a steady whirl, a closed curve a second frequency, a cloud chaos.",
    "torque_sources": "Friction torque of the shaft over time, by source.",
    "shaft_drawing": "The shaft with its bearings in section, to scale; the housing and the shaft's own outline are not known.",
    "bearing_loads": "Axial and radial load of the shaft on each bearing.",
    "shaft_motion": "Displacement of the shaft's centre of mass, and its tilt, over time.",
    "shaft_orbits": "Path of the shaft's axis in the plane of each bearing's rollers, about its mean place.",
    "load_zones": "Loads of the rollers of each bearing in the equilibrium in which the run began, without friction.",
    "preload_diagram": "How the bearings share an axial force: their axial loads over the axial place of the shaft.",
    "ring_orbit": "Path of the inner ring's centre about its mean place.",
    "ring_motion": "Radial and axial displacement and tilt of the inner ring over time.",
    "housing_orbit": "Path of the outer ring's centre about its mean place: it moves with its housing.",
    "housing_motion": "Radial and axial displacement and tilt of the outer ring with its housing over time.",
}
"""A sentence for each picture."""
