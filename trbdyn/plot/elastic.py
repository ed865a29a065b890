"""Pictures of a cage that deforms: its shape, and the stress at the corners of its pockets."""

from __future__ import annotations

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from trbdyn.base.extras import of_extras
from trbdyn.errors import InputError
from trbdyn.plot.style import COLOURS, GREY, canvas, sequence, styled
from trbdyn.results.result import Result

__all__ = ["cage_shape", "cage_stress"]

SIZE = 0.12
"""Largest displacement in the picture of a deformed cage, over the radius of the cage."""


def cage_shape(result: Result, record: int | None = None, factor: float | None = None) -> Figure:
    """The deformed cage at a record, exaggerated, over the undeformed one: seen from the large ends, and from the side.

    Parameters
    ----------
    result : Result
        Of a scene whose elastic cage has modes of its own body, not of a file; needs the group cage.
    record : int, optional
        Number of the record; by default the one at which a face moves most.
    factor : float, optional
        By how much displacements are drawn larger; by default so that the largest is an eighth of the radius.

    Raises
    ------
    InputError
        If the cage is rigid, or its modes come from a file.
    """
    shape = of_extras("cage_modes")(result.scene).shape[:, :, :3]
    if record is None:
        size = np.array([np.linalg.norm(np.tensordot(one, shape, 1), axis=1).max() for one in result["cage_mode"]])
        record = int(np.argmax(size))
    built, moved = of_extras("displacements")(result.scene, result["cage_mode"][record])
    mesh = built.solid.basis.mesh
    nodes, faces = (
        mesh.p.T,
        mesh.facets[:, mesh.boundary_facets()].T,
    )  # corners of the elements come first among the nodes
    moved = moved[: len(nodes)]
    length = np.linalg.norm(moved, axis=1)
    if factor is None:
        factor = SIZE * float(np.hypot(*nodes[:, :2].T).max()) / max(float(length.max()), 1e-30)
    to = nodes + factor * moved
    shade = sequence()(length[faces].mean(axis=1) / max(float(length.max()), 1e-30))
    with styled():
        figure, axes = plt.subplots(1, 2, figsize=(8.0, 4.4), width_ratios=(1.0, 0.5))
        # from the large ends one looks against z; from the side against x, at the half that lies there
        for ax, (across, up, depth) in ((axes[0], (0, 1, 2)), (axes[1], (2, 1, 0))):
            shown = np.argsort(to[faces, depth].mean(axis=1).round(7), kind="stable")
            shown = shown if depth == 2 else shown[nodes[faces[shown], 0].min(axis=1) > 0.0]
            for places, colour in ((nodes, GREY), (to, shade[shown])):
                outlines = 1e3 * places[faces[shown]][:, :, [across, up]]
                still = places is nodes
                ax.add_collection(
                    PolyCollection(
                        outlines,
                        facecolors="none" if still else colour,
                        edgecolors=colour if still else "none",
                        linewidths=0.3,
                    )
                )
            ax.autoscale_view()
            ax.set(aspect="equal", xlabel=f"{'xyz'[across]} of the cage (mm)", ylabel="y of the cage (mm)")
        axes[1].set_title("half of it, from the side")
        scale = ScalarMappable(Normalize(0.0, 1e6 * float(length.max())), sequence())
        figure.colorbar(scale, ax=axes, label="displacement (µm)")
        when = f"{1e3 * float(result['time'][record]):.4g} ms"
        figure.suptitle(f"Deformed cage at {when}, displacements {factor:.3g} times as large")
    return figure


def cage_stress(result: Result, ax: Axes | None = None, *, points: int = 3, notch_factor: float = 1.0) -> Axes:
    """Stress at the corners of pockets with the largest stress, over time.

    Parameters
    ----------
    result : Result
        Of a scene with an elastic cage; needs the groups cage and pocket.
    points : int
        How many points are drawn.
    notch_factor : float
        Factor of the nominal stress (1).

    Raises
    ------
    InputError
        If the cage is rigid, or `points` is not from 1 to 6.
    """
    if not 1 <= points <= 6:
        raise InputError.of("points", points, "must be from 1 to 6")
    found = result.cage_stress(notch_factor=notch_factor)
    worst = np.argsort(-np.abs(found.stress).max(axis=0))[:points]
    with canvas(ax, (7.0, 3.4), "Stress at the corners of the cage's pockets") as ax:
        for point, colour in zip(worst, COLOURS, strict=False):
            ax.plot(
                1e3 * found.time,
                1e-6 * found.stress[:, point],
                color=colour,
                linewidth=0.8,
                label=found.point_name[point],
            )
        ax.set(xlabel="time (ms)", ylabel="stress along bar or rim (MPa)")
        ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=1, frameon=False)
    return ax
