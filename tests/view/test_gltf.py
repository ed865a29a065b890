"""The animated glTF file: well-formed, and bodies where the records have them."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import trbdyn as trb
from trbdyn.viewer import save_gltf

SIZES = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}


def read(path: Path) -> tuple[dict[str, Any], list[Any]]:
    """The head and every accessor's values, by the rules of the specification."""
    data = path.read_bytes()
    magic, version, length = struct.unpack_from("<III", data)
    assert (magic, version, length) == (0x46546C67, 2, len(data))
    size, kind = struct.unpack_from("<II", data, 12)
    assert kind == 0x4E4F534A
    assert size % 4 == 0
    head = json.loads(data[20 : 20 + size])
    rest, kind = struct.unpack_from("<II", data, 20 + size)
    assert kind == 0x004E4942
    binary = data[28 + size : 28 + size + rest]
    assert head["buffers"][0]["byteLength"] <= rest
    values = []
    for accessor in head["accessors"]:
        view = head["bufferViews"][accessor["bufferView"]]
        dtype = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]
        width = SIZES[accessor["type"]]
        assert view["byteOffset"] % 4 == 0
        assert view["byteLength"] == 4 * width * accessor["count"]
        array = np.frombuffer(binary, dtype, accessor["count"] * width, view["byteOffset"]).reshape(-1, width)
        assert np.all(np.isfinite(array))
        assert np.allclose(array.min(axis=0), accessor["min"])
        assert np.allclose(array.max(axis=0), accessor["max"])
        values.append(array)
    return head, values


@pytest.fixture(scope="module")
def document(whirling: trb.Result, tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, Any], list[Any]]:
    path = save_gltf(
        whirling,
        tmp_path_factory.mktemp("gltf") / "a.glb",
        revolutions=1.0,
        max_frames=101,
        exaggeration=1.0,
        seconds_per_turn=3.0,
    )
    return read(path)


def test_it_is_well_formed(document: tuple[dict[str, Any], list[Any]]) -> None:
    head, values = document
    assert head["asset"]["version"] == "2.0"
    for mesh in head["meshes"]:
        for primitive in mesh["primitives"]:
            index, position = values[primitive["indices"]], values[primitive["attributes"]["POSITION"]]
            normal = values[primitive["attributes"]["NORMAL"]]
            assert index.max() < position.shape[0] == normal.shape[0]
            assert np.allclose(np.linalg.norm(normal, axis=1), 1.0, atol=1e-4)
            a, b, c = position[index.reshape(-1, 3)].transpose(1, 0, 2)
            facing = np.einsum("ij,ij->i", np.cross(b - a, c - a), normal[index.reshape(-1, 3)].sum(axis=1))
            assert (facing >= -1e-12).all(), mesh["name"]
    (animation,) = head["animations"]
    assert "x 1" in animation["name"]
    for channel in animation["channels"]:
        sampler = animation["samplers"][channel["sampler"]]
        assert values[sampler["input"]].shape[0] == values[sampler["output"]].shape[0]
        time = values[sampler["input"]][:, 0]
        assert np.all(np.diff(time) > 0)
        assert time[-1] == pytest.approx(3.0, rel=1e-2)
        if channel["target"]["path"] == "rotation":
            turn = values[sampler["output"]]
            assert np.allclose(np.linalg.norm(turn, axis=1), 1.0, atol=1e-5)
            assert np.einsum("ij,ij->i", turn[1:], turn[:-1]).min() > np.cos(np.pi / 4)  # less than a quarter turn


def test_bodies_are_where_they_were_recorded(document: tuple[dict[str, Any], list[Any]], whirling: trb.Result) -> None:
    head, values = document
    shown = whirling.window(start=float(whirling.time[-1]) - 0.02 - 1e-9)
    names = [node["name"] for node in head["nodes"]]
    tracks: dict[tuple[str, str], Any] = {}
    for channel in head["animations"][0]["channels"]:
        sampler = head["animations"][0]["samplers"][channel["sampler"]]
        tracks[names[channel["target"]["node"]], channel["target"]["path"]] = values[sampler["output"]]
    plane = np.array([0.0, 0.0, whirling.scene.bearing.geometry.centre_plane])
    for number in (0, 7):
        place = tracks[f"roller {number}", "translation"]
        assert np.allclose(place[[0, -1]], shown.roller_position[[0, -1], number] - plane, atol=2e-8)
        axis = Rotation.from_quat(tracks[f"roller {number}", "rotation"]).apply([0.0, 0.0, 1.0])
        w, *v = shown.roller_orientation[-1, number]
        assert np.allclose(axis[-1], Rotation.from_quat([*v, w]).apply([0.0, 0.0, 1.0]), atol=1e-6)
    assert np.allclose(tracks["cage", "translation"][-1], shown.cage_position[-1], atol=1e-9)
    w, *v = shown.cage_orientation[-1]
    turn = Rotation.from_quat(tracks["cage", "rotation"][-1]) * Rotation.from_quat([*v, w]).inv()
    assert turn.magnitude() < 1e-5


def test_bad_arguments_are_refused(whirling: trb.Result, tmp_path: Path) -> None:
    with pytest.raises(trb.InputError, match="seconds_per_turn = 0"):
        save_gltf(whirling, tmp_path / "a.glb", seconds_per_turn=0.0)
    with pytest.raises(trb.FileError, match="cannot be written"):
        save_gltf(whirling, tmp_path / "none" / "a.glb", max_frames=3)
