"""Every picture against a description of itself that was kept when somebody last looked at it.

Whatever changes is noticed: a curve, limits of an axis, a colour, a legend, a mark. What a figure holds is written down as lines
of text, with the numbers of each curve as first, last, least, largest and mean; numbers may differ by a thousandth. After a
change that is meant, look at the pictures, compare them with the records, and keep their descriptions again:

    .venv/bin/python -m pytest tests/api/test_seen.py --keep-pictures
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray
from matplotlib.axis import Axis
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.text import Annotation
from matplotlib.ticker import FixedFormatter, FuncFormatter
from numpy.typing import NDArray

import trbdyn as trb
from trbdyn import plot
from trbdyn.extras.design.front import draw_front
from trbdyn.extras.design.optimise import Design, Optimum
from trbdyn.extras.heat.thermal_picture import draw_balance
from trbdyn.extras.maps.cage_map_picture import draw_map as draw_cage_map
from trbdyn.extras.maps.torque_picture import draw_map
from trbdyn.plot.animation import animate
from trbdyn.results.result import Result

KEPT = Path(__file__).with_name("pictures.json")
NUMBER = re.compile(r"-?\d+\.?\d*(?:e[+-]?\d+)?|nan")
Array = NDArray[np.float64]


# ---- what a figure holds, as text ----


def numbers(values: Any) -> str:
    """How many; first, last, least, largest, mean."""
    found = np.ma.filled(np.ma.asarray(values, dtype=float), np.nan).ravel()
    finite = found[np.isfinite(found)]
    if finite.size == 0:
        return f"{found.size} none"
    digest = (found[0], found[-1], finite.min(), finite.max(), finite.mean())
    return f"{found.size} [{' '.join(f'{float(one):.5g}' for one in digest)}]"


def colours(values: Any) -> str:
    rows = np.atleast_2d(np.asarray(values, dtype=float)) if not isinstance(values, str) else values
    return to_hex(values, keep_alpha=True) if isinstance(rows, str) or len(rows) == 1 else f"{len(rows)} colours"


def lines_of(ax: Any) -> Iterator[str]:
    many = len(ax.lines) > 100
    if many:
        x, y = (np.concatenate(all_of) for all_of in zip(*(one.get_data() for one in ax.lines), strict=True))
        yield f"{len(ax.lines)} lines, some of them below: x {numbers(x)} y {numbers(y)}"
    for one in ax.lines[:: 25 if many else 1]:
        label = "" if str(one.get_label()).startswith("_") else one.get_label()
        style = f"{to_hex(one.get_color())} {one.get_linestyle()} {one.get_linewidth():g} {one.get_marker()}"
        yield f"line {label!r} {style} x {numbers(one.get_xdata())} y {numbers(one.get_ydata())}"
    for one in ax.patches:
        corners = one.get_path().transformed(one.get_patch_transform()).vertices
        faces = f"{to_hex(one.get_facecolor(), keep_alpha=True)} {to_hex(one.get_edgecolor(), keep_alpha=True)}"
        yield f"patch {type(one).__name__} {faces} x {numbers(corners[:, 0])} y {numbers(corners[:, 1])}"
    for one in ax.collections:
        what = [f"collection {type(one).__name__} {colours(one.get_facecolor()) if len(one.get_facecolor()) else ''}"]
        if one.get_array() is not None:
            what.append(f"colours {numbers(one.get_array())} from {' to '.join(f'{c:.5g}' for c in one.get_clim())}")
        places = np.ma.filled(np.ma.asarray(one.get_offsets(), dtype=float), np.nan)
        what.append(f"at x {numbers(places[:, 0])} y {numbers(places[:, 1])}")
        points = [path.vertices for path in one.get_paths()]
        if points:
            joined = np.concatenate(points)
            what.append(f"outlines x {numbers(joined[:, 0])} y {numbers(joined[:, 1])}")
        yield " ".join(what)
    for one in ax.images:
        yield f"image {numbers(one.get_array())} from {one.get_clim()}"
    for one in ax.texts:
        of = f" of {numbers(one.xy)}" if isinstance(one, Annotation) else ""
        yield f"text {one.get_text()!r} at {numbers(one.get_position())}{of}"


def ticks_of(axis: Axis) -> str:
    """Its places, the labels that somebody has given them, and whether it has a grid."""
    given = isinstance(axis.get_major_formatter(), FixedFormatter | FuncFormatter)
    labels = [label.get_text() for label in axis.get_ticklabels()] if given else []
    grid = "grid" if axis.get_gridlines() and axis.get_gridlines()[0].get_visible() else "no grid"
    return f"ticks {numbers(axis.get_ticklocs())} {labels or ''} {grid}"


def described(figure: Figure) -> list[str]:
    """All that a figure holds."""
    found = [f"figure {figure.get_suptitle()!r} {' x '.join(f'{one:g}' for one in figure.get_size_inches())} inches"]
    for ax in figure.axes:
        words = [ax.get_title(), ax.get_xlabel(), ax.get_ylabel()]
        limits = f"x {numbers(ax.get_xlim())} {ax.get_xscale()} y {numbers(ax.get_ylim())} {ax.get_yscale()}"
        found.append(f"axes {words} {limits} aspect {ax.get_aspect()} {ax.name}")
        found += [f"{name} {ticks_of(axis)}" for name, axis in (("x", ax.xaxis), ("y", ax.yaxis)) if axis.get_visible()]
        if ax.get_legend() is not None:
            found.append(f"legend {[text.get_text() for text in ax.get_legend().get_texts()]}")
        found += lines_of(ax)
    return found


def differs(kept: str, seen: str) -> bool:
    """Whether words differ, or numbers by more than a thousandth of themselves or of the largest beside them."""
    if NUMBER.sub("#", kept) != NUMBER.sub("#", seen):
        return True
    pairs = [(float(a), float(b)) for a, b in zip(NUMBER.findall(kept), NUMBER.findall(seen), strict=True)]
    size = max((abs(a) for a, _ in pairs if math.isfinite(a)), default=0.0)
    return any(not math.isclose(a, b, rel_tol=1e-3, abs_tol=1e-6 * size) for a, b in pairs if not math.isnan(a + b))


def test_a_description_tells_what_changed() -> None:
    figure, ax = plt.subplots()
    ax.plot([0.0, 1.0, 2.0], [1.0, 5.0, 2.0], color="C0", label="one")
    before = described(figure)
    assert not any(map(differs, before, described(figure)))
    changes: list[Callable[[], Any]] = [
        lambda: ax.set_xlim(0.0, 3.0),
        lambda: ax.lines[0].set_color("C1"),
        lambda: ax.lines[0].set_ydata([1.0, 5.01, 2.0]),
        lambda: ax.legend(),
        lambda: ax.set_ylabel("y"),
        lambda: ax.axhline(1.0),
    ]
    for change in changes:
        before = described(figure)
        change()
        after = described(figure)
        assert len(before) != len(after) or any(map(differs, before, after)), change


# ---- the pictures ----


def in_small(synthetic: Any) -> Any:
    """As the whirling run, but every number its own, the second half of it."""
    keep = slice(2001, 4001)
    for name, _, shape in synthetic.layout:
        column = synthetic.column(name)
        moving = any(part in name for part in ("position", "force", "tilt", "skew", "load", "film", "power", "torque"))
        if shape and moving:
            column[...] *= 1.0 + 0.3 * np.random.default_rng(len(name)).random(column.shape[1:])
    t = synthetic.column("time")[..., None]
    synthetic.column("roller_skew")[...] = 1e-4 * np.sin(300.0 * t[:, :1] + np.arange(12)) + 2e-5 * np.arange(12)
    synthetic.column("roller_tilt")[...] = 3e-5 * np.cos(200.0 * t[:, :1] + np.arange(12))
    way = np.concatenate([np.sin(900.0 * t), 0.7 * np.cos(900.0 * t), 0.2 * np.sin(1800.0 * t)], axis=1)
    synthetic.column("ring_position")[...] = 1e-6 * way
    synthetic.column("ring_velocity")[...] = 1e-3 * way[:, [1, 0, 2]]
    synthetic.column("housing_position")[...] = 3e-7 * way[:, [2, 0, 1]]
    synthetic.column("housing_velocity")[...] = 2e-4 * way[:, [0, 2, 1]]
    synthetic.column("pocket_force")[:, :, 3] = 0.0
    for name in ("pocket_force_peak", "pocket_force_peak_time"):
        if any(name == one for one, _, _ in synthetic.layout):
            synthetic.column(name)[...] = 1.5 * synthetic.column("pocket_force").max(axis=-1, keepdims=True)
    return synthetic.records[keep]


class Waving:
    """The records of a run with other amplitudes of the cage's modes."""

    def __init__(self, records: Any) -> None:
        self.records = records

    def read(self, name: str) -> Array:
        found = self.records.read(name)
        return 1e-6 * np.sin(np.arange(found.size)).reshape(found.shape) if name == "cage_mode" else found

    def __getattr__(self, name: str) -> Any:
        return getattr(self.records, name)


class Pictures:
    """Every picture by its name."""

    def __init__(self, synthetic: Any, whirling: Result) -> None:
        records = in_small(synthetic)
        geometry = {name: 1e-3 * (10 + k) for k, name in enumerate(trb.cases.rig_30310().geometry.__dict__)}
        about = {"records": records, "geometry": geometry | synthetic.geometry}
        self.result = synthetic.result(whirling.scene, **about)

        class Free(type(whirling.scene)):  # type: ignore[misc]
            ring_body = trb.RingBody(mass=1.0, inertia_axial=1e-3, inertia_transverse=1e-3)
            housing = trb.Housing(mass=1.0, inertia_axial=1e-3, inertia_transverse=1e-3)
            bearing = trb.cases.rig_30310()

        seat = {"shift": 2e-6, "mass_offset": -0.05, "turned": False}
        meta = {"assembly": {"bearing": "left", "bearings": ["left", "right"], "seat": seat}}
        self.free = synthetic.result(Free(), **about)
        self.seated = synthetic.result(Free(), meta=meta, **about)

    def of_result(self) -> Iterator[tuple[str, Any]]:
        of_rings = ("ring_orbit", "ring_motion", "housing_orbit", "housing_motion")
        skipped = ("pressure_map", "film_map", *of_rings)  # records are evaluated again for these: test_plotting.py
        for name, (draw, _) in plot.PICTURES.items():
            if name not in skipped:
                yield name, draw(self.result)
        for name in of_rings:
            yield name, plot.PICTURES[name][0](self.free)
        yield "ring_spectrum of the housing", plot.ring_spectrum(self.free, ring="outer", along="y")
        for of in ("displacement", "velocity"):
            yield f"ring_spectrum of {of}", plot.ring_spectrum(self.free, of=of, segments=2)  # type: ignore[arg-type]
        yield "pocket_forces of two pockets", plot.pocket_forces(self.result, pockets=[0, 3], last=0.3)
        yield "spacing_angles of three rollers", plot.spacing_angles(self.result, n=2, rollers=[0, 1, 5])
        yield "cage_locus of a plane", plot.cage_locus(self.result, plane="rail", colour_by_time=False)
        yield "waterfall", plot.waterfall([self.result])
        yield "whirl_map", plot.whirl_map([self.result])
        for once in ("cage", "shaft", "roller"):
            yield f"poincare once per {once}", plot.poincare(self.result, once_per=once)  # type: ignore[arg-type]
        yield "conditions", _written(plot.conditions(self.result))

    @staticmethod
    def of_animation(result: Result) -> Iterator[tuple[str, Any]]:
        moving = animate(result, last=0.5, frames=4)
        moving._draw_frame(2)
        moving._draw_was_started = True
        yield "animation", moving._fig
        plt.close("all")

    @staticmethod
    def of_bearings() -> Iterator[tuple[str, Any]]:
        for name in ("30310", "32216"):
            bearing = getattr(trb.cases, f"bearing_{name}", trb.cases.rig_30310)()
            yield f"bearing_drawing of {name}", plot.bearing_drawing(bearing)
            yield f"pocket_drawing of {name}", plot.pocket_drawing(bearing)
        for name in trb.pocket_shapes.SHAPES:
            given = {"lean_deg": 20.0} if name == "drafted" else {}
            pocket = trb.pocket_shapes.SHAPES[name](bearing, **given)
            yield f"pocket_drawing of a {name} pocket", plot.pocket_drawing(bearing.replace({"cage.pocket": pocket}), 3)
        place = np.linspace(-10e-3, 10e-3, 201)
        height = -2e-6 * (place / 10e-3) ** 2 + 1e-7 * np.sin(40.0 * np.arange(201.0))
        out = np.arange(201) % 50 == 7
        height[out] += 4e-6
        drops = 2e-6 * (place[::10] / 10e-3) ** 2
        trace = trb.Trace(place[::10], drops, place, height, out, 1.25, 7e-8, "roller.csv", 0.25e-3, 12)
        yield "profile_trace", plot.profile_trace(trace)

    @staticmethod
    def of_elastic_cage() -> Iterator[tuple[str, Any]]:
        bearing = trb.cases.rig_30310().replace({"cage.body": trb.cases.cage_body_30310()})
        start = trb.Start(kind="whirl", eccentricity=0.9)
        scene = trb.Scene(bearing=bearing, speed_rpm=3000.0, axial_load=4930.0, start=start)
        scene = scene.replace(elastic_cage=trb.ElasticCage(n_modes=6))
        run = trb.Simulation(scene, accuracy="reference").run(duration=5e-4, save_every=5e-5)
        run._source = Waving(run._source)
        yield "cage_shape", plot.cage_shape(run)
        yield "cage_shape at a record", plot.cage_shape(run, record=2, factor=50.0)
        yield "cage_stress", plot.cage_stress(run, points=4, notch_factor=2.0)

    @staticmethod
    def of_heat() -> Iterator[tuple[str, Any]]:
        names = ("outer_ring", "inner_ring", "rollers", "oil", "film")
        temperatures = {name: 50.0 + 7.0 * k for k, name in enumerate(names)}
        yield (
            "draw_balance",
            draw_balance(
                [
                    SimpleNamespace(
                        temperatures=temperatures,
                        bands={name: (value - 5.0, value + 9.0) for name, value in temperatures.items()},
                        curve=np.array([[30.0, 400.0], [60.0, 300.0], [90.0, 240.0]]),
                        power=270.0,
                        scene=SimpleNamespace(bearing=SimpleNamespace(name="a bearing")),
                        paths=trb.HeatPaths(outer_ring_to_surroundings=2.0, housing_air_c=25.0, shaft_end_c=10.0),
                    )
                ]
            ),
        )

    @staticmethod
    def of_torque_maps() -> Iterator[tuple[str, Any]]:
        for name, speeds, loads, temperatures, factor in (
            ("over speed", (100.0, 1000.0, 3000.0), (2e3, 5e3), (40.0, 70.0), 1.0),
            ("over a decade", (100.0, 1000.0, 3000.0), (2e3,), (40.0,), 40.0),
            ("at one speed", (1000.0,), (2e3,), (40.0,), 1.0),
        ):
            shape = (len(temperatures), len(loads), len(speeds))
            torque = 1.0 + np.arange(np.prod(shape)).reshape(shape) * factor
            shares = np.stack([0.5 * torque, 0.3 * torque, 1e-4 * torque], axis=-1)
            order = ("temperature_c", "load", "speed_rpm")
            data = xarray.Dataset(
                {
                    "torque": (order, torque),
                    "settled": (order, torque > 1.5),
                    "torque_low": (order, 0.9 * torque),
                    "torque_high": (order, 1.2 * torque),
                    "share": ((*order, "source"), shares),
                },
                coords={
                    "temperature_c": list(temperatures),
                    "speed_rpm": list(speeds),
                    "source": ["rolling", "rib", "pocket_bar"],
                    "axial_load": ("load", list(loads)),
                    "radial_load": ("load", [500.0 * k for k in range(len(loads))]),
                },
                attrs={"bearing": "a bearing"},
            )
            yield f"draw_map {name}", draw_map(data)
            if len(temperatures) > 1:
                yield f"draw_map {name}, one temperature", draw_map(data, temperature=1)

    @staticmethod
    def of_cage_maps() -> Iterator[tuple[str, Any]]:
        order, kinds = ("start", "axial_load", "speed_rpm"), ["stable", "rocking", "circling", "unstable", "unknown"]
        orbit = np.append(0.08 * np.arange(11.0), np.nan).reshape(2, 2, 3)
        data = xarray.Dataset(
            {
                "kind": (order, np.array([kinds[k % 5] for k in range(12)], dtype=object).reshape(2, 2, 3)),
                "orbit": (order, orbit),
                "hits": (order, 1500.0 * orbit),
                "decided": (order, orbit < 0.7),
            },
            {"start": ["equal", "whirl"], "axial_load": [1e3, 4e3], "speed_rpm": [500.0, 1000.0, 2000.0]},
            {"bearing": "30310"},
        )
        yield "cage_map over speed and load", draw_cage_map(data)

    @staticmethod
    def of_searches() -> Iterator[tuple[str, Any]]:
        rows = [(4.0, 2.0), (3.0, 2.5), (2.0, 1.5), (1.0, 3.0)]
        for name, want in (
            ("two aims", {"pocket_force_peak": "least", "torque": "least"}),
            ("one aim", {"torque": "least"}),
        ):
            made = []
            for number, row in enumerate(rows):
                told = dict(zip(["pocket_force_peak", "torque"], row, strict=True))
                made.append(Design(number, {}, {key: 1.1 * value for key, value in told.items()}, told, False))
            front = tuple(made[2:] if len(want) > 1 else made[2:3])
            scene = trb.cases.scene_30310(3000.0, 4930.0)
            found = Optimum(made[0], made[2], front, tuple(made), want, (), None, (scene, scene))
            yield f"draw_front of {name}", draw_front(found)

    def of_assembly(self) -> Iterator[tuple[str, Any]]:
        pair = trb.load_assembly("pair_30310")
        yield "shaft_drawing", plot.shaft_drawing(pair)
        left, right = pair.bearings
        larger = right.replace(bearing=trb.cases.bearing_32216(), position=right.position + 0.05)
        yield "shaft_drawing of two sizes", plot.shaft_drawing(pair.replace(bearings=(left, larger)))
        result = trb.AssemblyResult({"left": self.seated, "right": self.seated}, pair)
        yield "bearing_loads", plot.bearing_loads(result)
        yield "shaft_motion", plot.shaft_motion(result)
        yield "shaft_orbits", plot.shaft_orbits(result)
        yield "load_zones", plot.load_zones(trb.equilibrium(pair))
        span = trb.preload_diagram(pair, displacements=np.linspace(-3e-5, 3e-5, 5))
        yield "preload_diagram", plot.preload_diagram(span)

    def all(self) -> Iterator[tuple[str, Any]]:
        yield from self.of_result()
        yield from self.of_animation(self.result)
        maps = (self.of_torque_maps, self.of_cage_maps, self.of_searches)
        for more in (self.of_bearings, self.of_elastic_cage, self.of_heat, *maps, self.of_assembly):
            yield from more()


def _written(text: str) -> Figure:
    figure = plt.figure()
    figure.suptitle(text)
    return figure


@cache
def kept() -> dict[str, list[str]]:
    return json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.exists() else {}


def test_pictures_are_what_they_were(synthetic: Any, whirling: Result, request: pytest.FixtureRequest) -> None:
    seen = {}
    for name, picture in Pictures(synthetic, whirling).all():
        seen[name] = described(picture if isinstance(picture, Figure) else picture.figure)
        plt.close("all")
    if request.config.getoption("--keep-pictures"):
        KEPT.write_text(json.dumps(seen, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    assert list(seen) == list(kept()), "other pictures than those that are kept"
    for name, found in seen.items():
        before = kept()[name]
        changed = [f"- {a}\n+ {b}" for a, b in zip(before, found, strict=False) if differs(a, b)]
        assert not changed, f"{name}:\n" + "\n".join(changed)
        assert len(before) == len(found), f"{name}: {len(found)} things are drawn, {len(before)} were"
