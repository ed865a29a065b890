"""A result as an animated glTF 2.0 file (.glb), which slides, web pages and 3-D programs play.

Source of the format: Khronos Group, glTF 2.0 Specification (ISO/IEC 12113:2022). Lengths in m; z is the bearing axis.
"""

from __future__ import annotations

import json
import math
import os
import struct
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from trbdyn.base.own_files import output_path, write_whole
from trbdyn.errors import InputError
from trbdyn.model.bearing import Bearing
from trbdyn.results.result import Result
from trbdyn.results.sources import files_of
from trbdyn.viewer.data import Frames, check, default_factor, frames
from trbdyn.viewer.fit import largest_factor
from trbdyn.viewer.meshes import Mesh, join
from trbdyn.viewer.shapes import Shapes, shapes

Array = NDArray[np.float64]

_FLOAT, _UINT = 5126, 5125
_STEP: Final = math.radians(60.0)
"""Largest turn of a body between two key frames: players turn bodies along the shorter way."""
_COLOURS: Final = {
    "cup": (0.55, 0.60, 0.66),
    "cone": (0.48, 0.55, 0.62),
    "rollers": (0.72, 0.76, 0.80),
    "mark": (0.05, 0.05, 0.06),
    "cage": (0.62, 0.42, 0.12),
    "pocket": (0.80, 0.62, 0.30),
}


def save_gltf(
    result: Result,
    path: str | os.PathLike[str],
    *,
    revolutions: float | None = 2.0,
    max_frames: int = 600,
    exaggeration: float | None = None,
    seconds_per_turn: float = 4.0,
    overwrite: bool = False,
) -> Path:
    """Write the motion as an animated glTF file.

    Parameters
    ----------
    result : Result
        Needs the groups time, cage and rollers.
    path : path-like
        File to write, ``NAME.glb``.
    revolutions : float or None
        Number of last turns of the shaft; None takes the whole run.
    max_frames : int
        Most records to take; key frames between them are added where a body turns far.
    exaggeration : float, optional
        Factor by which motion and clearances of cage and rollers are drawn larger; the default is that of
        `trbdyn.view`. It stands in the name of the animation.
    seconds_per_turn : float
        Time that a turn of the shaft takes when played (s).
    overwrite : bool
        Replace a file that is there; never the file of the result.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        If a group was not recorded or an argument is not allowed.
    FileError
        If the file is there and shall not be replaced, or cannot be written.

    Examples
    --------
    >>> import tempfile, trbdyn as trb
    >>> from trbdyn.viewer import save_gltf
    >>> result = trb.Simulation(trb.cases.scene_30310(3000.0, 4930.0)).run(revolutions=0.2)
    >>> save_gltf(result, tempfile.mkdtemp() + "/bearing.glb").suffix
    '.glb'
    """
    how: dict[str, Any] = {"overwrite": overwrite, "endings": (".glb",), "reads": files_of(result)}
    output_path(path, field="path", **how)  # before the frames are made, which takes a while
    check(result, revolutions, max_frames)
    if not 1e-3 <= seconds_per_turn <= 1e4:
        raise InputError.of("seconds_per_turn", seconds_per_turn, "must be from 0.001 to 10000 (s)")
    if exaggeration is not None and not 1.0 <= exaggeration <= 1e4:
        raise InputError.of("exaggeration", exaggeration, "must be from 1 to 10000 (1)")
    bearing = result.scene.bearing
    half = 0.5 * bearing.roller.effective_length
    guidance = result.scene.effects.guidance if result.has_cage else "rollers"
    meshes = shapes(bearing, np.linspace(-half, half, 13), guidance)
    taken = frames(result, revolutions=revolutions, max_frames=max_frames, along=False)
    largest = largest_factor(bearing, meshes, taken.pose) if result.has_cage else math.inf
    factor = min(default_factor(result, largest) if exaggeration is None else exaggeration, largest)
    data = _Document(bearing, meshes, factor, result.has_cage).write(taken, seconds_per_turn)
    return write_whole(path, data, **how)


class _Document:
    """A glTF document under construction."""

    def __init__(self, bearing: Bearing, meshes: Shapes, factor: float, has_cage: bool) -> None:
        self.bearing, self.meshes, self.factor, self.has_cage = bearing, meshes, factor, has_cage
        self.binary = bytearray()
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []
        self.materials = [
            {
                "name": name,
                "doubleSided": True,
                "pbrMetallicRoughness": {
                    "baseColorFactor": [*colour, 1.0],
                    "metallicFactor": 0.2,
                    "roughnessFactor": 0.6,
                },
            }
            for name, colour in _COLOURS.items()
        ]
        self.parts: list[dict[str, Any]] = []
        self.nodes: list[dict[str, Any]] = []
        self.samplers: list[dict[str, Any]] = []
        self.channels: list[dict[str, Any]] = []

    def _accessor(self, values: NDArray[Any], kind: str, target: int | None = None) -> int:
        whole = values.dtype.kind in "iu"
        data = np.ascontiguousarray(values, dtype="<u4" if whole else "<f4")
        view: dict[str, Any] = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": data.nbytes}
        if target is not None:
            view["target"] = target
        self.views.append(view)
        self.binary += data.tobytes()
        rows = data.reshape(data.shape[0], -1)
        accessor: dict[str, Any] = {
            "bufferView": len(self.views) - 1,
            "componentType": _UINT if whole else _FLOAT,
            "count": int(data.shape[0]),
            "type": kind,
            "min": rows.min(axis=0).tolist(),
            "max": rows.max(axis=0).tolist(),
        }
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def _primitive(self, mesh: Mesh, material: str) -> dict[str, Any]:
        attributes = {
            "POSITION": self._accessor(mesh.exaggerated(self.factor), "VEC3", 34962),
            "NORMAL": self._accessor(mesh.normal, "VEC3", 34962),
        }
        index = self._accessor(mesh.index.astype(np.uint32).reshape(-1, 1), "SCALAR", 34963)
        return {"attributes": attributes, "indices": index, "material": list(_COLOURS).index(material)}

    def _mesh(self, name: str, *meshes: tuple[Mesh, str]) -> int:
        self.parts.append({"name": name, "primitives": [self._primitive(mesh, material) for mesh, material in meshes]})
        return len(self.parts) - 1

    def _node(self, name: str, mesh: int) -> int:
        self.nodes.append({"name": name, "mesh": mesh})
        return len(self.nodes) - 1

    def write(self, taken: Frames, seconds_per_turn: float) -> bytes:
        """The bytes of the file."""

        meshes, count = self.meshes, self.bearing.n_rollers
        time, pose = _keys(taken, seconds_per_turn, count)
        cup = self._node("cup", self._mesh("cup", (meshes.outer, "cup")))
        self._time = self._accessor(time.reshape(-1, 1), "SCALAR")
        if any(np.any(pose[f"cup_{axis}"]) for axis in "xyz"):
            self._move(cup, *self._body(pose, "cup"))
        ring = self._body(pose, "ring", pose["shaft"])
        self._move(self._node("cone", self._mesh("cone", (meshes.inner, "cone"))), *ring)
        if meshes.land is not None:
            land = self._node("land", self._mesh("land", (meshes.land, "cup")))
            if meshes.land_turns:
                self._move(land, *ring)
        roller = self._mesh("roller", (meshes.roller, "rollers"), (meshes.mark, "mark"))
        for number in range(count):
            self._move(self._node(f"roller {number}", roller), *self._roller(pose, number))
        if self.has_cage:
            faces = join([face.mesh for face in meshes.faces])
            whole = meshes.cage if meshes.guide is None else join([meshes.cage, meshes.guide])
            body = self._node("cage", self._mesh("cage", (whole, "cage"), (faces, "pocket")))
            self._move(body, *self._body(pose, "cage", pose["cage_angle"]))
        name = f"{self.bearing.name}, motion and clearances x {self.factor:g}"
        head = {
            "asset": {"version": "2.0", "generator": "trbdyn"},
            "scene": 0,
            "scenes": [{"nodes": list(range(len(self.nodes)))}],
            "nodes": self.nodes,
            "meshes": self.parts,
            "materials": self.materials,
            "animations": [{"name": name, "samplers": self.samplers, "channels": self.channels}],
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": len(self.binary)}],
        }
        text = json.dumps(head, separators=(",", ":"), allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        data = bytes(self.binary) + b"\0" * (-len(self.binary) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
        return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks

    def _move(self, node: int, place: Array, turn: Rotation) -> None:
        quaternion = turn.as_quat()
        # a player interpolates between neighbours: keep them on the same side
        flips = np.cumprod(np.where(np.einsum("ij,ij->i", quaternion[1:], quaternion[:-1]) < 0.0, -1.0, 1.0))
        quaternion[1:] *= flips[:, None]
        for path, values, kind in (("translation", place, "VEC3"), ("rotation", quaternion, "VEC4")):
            sampler = {"input": self._time, "output": self._accessor(values, kind), "interpolation": "LINEAR"}
            self.samplers.append(sampler)
            self.channels.append({"sampler": len(self.samplers) - 1, "target": {"node": node, "path": path}})

    def _body(self, pose: dict[str, Array], body: str, angle: Array | None = None) -> tuple[Array, Rotation]:
        """Place and turn of cup, ring or cage, which has turned about its axis by an angle (rad)."""
        place = self.factor * np.stack([pose[f"{body}_{axis}"] for axis in "xyz"], axis=1)
        tilt = np.stack([pose[f"{body}_tilt_x"], pose[f"{body}_tilt_y"], np.zeros_like(pose["shaft"])], axis=1)
        tilted = Rotation.from_rotvec(self.factor * tilt)
        return place, tilted if angle is None else tilted * _about("z", angle)

    def _roller(self, pose: dict[str, Array], number: int) -> tuple[Array, Rotation]:
        geometry, factor = self.bearing.geometry, self.factor
        psi, r, z, skew, tilt, spin = (pose[name][:, number] for name in ("psi", "r", "z", "skew", "tilt", "spin"))
        angle = pose["cage_angle"] + 2.0 * np.pi * number / self.bearing.n_rollers + factor * psi
        radius = geometry.roller_centre_radius + factor * r
        height = geometry.roller_centre_height - geometry.centre_plane + factor * z
        place = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
        turns = (("z", angle), ("y", geometry.roller_axis_angle + factor * tilt), ("x", -factor * skew), ("z", spin))
        turn = _about(*turns[0])
        for axis, values in turns[1:]:
            turn = turn * _about(axis, values)
        return place, turn


def _about(axis: str, angles: Array) -> Rotation:
    """Turns about x, y or z by angles (rad)."""
    turn = np.zeros((angles.size, 3))
    turn[:, "xyz".index(axis)] = angles
    return Rotation.from_rotvec(turn)


def _keys(taken: Frames, seconds_per_turn: float, count: int) -> tuple[Array, dict[str, Array]]:
    """Times when played (s) and poses of the key frames: those taken, and more between them where a body turns far."""
    turns = np.abs(np.diff(taken.pose["spin"], axis=0)).max() + np.abs(np.diff(taken.pose["shaft"])).max()
    parts = max(1, math.ceil(turns / _STEP))
    given = np.arange(taken.index.size, dtype=float)
    wanted = np.linspace(0.0, given[-1], (given.size - 1) * parts + 1)
    pose = {}
    for name, values in taken.pose.items():
        columns = values.reshape(given.size, -1)
        pose[name] = np.stack([np.interp(wanted, given, column) for column in columns.T], axis=1).reshape(
            wanted.size, *values.shape[1:]
        )
    turned = float(taken.turns[-1] - taken.turns[0])
    played = max(turned * seconds_per_turn, 1e-3) if turned > 1e-6 else 10.0
    time = taken.time - taken.time[0]
    return np.interp(wanted, given, time) * played / float(time[-1]), pose
