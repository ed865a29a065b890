"""Natural modes of a cage and their file (docs/theory/cage.md#the-file-of-modes).

A mode has a frequency, a damping ratio, a modal mass, and for each unit of its amplitude q the motion of every face's frame
and the stress at named points. Its equation is q'' + 2 zeta w q' + w^2 q = (sum over faces of shape . wrench)/(modal mass).
Modes come from the finite elements of the package (`CageModes.of_body`), or from a file that another finite-element program's
results were written to.
"""

from __future__ import annotations

import io
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.own_files import write_whole
from trbdyn.base.reading import checked_file, unpacked_limit
from trbdyn.errors import FileError, InputError
from trbdyn.extras.elastic.cage_solid import CageSolid
from trbdyn.extras.elastic.drawn_solid import solid_of_cage
from trbdyn.model.bearing import Bearing

FloatArray = NDArray[np.float64]
FORMAT: Final = "trbdyn cage modes"
VERSION: Final = 1
UNITS: Final = {
    "frequency": "Hz",
    "damping_ratio": "1",
    "modal_mass": "kg",
    "shape": "1, 1/m",
    "point_place": "m",
    "stress": "Pa/m",
    "coriolis": "kg",
    "face_pocket": "1",
    "face_name": "",
    "point_name": "",
}

MOST: Final = 200
"""Most modes of a finite-element model: higher ones need a finer mesh."""
OPTIONAL: Final = ("coriolis",)
"""Datasets that a file may lack."""


@dataclass(frozen=True, eq=False)
class CageModes:
    """Natural modes of a free cage; the six motions of a rigid body are not among them.

    Attributes
    ----------
    frequency : ndarray, shape (M,)
        Natural frequencies, rising (Hz).
    damping_ratio : ndarray, shape (M,)
        Damping over the critical one (1).
    modal_mass : ndarray, shape (M,)
        Kinetic energy over half of the amplitude's rate squared (kg).
    face_pocket, face_name : tuple of int, tuple of str, length F
        The faces: number of the pocket and name of the face in it.
    shape : ndarray, shape (M, F, 6)
        Motion of each face for a unit of amplitude: displacement of its outline's middle (1) and rotation (1/m), in the axes
        n, t, a of its pocket.
    point_name : tuple of str, length P
        Names of the points of stress.
    point_place : ndarray, shape (P, 3)
        Where they are in the cage's frame: origin on the axis in the roller-centre plane, x through the middle of pocket 0 (m).
    stress : ndarray, shape (M, P)
        Normal stress along the bar for a unit of amplitude (Pa/m).
    source : str
        Where the modes come from.
    coriolis : ndarray, shape (M, M)
        Coriolis force on the first mode, over the rate of the second one's amplitude and the angular velocity of the cage about
        its axis (kg); row i at j is minus row j at i. Zero where it is not known.
    """

    frequency: FloatArray
    damping_ratio: FloatArray
    modal_mass: FloatArray
    face_pocket: tuple[int, ...]
    face_name: tuple[str, ...]
    shape: FloatArray
    point_name: tuple[str, ...]
    point_place: FloatArray
    stress: FloatArray
    source: str = ""
    coriolis: FloatArray | None = None

    def __post_init__(self) -> None:
        modes, faces, points = len(self.frequency), len(self.face_name), len(self.point_name)
        if self.coriolis is None:
            object.__setattr__(self, "coriolis", np.zeros((modes, modes)))
        for name, shape in (
            ("frequency", (modes,)),
            ("damping_ratio", (modes,)),
            ("modal_mass", (modes,)),
            ("face_pocket", (faces,)),
            ("shape", (modes, faces, 6)),
            ("point_place", (points, 3)),
            ("stress", (modes, points)),
            ("coriolis", (modes, modes)),
        ):
            values = np.asarray(getattr(self, name))
            if values.shape != shape:
                raise InputError.of(name, f"shape {values.shape}", f"must have the shape {shape}")
            if not np.all(np.isfinite(values)):
                raise InputError.of(name, "not finite", "must be finite numbers")
        if modes == 0 or not np.all(np.diff(self.frequency) >= 0.0) or not self.frequency[0] > 0.0:
            limit = "must be > 0 and rising: without the motions of a rigid body (Hz)"
            raise InputError.of("frequency", np.array2string(self.frequency, precision=4, threshold=8), limit)
        if not np.array_equal(np.asarray(self.coriolis), -np.asarray(self.coriolis).T):
            raise InputError.of("coriolis", "an array", "must be antisymmetric: Coriolis forces do no work (kg)")
        if not np.all(self.modal_mass > 0.0):
            raise InputError.of("modal_mass", float(np.min(self.modal_mass)), "must be > 0 (kg)")
        if not np.all((self.damping_ratio >= 0.0) & (self.damping_ratio < 1.0)):
            worst = self.damping_ratio[np.argmax(np.abs(self.damping_ratio))]
            raise InputError.of("damping_ratio", float(worst), "must be >= 0 and < 1 (1)")
        pairs = list(zip(self.face_pocket, self.face_name, strict=True))
        for what, names in (("face_name", pairs), ("point_name", self.point_name)):
            if len(set(names)) != len(names):
                double = next(name for place, name in enumerate(names) if name in names[:place])
                raise InputError.of(what, str(double), "must not stand there twice")

    @classmethod
    def of_body(cls, bearing: Bearing, count: int = 20, **elements: Any) -> CageModes:
        """Modes of the finite-element model of a bearing's cage (`trbdyn.extras.elastic.drawn_solid.solid_of_cage`).

        Parameters
        ----------
        bearing : Bearing
            A bearing whose cage has a `drawing` or a `body`; its material must have density and damping ratio.
        count : int
            Number of modes.
        **elements
            Further arguments of `solid_of_cage`.

        Raises
        ------
        InputError
            If the cage or its material lacks something.
        """
        damping = bearing.cage_material.damping_ratio
        if damping is None:
            raise InputError.of(("bearing", "cage", "material", "damping_ratio"), None, "must be given (1)")
        if not 1 <= count <= MOST:
            raise InputError.of("count", count, f"must be from 1 to {MOST}")
        built = solid_of_cage(bearing, **elements)
        frequency, shapes = built.solid.natural(count)
        return cls.of_shapes(built, frequency, shapes, damping, f"finite elements, cage of {bearing.name}")

    @classmethod
    def of_shapes(
        cls, built: CageSolid, frequency: FloatArray, shapes: FloatArray, damping: float, source: str
    ) -> CageModes:
        """Modes from shapes of unit modal mass of a model, scaled so that the largest displacement of a face is 1."""
        shape = (built.at_faces @ shapes).T.reshape(len(frequency), -1, 6)
        largest = np.linalg.norm(shape[:, :, :3], axis=2).max(axis=1)
        largest = np.where(
            largest > 1e-9 * largest.max(), largest, 1.0
        )  # a mode that no face feels keeps its unit mass
        return cls(
            frequency=frequency,
            damping_ratio=np.full(len(frequency), damping),
            modal_mass=1.0 / largest**2,
            face_pocket=tuple(pocket for pocket, _ in built.faces),
            face_name=tuple(face.name for _, face in built.faces),
            shape=shape / largest[:, None, None],
            point_name=built.corners,
            point_place=built.corner_places,
            stress=(built.stress_of @ shapes / largest).T,
            coriolis=built.coriolis(shapes / largest),
            source=source,
        )

    def save(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
        """Write the modes as HDF5.

        Parameters
        ----------
        path : path-like
            File to write.
        overwrite : bool
            Replace a file that is there.

        Raises
        ------
        FileError
            If the file cannot be written.
        """
        import h5py

        memory = io.BytesIO()
        with h5py.File(memory, "w") as file:
            file.attrs.update({"format": FORMAT, "version": VERSION, "source": self.source})
            for name, symbol in UNITS.items():
                values = getattr(self, name)
                text = name.endswith("_name")
                data = file.create_dataset(name, data=list(values) if text else np.asarray(values))
                data.attrs["unit"] = symbol
        return write_whole(path, memory.getvalue(), overwrite=overwrite)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> CageModes:
        """Read modes from a file that `save`, or a script for a finite-element program, has written.

        Raises
        ------
        FileError
            If it is no such file, or something is missing or wrong in it.
        """
        import h5py

        size = checked_file(path, "HDF5").stat().st_size
        try:
            with h5py.File(path, "r") as file:
                if file.attrs.get("format") != FORMAT:
                    raise FileError(f"{path}: is no file of cage modes: its attribute format is not '{FORMAT}'")
                if file.attrs.get("version") != VERSION:
                    raise FileError(f"{path}: has version {file.attrs.get('version')} of the format; {VERSION} is read")
                if missing := [name for name in UNITS if name not in file and name not in OPTIONAL]:
                    raise FileError(f"{path}: lacks {', '.join(missing)}")
                if large := [name for name in UNITS if name in file and file[name].nbytes > unpacked_limit(size)]:
                    raise FileError(f"{path}: {large[0]} would take {file[large[0]].nbytes / 1e6:.0f} MB in memory")
                numbers = {name: file[name][()] for name in UNITS if not name.endswith("_name") and name in file}
                texts = {name: tuple(file[name].asstr()[()]) for name in UNITS if name.endswith("_name")}
                source = str(file.attrs.get("source", ""))
        except FileError:
            raise
        except (OSError, TypeError, KeyError, ValueError) as error:
            raise FileError(f"{path}: the modes cannot be read: {error}") from error
        pockets = tuple(int(number) for number in numbers.pop("face_pocket"))
        try:
            values: dict[str, Any] = {name: np.asarray(array, dtype=float) for name, array in numbers.items()}
            return cls(face_pocket=pockets, source=source, **(values | texts))
        except (InputError, TypeError, ValueError) as error:
            raise FileError(f"{path}: {error}") from error
