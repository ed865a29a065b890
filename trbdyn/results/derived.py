"""What follows from recorded fields: the observables of a result, by name."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from trbdyn.base.extras import of_extras
from trbdyn.errors import InputError
from trbdyn.model.motion import History
from trbdyn.model.shaft import angle_turned
from trbdyn.results import forces, observables
from trbdyn.results.cage_stress import CageStress
from trbdyn.results.fields import Field
from trbdyn.results.peaks import Peaks
from trbdyn.statics.creep import creep_time

if TYPE_CHECKING:
    from trbdyn.model.scene import Scene

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Clearances:
    """Plays of the cage against one roller, with the cage centred and the roller's large end touching; one-sided, m.

    Attributes
    ----------
    radial, circumferential, axial : float
        Cpr, Cpc, and the axial play of the pocket.
    """

    radial: float
    circumferential: float
    axial: float


class Derived(ABC):
    """Observables over recorded fields, each computed when it is asked for; `trbdyn.observables` says how.

    All need their fields recorded and raise `InputError` otherwise.
    """

    @abstractmethod
    def __getitem__(self, name: str) -> Array:
        """A recorded field."""

    @property
    @abstractmethod
    def fields(self) -> tuple[Field, ...]:
        """The recorded fields."""

    @property
    @abstractmethod
    def scene(self) -> Scene:
        """The scene that was run."""

    @property
    @abstractmethod
    def geometry(self) -> dict[str, float]:
        """Derived geometry of the bearing, SI."""

    @property
    @abstractmethod
    def peaks(self) -> Peaks:
        """Extremes, means and impacts of all steps."""

    def settling(self) -> observables.MotionSettling:
        """Whether the motion has settled, drifts (with its time scale), or cannot be told from this record.

        Judged by the drift of the roller spacing, the cage's orbit radius and its whirl amplitude, each with its
        error, and by the time that the creep of the rollers takes (see `observables.motion_settling`).

        Returns
        -------
        MotionSettling
            Its ``str`` is the answer in words; ``time`` is where averages may begin.
        """
        creep = self.creep_time if self._knows_cage else np.nan
        return observables.motion_settling(self["time"], **self._judged(), creep_time=creep)

    def turn_means(self) -> tuple[Array, dict[str, Array]]:
        """Means over whole turns of the rollers, with the times of the turns (s): what `settling` goes by.

        Returns
        -------
        time : ndarray, shape (N,)
            Mean time of each turn, s.
        means : dict of str to ndarray
            Roller spacing in units of the angle Cpc/(Dpw/2); with a cage orbit radius and whirl amplitude over Cpr.
        """
        return observables.turn_means(self["time"], **self._judged())

    @property
    def _knows_cage(self) -> bool:
        return self.has_cage and self.clearances.radial > 0.0

    def _judged(self) -> dict[str, Array]:
        """What `observables.motion_settling` judges, by the names of its arguments."""
        unit = np.degrees(self.clearances.circumferential / (0.5 * self.scene.bearing.pitch_diameter))
        found = {
            "roller_angle": self["roller_orbit_angle"].mean(axis=1),
            "spacing": self.spacing_std / unit if unit > 0.0 else self.spacing_std,
        }
        if self._knows_cage:
            place = self["cage_position"] / self.clearances.radial
            found |= {"position": place, "cage_angle": self["cage_angle"]}
        return found

    @property
    def creep_time(self) -> float:
        """Time in which creep of the rollers lets the cage's whirl change by its own size, s; nan where it is not
        known.

        From the traction at tiny slip in the equilibrium at the start (see `trbdyn.statics.creep.creep_time`).
        """
        return creep_time(self.scene)

    @property
    def duration(self) -> float:
        """Recorded time, s."""
        time = self["time"]
        return float(time[-1] - time[0]) if time.size else 0.0

    @property
    def revolutions(self) -> float:
        """Turns of the shaft, or of the outer ring where the shaft rests, between the first and the last record."""
        angle = self.turned
        return float(abs(angle[-1] - angle[0]) / (2.0 * np.pi)) if angle.size else 0.0

    @property
    def has_cage(self) -> bool:
        """Whether the scene has a cage; without one, what is recorded of it means nothing."""
        return self.scene.effects.has_cage

    def _of_cage(self, name: str) -> Array:
        """A recorded field of the cage; an error if the scene has none."""
        if not self.has_cage:
            raise InputError.of(
                ("effects", "bodies"), self.scene.effects.bodies, "has no cage: nothing is known of its motion"
            )
        return self[name]

    @property
    def clearances(self) -> Clearances:
        """Radial, circumferential and axial play of the cage, m."""
        cage = self.scene.bearing.cage
        return Clearances(cage.play_radial, cage.play_circumferential, cage.play_axial)

    @property
    def slot_names(self) -> tuple[str, ...]:
        """Name of each face of a pocket: the columns of pocket_force and pocket_friction."""
        return tuple(self.scene.bearing.slot_names)

    def cage_locus(self, plane: Literal["centre", "rail"] = "centre") -> Array:
        """Locus of the cage's centre, in units of the radial play Cpr, shape (T, 2).

        Parameters
        ----------
        plane : {"centre", "rail"}
            The roller-centre plane, or the plane of the large-end rail, where sensors look.
        """
        if plane not in ("centre", "rail"):
            raise InputError.of("plane", plane, "must be 'centre' or 'rail'")
        name = "cage_position" if plane == "centre" else "cage_rail_position"
        return observables.locus(self._of_cage(name), self.clearances.radial)

    @property
    def axial_motion(self) -> Array:
        """Axial position of the cage in units of its axial play, shape (T,); zero where large ends touch, nan without
        play.
        """
        return self._of_cage("cage_position")[:, 2] / (self.clearances.axial or np.nan)

    @property
    def orbit_radius(self) -> Array:
        """Distance of the cage's centre from the centre of its own orbit (its mean place over this record), m, shape
        (T,).

        In the roller-centre plane; it tells how far the cage whirls. Its root mean square is
        ``cage_motion.orbit_over_play``.
        """
        return observables.orbit_radius(self._of_cage("cage_position"))

    @property
    def orbit_radius_over_cpr(self) -> Array:
        """The orbit radius in units of the radial play, shape (T,)."""
        return self.orbit_radius / self.clearances.radial

    @property
    def axis_distance(self) -> Array:
        """Distance of the cage's centre from the bearing axis in the roller-centre plane, m, shape (T,).

        Not the size of the whirl: a cage that hangs still on its rollers lies far from the axis. See `orbit_radius`.
        """
        return observables.axis_distance(self._of_cage("cage_position"))

    @property
    def axis_distance_over_cpr(self) -> Array:
        """The distance from the bearing axis in units of the radial play, shape (T,)."""
        return self.axis_distance / self.clearances.radial

    @property
    def whirl_frequency(self) -> float:
        """Frequency at which the cage's centre turns about its mean place, Hz; negative for backward whirl."""
        return observables.whirl_frequency(self["time"], self._of_cage("cage_position"))

    @property
    def cage_frequency(self) -> float:
        """Rotation frequency of the cage, Hz."""
        return observables.cage_frequency(self["time"], self._of_cage("cage_angle"))

    @property
    def whirl_ratio(self) -> float:
        """Whirl frequency over the cage's rotation frequency."""
        return self.whirl_frequency / self.cage_frequency if self.cage_frequency else float("nan")

    @property
    def cage_speed_ratio(self) -> float:
        """Turn of the cage over the turn of the shaft."""
        return observables.cage_speed_ratio(self._of_cage("cage_angle"), self.turned)

    @property
    def turned(self) -> Array:
        """Angle of the shaft, or of the outer ring where the shaft rests (rad), shape (T,)."""
        return self["shaft_angle"] if self.scene.turning_ring == "shaft" else self._outer_angle()

    def _outer_angle(self) -> Array:
        """Angle of the outer ring (rad), shape (T,)."""
        speed = self.scene.outer_speed_rpm
        return np.array([angle_turned(speed, 0.0, float(time)) for time in self["time"]])

    @property
    def turning_speed(self) -> Array:
        """Speed of the shaft, or of the outer ring where the shaft rests (rad/s), shape (T,)."""
        return self["shaft_speed"] if self.scene.turning_ring == "shaft" else self.outer_speed

    @property
    def rolled(self) -> Array:
        """Angle between the rings (rad), shape (T,): that of the shaft, less that of an outer ring that turns."""
        return self["shaft_angle"] - self._outer_angle() if self.scene.outer_turns else self["shaft_angle"]

    @property
    def rolling_speed(self) -> Array:
        """Speed of the shaft relative to the outer ring (rad/s), shape (T,)."""
        return self["shaft_speed"] - self.outer_speed if self.scene.outer_turns else self["shaft_speed"]

    @property
    def outer_speed(self) -> Array:
        """Speed of the outer ring (rad/s), shape (T,)."""
        speed, time = self.scene.outer_speed_rpm, self["time"]
        rpm = speed.value(time) if isinstance(speed, History) else np.full(time.shape, speed)
        return np.asarray(rpm, dtype=np.float64) * np.pi / 30.0

    @property
    def rolling_orbit(self) -> Array:
        """Speed of the rollers' orbit in pure rolling (rad/s), shape (T,)."""
        return self.geometry["cage_speed_ratio"] * self.rolling_speed + self.outer_speed

    @property
    def cage_motion(self) -> observables.CageMotion:
        """Class of the cage's motion: stable, rocking, circling, unstable, or unknown (see `observables.classify`)."""
        return observables.classify(
            self._of_cage("cage_position"),
            self["cage_velocity"],
            self.clearances.radial,
            cage_angle=self["cage_angle"],
        )

    def spacing_angles(self, n: int = 1) -> Array:
        """Angle from each roller to the n-th after it (the sum of n gaps), rad, shape (T, Z)."""
        return observables.spacing(self["roller_orbit_angle"], n)

    @property
    def spacing_std(self) -> Array:
        """Standard deviation of the gaps between neighbours, degrees, shape (T,)."""
        return observables.spacing_std(self["roller_orbit_angle"])

    @property
    def roller_slip(self) -> Array:
        """Slip of each roller's orbit against pure rolling, shape (T, Z); positive when slower."""
        return observables.kinematic_slip(self["roller_orbit_speed"], self.rolling_orbit, 1.0)

    @property
    def cage_slip(self) -> Array:
        """Slip of the roller set against pure rolling: mean over the rollers, shape (T,)."""
        return self.roller_slip.mean(axis=1)

    @property
    def spin_slip(self) -> Array:
        """Slip of each roller's spin against pure rolling, shape (T, Z); positive when slower."""
        ratio = self.geometry["roller_spin_ratio"]
        return observables.kinematic_slip(np.abs(self["roller_spin_speed"]), np.abs(self.rolling_speed), ratio)

    def pocket_statistics(self, threshold: float = 0.0) -> observables.PocketStatistics:
        """Peak, 95th percentile, mean and duty of the force on each face of each pocket (forces above `threshold`, N).

        With the group 'peaks', peak and mean are those of all steps and not of the records.
        """
        found = observables.pocket_statistics(self._of_cage("pocket_force"), threshold)
        if not any(field.group == "peaks" for field in self.fields):
            return found
        return replace(found, peak=self.peaks["pocket_force_peak"], mean=self.peaks["pocket_force_mean"])

    def cage_stress(self, *, notch_factor: float = 1.0) -> CageStress:
        """Stress at the corners of the pockets of an elastic cage at every record, in bars and rims, with cycles and damage;
        records must be close enough to follow its vibrations.

        Parameters
        ----------
        notch_factor : float
            Factor of the nominal stress (1).

        Raises
        ------
        InputError
            If the cage is rigid, or the groups 'cage' and 'pocket' were not saved.
        """
        self._needs("pocket", "cage_stress")
        if self.scene.elastic_cage is not None:
            self._needs("cage", "cage_stress")
            amplitude = self["cage_mode"]
        else:
            amplitude = np.zeros((0, 0))
        find: Callable[..., CageStress] = of_extras("cage_stress")
        return find(self.scene, self["time"], amplitude, self["pocket_force"], notch_factor=notch_factor)

    def force_spectrum(
        self, on: forces.On = "cage", along: forces.Along = "x", *, segments: int = 1
    ) -> forces.ForceSpectrum:
        """Spectrum of the force on the cage, the sum of all, or on the outer ring, that of the rollers' normal loads; one-sided.

        Parameters
        ----------
        on : {'cage', 'outer_ring'}
            The body; needs the group cage, or rollers and peaks.
        along : {'x', 'y', 'z'}
            Direction; z is the axis of the bearing.
        segments : int
            Number of segments, overlapping by half, that are averaged.

        Raises
        ------
        InputError
            If an argument is not allowed, a group was not saved, or records are uneven or too far apart for the force.
        """
        find: Callable[..., forces.ForceSpectrum] = of_extras("force_spectrum")
        return find(self, on, along, segments)

    def octave_levels(
        self, on: forces.On = "cage", along: forces.Along = "x", *, fraction: Literal[1, 3] = 3
    ) -> forces.OctaveLevels:
        """Levels of a force by octaves or third octaves of IEC 61260-1 (dB re 1 µN), by PyOctaveBand (extra ``trbdyn[sound]``).

        Parameters
        ----------
        on, along
            As in `force_spectrum`.
        fraction : {1, 3}
            1: octaves; 3: third octaves.

        Raises
        ------
        InputError
            As in `force_spectrum`, or if the run is too short for any band.
        ImportError
            If the extra is not installed.
        """
        find: Callable[..., forces.OctaveLevels] = of_extras("octave_levels")
        return find(self, on, along, fraction)

    def sound(
        self,
        path: str | os.PathLike[str],
        on: forces.On = "cage",
        along: forces.Along = "x",
        *,
        full_scale: float | None = None,
        slower: float = 1.0,
        overwrite: bool = False,
    ) -> forces.Sound:
        """Write a force as a sound file: a force and no pressure of sound, which the machine around the bearing makes of it.

        Parameters
        ----------
        path : path-like
            File to write (``.wav``, 16 bits).
        on, along
            As in `force_spectrum`.
        full_scale : float, optional
            Force of the largest sample (N), the same one for files to be compared; by default the largest force.
        slower : float
            How many times slower it is played (1).
        overwrite : bool
            Replace a file that is there.

        Raises
        ------
        InputError
            As in `force_spectrum`, or if the force does not fit into the scale.
        FileError
            If the file is there and shall not be replaced, or cannot be written.
        """
        write: Callable[..., forces.Sound] = of_extras("sound")
        return write(self, path, on, along, full_scale, slower, overwrite)

    @property
    def rattle(self) -> forces.Rattle:
        """How often rollers hit the cage and how hard, between the records too; needs the group peaks."""
        find: Callable[..., forces.Rattle] = of_extras("rattle")
        return find(self)

    def _starting(self, prefix: str) -> dict[str, Array]:
        return {field.name: self[field.name] for field in self.fields if field.name.startswith(prefix)}

    def _needs(self, group: str, what: str) -> None:
        if group not in {field.group for field in self.fields}:
            if group == "pocket" and self.has_cage and not self.scene.effects.has_pockets:
                limit = "rollers do not touch their pockets where pocket_bars and pocket_ends are off"
                raise InputError.of(("effects", "pocket_bars"), False, limit)
            raise InputError.of(what, "not saved", f"needs the group '{group}': put it into save_groups")

    @property
    def torque_split(self) -> dict[str, float]:
        """Mean torque of each force on the inner ring, N m; together the shaft's friction torque.

        A force that makes torque need not lose power: traction on the inner raceway passes on what rolling resistance
        takes at the outer one. What is lost where is told by `power_split` and `torque_by_loss`.

        Raises
        ------
        InputError
            If the group 'torque' was not saved.
        """
        self._needs("torque", "torque_split")
        return observables.torque_split(self._starting("inner_torque_"))

    @property
    def power_split(self) -> dict[str, float]:
        """Mean power loss of each kind, W: from the energies lost where they were recorded, else from the powers.

        Raises
        ------
        InputError
            If neither of the groups 'energy' and 'power' was saved.
        """
        if not any(field.group == "energy" for field in self.fields):
            self._needs("power", "power_split")
        return observables.power_split(self["time"], self._starting("loss_"), self._starting("power_"))

    @property
    def torque_by_loss(self) -> dict[str, float]:
        """Friction torque of the shaft by what loses it, N m: the power loss of each mechanism over the mean speed
        between the rings.

        Unlike `torque_split`, which tells the forces on the inner ring, its shares are those of the power loss. Empty
        at standstill.
        """
        speed = float(np.abs(self.rolling_speed).mean())
        return {name: value / speed for name, value in self.power_split.items()} if speed > 0.0 else {}

    def _energies(self) -> dict[str, Array]:
        self._needs("energy", "energy_audit")
        return {field.name: self[field.name] for field in self.fields if field.group == "energy"}

    @property
    def energy_balance(self) -> dict[str, Array]:
        """Every term of the energy audit since the first record, and the residual, J, shapes (T,)."""
        return observables.energy_balance(self._energies())

    @property
    def energy_audit(self) -> observables.EnergyAudit:
        """The energy audit between the first and the last record."""
        return observables.energy_audit(self._energies())

    @property
    def energy_closure(self) -> float:
        """Size of the audit's residual over the dissipated work."""
        return self.energy_audit.closure
