"""Picture of the gap and the pressure along the most heavily loaded roller."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.figure import Figure

from trbdyn.model.contact_line import stations
from trbdyn.model.profiles import profile_drop, raceway_drops
from trbdyn.model.scene import Scene
from trbdyn.plot.style import legend, line, scaled, styled
from trbdyn.run.simulation import Simulation

NODES = 64
EDGE = 0.05
"""Share of the largest pressure from which a contact is said to end with pressure."""
RACES = ("outer raceway", "inner raceway")


def contact_line(scene: Scene) -> Figure:
    """Gap between the unloaded surfaces, and pressure at the start, along the most heavily loaded roller.

    The title says where a contact ends with pressure: there the surfaces press harder than slices, which do not feel each other,
    can tell.

    Parameters
    ----------
    scene : Scene
        The scene; its contact line is drawn with 64 nodes.

    Examples
    --------
    >>> import trbdyn as trb
    >>> figure = trb.plot.contact_line(trb.cases.scene_32216())
    >>> figure.axes[1].get_ylabel()
    'Largest pressure (MPa)'
    """
    fine = scene.replace(effects=scene.effects.replace(quadrature="gauss", n_slices=NODES))
    bearing, places = scene.bearing, stations(fine)
    found = Simulation(fine).contacts()
    roller = int(found["raceway_load"].sum(axis=(0, 2)).argmax())
    pressure = np.where(found["raceway_load"][:, roller] > 0.0, found["raceway_pressure"][:, roller], 0.0)
    gaps = profile_drop(bearing, places) + raceway_drops(bearing, places)
    factor, unit = scaled("Pa", pressure)
    with styled():
        figure, axes = plt.subplots(2, 1, sharex=True, figsize=(6.4, 5.4))
        for race, name in enumerate(RACES):
            line(axes[0], 1e3 * places, 1e6 * gaps[race], race, name)
            line(axes[1], 1e3 * places, factor * pressure[race], race, name)
        axes[0].set(ylabel="Gap of the profiles (µm)")
        axes[1].set(xlabel="Place along the roller, towards its large end (mm)", ylabel=f"Largest pressure ({unit})")
        legend(axes[0])
        figure.suptitle(f"Gap and pressure along roller {roller}\n{_edges(pressure)}", fontsize=11)
    return figure


def _edges(pressure: np.ndarray) -> str:
    ends = [
        f"{place} end of the {name}, {100.0 * values[k] / values.max():.0f} %"
        for name, values in zip(RACES, pressure, strict=True)
        for place, k in (("small", 0), ("large", -1))
        if values.max() > 0.0 and values[k] > EDGE * values.max()
    ]
    if not ends:
        return "no contact ends with pressure"
    return "edge stress not in the model: pressure at the\n" + "; ".join(ends)
