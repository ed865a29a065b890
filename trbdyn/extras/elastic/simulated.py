"""The modes that a scene's elastic cage deforms by, as the core takes them."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.own_files import digest_of
from trbdyn.errors import InputError
from trbdyn.extras.elastic.cage_solid import CageSolid
from trbdyn.extras.elastic.drawn_solid import drawn_solid, solid_of_cage
from trbdyn.extras.elastic.modes import CageModes
from trbdyn.model.elastic_cage import ElasticCage
from trbdyn.model.pocket import every_surface
from trbdyn.results.cage_stress import COARSER

if TYPE_CHECKING:
    from trbdyn.model.bearing import Bearing
    from trbdyn.model.scene import Scene

FloatArray = NDArray[np.float64]
AT_ONCE: Final = 20
"""Modes are found in groups of so many, so that scenes with a few more or less share them."""


def cage_modes(scene: Scene) -> CageModes:
    """The modes by which the cage of a scene deforms.

    Raises
    ------
    InputError
        If the scene's cage is rigid, or has fewer modes than are asked for.
    FileError
        If a file of modes cannot be read, or is another one than when the scene was made.
    """
    if scene.elastic_cage is None:
        raise InputError.of("elastic_cage", None, "must be given: the cage of this scene is rigid")
    return _modes(scene.bearing, scene.elastic_cage)


@lru_cache(maxsize=8)
def _modes(bearing: Bearing, elastic: ElasticCage) -> CageModes:
    if elastic.file is not None:
        if digest_of(elastic.file) != elastic.file_sha256:
            path = ("elastic_cage", "file_sha256")
            raise InputError.of(path, elastic.file_sha256, f"must be that of {elastic.file}, which has changed since")
        found = CageModes.load(elastic.file)
    else:
        built, frequency, shapes = _natural(bearing, elastic)
        given = bearing.cage_material.damping_ratio if elastic.damping_ratio is None else elastic.damping_ratio
        assert given is not None  # the scene has checked it
        found = CageModes.of_shapes(built, frequency, shapes, given, f"finite elements, cage of {bearing.name}")
    if elastic.n_modes > len(found.frequency):
        limit = f"must be <= {len(found.frequency)}: {elastic.file} has no more modes"
        raise InputError.of(("elastic_cage", "n_modes"), elastic.n_modes, limit)
    each = {name: getattr(found, name)[: elastic.n_modes] for name in ("frequency", "modal_mass", "shape", "stress")}
    ratio = found.damping_ratio[: elastic.n_modes]
    if elastic.damping_ratio is not None:
        ratio = np.full(elastic.n_modes, elastic.damping_ratio)
    coriolis = np.asarray(found.coriolis)[: elastic.n_modes, : elastic.n_modes]
    return replace(found, **each, damping_ratio=ratio, coriolis=coriolis)


def _natural(bearing: Bearing, elastic: ElasticCage) -> tuple[CageSolid, FloatArray, FloatArray]:
    count = AT_ONCE * math.ceil(elastic.n_modes / AT_ONCE)
    built, frequency, shapes = _at_once(bearing, elastic.fineness, elastic.cracked_bars, count)
    return built, frequency[: elastic.n_modes], shapes[:, : elastic.n_modes]


@lru_cache(maxsize=2)
def _at_once(
    bearing: Bearing, fineness: int, cracked_bars: tuple[int, ...], count: int
) -> tuple[CageSolid, FloatArray, FloatArray]:
    built = solid_of_cage(bearing, fineness=fineness, cracked_bars=cracked_bars)
    return built, *built.solid.natural(count)


@lru_cache(maxsize=8)
def stress_at_rest(bearing: Bearing, elastic: ElasticCage) -> FloatArray:
    """Static stress at the corners of the finite-element model for a unit force on each face of each pocket, shape (F, P)
    (Pa/N).
    """
    built, _, _ = _natural(bearing, elastic)
    return np.asarray((built.stress_of @ built.solid.static(built.pushes())).T)


@lru_cache(maxsize=8)
def mesh_difference(bearing: Bearing, elastic: ElasticCage) -> tuple[float, float]:
    """What a mesh with edges `COARSER` times as long changes of a drawn cage: largest relative difference of the frequencies, and
    largest difference of the static stress at the corners under a push on any face, over the largest stress.
    """
    _, frequency, _ = _natural(bearing, elastic)
    coarse = drawn_solid(bearing, fineness=elastic.fineness / COARSER)
    other, _ = coarse.solid.natural(elastic.n_modes)
    stress = stress_at_rest(bearing, elastic)
    changed = np.asarray((coarse.stress_of @ coarse.solid.static(coarse.pushes())).T) - stress
    return float(np.abs(other / frequency - 1.0).max()), float(np.abs(changed).max() / np.abs(stress).max())


def displacements(scene: Scene, amplitude: FloatArray) -> tuple[CageSolid, FloatArray]:
    """The finite-element model of a scene's cage, and the displacements of its nodes (m), shape (N, 3), at amplitudes (m) of its
    modes. A cage that is rigid, or whose modes come from a file, is refused.
    """
    modes = cage_modes(scene)
    elastic = scene.elastic_cage
    assert elastic is not None  # cage_modes has looked
    if elastic.file is not None:
        raise InputError.of(
            ("elastic_cage", "file"), elastic.file, "must not be given: its modes have no finite-element model"
        )
    built, _, shapes = _natural(scene.bearing, elastic)
    scaled = shapes * np.sqrt(modes.modal_mass)  # of unit modal mass before
    return built, (scaled @ amplitude).reshape(-1, 3)


def mode_rows(scene: Scene) -> FloatArray:
    """Modes as the core takes them, shape (M, C): frequency (rad/s), damping ratio, modal mass (kg), then the shapes at each slot
    of each pocket and the Coriolis forces; no rows for a rigid cage.
    """
    if scene.elastic_cage is None:
        return np.zeros((0, 1))
    modes, shapes = cage_modes(scene), shapes_by_slot(scene)
    assert modes.coriolis is not None  # zeros where it is not known
    head = np.stack([2.0 * np.pi * modes.frequency, modes.damping_ratio, modes.modal_mass], axis=1)
    return np.ascontiguousarray(np.hstack([head, shapes.reshape(len(head), -1), modes.coriolis]))


def shapes_by_slot(scene: Scene) -> FloatArray:
    """Shapes of the modes at the faces of the bearing's pockets, shape (M, Z, S, 6); the faces are known by their names."""
    modes, faces = cage_modes(scene), every_surface(scene.bearing)
    places = {key: place for place, key in enumerate(zip(modes.face_pocket, modes.face_name, strict=True))}
    slots = 1 + max(face.slot for _, face in faces)
    shapes = np.zeros((len(modes.frequency), scene.bearing.n_rollers, slots, 6))
    for pocket, face in faces:
        place = places.get((pocket, face.name))
        if place is None:
            limit = f"must have shapes at face '{face.name}' of pocket {pocket}, as the bearing has it"
            raise InputError.of(("elastic_cage", "file"), modes.source, limit)
        shapes[:, pocket, face.slot] = modes.shape[:, place]
    return shapes
