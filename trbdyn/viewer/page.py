"""One HTML file with everything in it: three.js, the meshes, the frames and the program that draws them."""

from __future__ import annotations

import base64
import gzip
import html
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib.resources import files
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.results.result import Result
from trbdyn.viewer.data import Frames, Quantity, default_factor, facts
from trbdyn.viewer.fit import largest_factor
from trbdyn.viewer.library import three_js
from trbdyn.viewer.meshes import Mesh
from trbdyn.viewer.shapes import AROUND, Shapes

FULL = np.iinfo(np.uint16).max
MESHES: Final = ("outer", "inner", "roller", "mark", "cage", "land", "guide")
ALIKE: Final = 0.02
"""Share of the mean within which values count as alike, either way."""
BEYOND: Final = 0.01
"""Share of the values that may lie beyond the ends of the colours."""


class _Block:
    """Arrays one behind the other, and where each of them lies."""

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self.size = 0

    def add(self, values: NDArray[Any], kind: str) -> dict[str, Any]:
        data = np.ascontiguousarray(values, dtype={"f4": "<f4", "u4": "<u4", "u2": "<u2"}[kind])
        text = data.tobytes() + b"\0" * (-data.nbytes % 4)
        place = {"at": self.size, "count": int(data.size), "kind": kind, "shape": list(data.shape)}
        self.parts.append(text)
        self.size += len(text)
        return place

    def coded(self, values: NDArray[Any]) -> dict[str, Any]:
        """Numbers as 16-bit steps between their smallest and largest."""
        low, high = float(np.min(values)), float(np.max(values))
        step = (high - low) / FULL
        whole = np.zeros(values.shape) if step == 0.0 else np.rint((values - low) / step)
        return self.add(whole, "u2") | {"low": low, "step": step, "high": high}

    def text(self) -> str:
        return base64.b64encode(gzip.compress(b"".join(self.parts), 6, mtime=0)).decode("ascii")


@dataclass(frozen=True)
class Shown:
    """A bearing that a page shows."""

    result: Result
    shapes: Shapes
    frames: Frames
    name: str = ""  # its name on the shaft; empty where it is alone
    place: float = 0.0  # where its roller-centre plane stands along the axis, from the middle of the picture (m)
    turned: bool = False  # whether it is turned about the x axis, so that its own axis points the other way


def page(
    shown: Sequence[Shown],
    *,
    factor: float | None = None,
    title: str = "",
    shaft: Mapping[str, float] | None = None,
) -> str:
    """The HTML of the view of a bearing, or of the bearings on a shaft, all with frames of the same times.

    The factor is that of exaggeration at the start; the shaft goes ``from`` and ``to`` places along the first bearing's own
    axis, from its roller-centre plane (m).
    """
    block = _Block()
    first = shown[0]
    limits = [
        largest_factor(one.result.scene.bearing, one.shapes, one.frames.pose) if one.result.has_cage else 200.0
        for one in shown
    ]
    largest = min(limits)
    wished = min(default_factor(one.result, largest) for one in shown) if factor is None else factor
    head: dict[str, Any] = {
        "title": title or first.result.scene.bearing.name,
        "about": _about(shown),
        "turning": first.result.scene.turning_ring,
        "factor": min(wished, largest),
        "largest_factor": largest,
        "frames": int(first.frames.index.size),
        "records": first.frames.total,
        "shown": shown_turns(first.result, first.frames),
        "time": block.add(_relative(first.frames.time), "f4") | {"start": float(first.frames.time[0])},
        "turns": block.add(first.frames.turns, "f4"),
        "colours": _colours(),
        "bearings": [_bearing(block, one) for one in shown],
        "shaft": None if shaft is None else dict(shaft),
    }
    head["bytes"] = block.size
    return _fill(head, block.text())


def _about(shown: Sequence[Shown]) -> str:
    """Bearings, speed and loads in words."""
    said = [facts(one.result) for one in shown]
    speed = f"{said[0]['speed']} rpm"
    if len(shown) == 1:
        return f"{said[0]['bearing']}, {speed}, {said[0]['loads']}"
    parts = (f"{one.name}: {fact['bearing']}, {fact['loads']}" for one, fact in zip(shown, said, strict=True))
    return "; ".join((speed, *parts))


def _bearing(block: _Block, one: Shown) -> dict[str, Any]:
    """What the program needs of a bearing."""
    bearing, shapes = one.result.scene.bearing, one.shapes
    return {
        "name": one.name,
        "place": one.place,
        "turned": one.turned,
        "rollers": bearing.n_rollers,
        "slots": len(bearing.slot_names),
        "slot_names": [name.replace("_", " ") or f"face {k}" for k, name in enumerate(bearing.slot_names)],
        "has_cage": one.result.has_cage,
        "geometry": {
            "axis_angle": bearing.geometry.roller_axis_angle,
            "centre_radius": bearing.geometry.roller_centre_radius,
            "centre_height": bearing.geometry.roller_centre_height - bearing.geometry.centre_plane,
            "diameter": bearing.roller.diameter,
            "length": bearing.roller.effective_length,
            "outer_radius": float(np.hypot(*shapes.outer.position[:, :2].T).max()),
            "play_radial": bearing.cage.play_radial,
        },
        "meshes": {name: _mesh(block, mesh) for name in MESHES if (mesh := getattr(shapes, name)) is not None},
        "guidance": one.result.scene.effects.guidance,
        "roller_rows": shapes.roller_rows,
        "row_size": AROUND + 1,
        "faces": [
            {
                "pocket": face.pocket,
                "slot": face.slot,
                "mesh": _mesh(block, face.mesh),
                "centre": face.centre.tolist(),
                "normal": face.normal.tolist(),
                "shift": face.shift.tolist(),
            }
            for face in (shapes.faces if one.result.has_cage else ())
        ],
        "pose": {
            name: block.add(_relative(values) if name == "spin" else values, "f4")
            for name, values in one.frames.pose.items()
        },
        "quantities": [_quantity(block, quantity) for quantity in one.frames.quantities],
    }


def shown_turns(result: Result, frames: Frames) -> str:
    """Which turns are shown, and why, in words."""
    ring = result.scene.turning_ring
    first, last = float(frames.turns[0]), float(frames.turns[-1])
    if frames.index[0] == 0:
        return f"all {last - first:.3g} turns of the {ring} are shown"
    return (
        f"the last {last - first:.3g} of {result.revolutions:.3g} turns of the {ring} are shown, so that single hits "
        "can be seen; revolutions=None shows all"
    )


def _relative(values: NDArray[Any]) -> NDArray[Any]:
    return values - values[0]


def _mesh(block: _Block, mesh: Mesh) -> dict[str, Any]:
    out = {
        "position": block.add(mesh.position, "f4"),
        "normal": block.add(mesh.normal, "f4"),
        "index": block.add(mesh.index, "u4"),
    }
    return out if mesh.shift is None else out | {"shift": block.add(mesh.shift, "f4")}


def _quantity(block: _Block, quantity: Quantity) -> dict[str, Any]:
    text = {name: getattr(quantity, name) for name in ("name", "label", "unit", "kind", "note")}
    low, high, said = colour_range(quantity)
    return text | {"values": block.coded(quantity.values), "range": [low, high], "said": said}


def colour_range(quantity: Quantity) -> tuple[float, float, str]:
    """Values at the ends of the colours, and what must be said of them.

    The colours go over all but 1 % of the values, so that a single hit does not make all others look alike; of forces in pockets
    those that are zero do not count. Where all values lie close together, this is said.
    """
    values, pocket = np.asarray(quantity.values, dtype=float), quantity.kind == "pocket"
    values = values[values > 0.0] if pocket else values.ravel()
    if values.size == 0:
        return 0.0, 0.0, "no pocket is touched"
    least, most = float(values.min()), float(values.max())
    middle = 0.5 * abs(least + most)
    if most - least <= 2.0 * ALIKE * middle:
        return least, most, f"all within {50.0 * (most - least) / middle if middle else 0.0:.1g} % of {middle:.4g}"
    low, high = (float(end) for end in np.quantile(values, (0.5 * BEYOND, 1.0 - 0.5 * BEYOND)))
    low = 0.0 if pocket else low
    if high - low > 0.8 * (most - (0.0 if pocket else least)):
        return (0.0 if pocket else least), most, ""
    return low, high, f"1 % of the values lie beyond, {'up' if pocket else f'{least:.3g}'} to {most:.3g}"


def _colours() -> list[list[float]]:
    """Colours of the scale, dark to light, as the pictures use them."""
    import matplotlib

    return [list(map(float, row)) for row in matplotlib.colormaps["viridis"](np.linspace(0.0, 1.0, 33))[:, :3]]


def _fill(head: dict[str, Any], data: str) -> str:
    here = files("trbdyn.viewer")
    names = {"style": "viewer.css", "bearing": "bearing.js", "program": "viewer.js"}
    parts = {name: here.joinpath(file).read_text(encoding="utf-8") for name, file in names.items()}
    parts |= {
        "title": html.escape(head["title"]),
        "three": three_js().replace("</script", "<\\/script"),
        "head": json.dumps(head, allow_nan=False).replace("<", "\\u003c"),
        "data": data,
    }
    text = here.joinpath("viewer.html").read_text(encoding="utf-8")
    for name, value in parts.items():
        before, mark, after = text.partition("{{" + name + "}}")
        assert mark, name
        text = before + value + after
    return text
