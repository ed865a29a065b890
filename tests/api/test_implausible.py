"""Inputs that contradict each other are refused, what can hardly be meant is said, and kept with the result."""

from __future__ import annotations

import math
import pickle
import warnings
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.cage_space import CageSpace
from trbdyn.statics.plausible import UnusualInput

RIG = trb.cases.rig_30310()


def with_cage(**numbers: Any) -> trb.Bearing:
    return RIG.replace(cage=RIG.cage.replace(**numbers))


@pytest.mark.parametrize(
    ("numbers", "match"),
    [
        ({"mass": 86.0}, r"bearing\.cage\.mass = 86\.0 : must be <= 2\.87.*the cage's material, 7810"),
        # the inertia of steel with the mass of plastic
        (
            {"mass": 0.033, "inertia_axial": 3.9e-4, "inertia_transverse": 2.1e-4},
            r"inertia_axial = .*gyration is 109 mm",
        ),
        ({"mass": 1e-3, "inertia_axial": 1.0, "inertia_transverse": 0.6}, r"inertia_axial = 1\.0 : must be from"),
        ({"inertia_axial": 3.9e-6, "inertia_transverse": 2.1e-6}, "gyration is 4.42 mm"),
        (
            {"inertia_axial": 3.9e-4, "inertia_transverse": 1e-3},
            r"inertia_transverse = 0\.001 : must be from 0\.000195",
        ),
    ],
)
def test_no_cage_of_this_bearing_has_such_mass_and_inertia(numbers: dict[str, float], match: str) -> None:
    with pytest.raises(trb.InputError, match=match):
        with_cage(**numbers)


def test_bodies_that_fill_the_space_are_allowed() -> None:
    """Hoops, discs and tubes anywhere in the cage's space: their integrals, done here, pass."""
    space, random = CageSpace.of(RIG), np.random.default_rng(3)
    for _ in range(200):
        inner, outer = np.sort(random.uniform(space.inner, space.outer, 2))
        half = random.uniform(0.0, space.half_width)
        mass = 10.0 ** random.uniform(-3.0, 0.4)
        axial = 0.5 * mass * (inner**2 + outer**2)
        transverse = 0.5 * axial + mass * half**2 / 3.0
        found = with_cage(mass=mass, inertia_axial=axial, inertia_transverse=transverse * (1 + 1e-15))
        assert found.cage.mass == mass


def test_the_inertia_follows_a_mass_that_is_changed() -> None:
    """A study that changes the mass alone keeps the radius of gyration, for shipped bearings and those of a catalogue."""
    page = trb.Bearing.from_catalogue(bore=0.04, outside=0.08, width=0.02475, C=74.8e3, e=0.37)
    for bearing in (RIG, trb.cases.bearing_32216(), page):
        light = bearing.replace({"cage.mass": 0.2 * bearing.cage.mass}).cage
        assert light.inertia_axial == pytest.approx(0.2 * bearing.cage.inertia_axial)
        assert light.inertia_transverse == pytest.approx(0.2 * bearing.cage.inertia_transverse)
    assert (RIG.cage.inertia_axial, RIG.cage.inertia_transverse) == (3.9e-4, 2.1e-4)


def unusual(bearing: trb.Bearing, **changes: Any) -> tuple[str, ...]:
    fields = {"speed_rpm": 1000.0, "axial_load": 1000.0, **changes}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UnusualInput)
        return trb.Simulation(trb.Scene(bearing, **fields)).warnings


def test_what_can_hardly_be_meant_is_said() -> None:
    assert unusual(RIG) == ()
    assert unusual(with_cage(mass=0.033)) == ()
    (light,) = unusual(with_cage(mass=1e-3))
    assert "mass = 0.001 kg is light" in light
    (heavy,) = unusual(with_cage(mass=2.5))
    assert "is heavy" in heavy
    (apart,) = unusual(with_cage(mass=0.16, inertia_axial=3.9e-4, inertia_transverse=2.1e-4))
    assert "at a radius of 49.4 mm" in apart


def test_a_number_of_rollers_changed_by_hand_says_that_sizes_stay() -> None:
    page = {"bore": 0.04, "outside": 0.08, "width": 0.02475, "C": 74.8e3, "e": 0.37}
    bearing = trb.Bearing.from_catalogue(**page)
    (said,) = unusual(bearing.replace(n_rollers=13))
    assert "bearing.n_rollers was changed" in said
    assert "Bearing.from_catalogue" in said
    assert unusual(trb.Bearing.from_catalogue(**page, n_rollers=15)) == ()


def test_a_result_says_that_its_raceways_would_be_dented() -> None:
    """Above 4 GPa by its start; and in a run whose load rises, by its largest pressure."""
    with pytest.warns(UnusualInput, match="ISO 76"):
        result = trb.Simulation(trb.Scene(RIG, speed_rpm=1000.0, axial_load=1e6)).run(revolutions=0.01)
    assert any("GPa" in text for text in result.warnings)
    assert len(result.warnings) == 1
    load = trb.History(times=(0.0, 1e-3), values=(5e3, 4e5))
    rising = trb.Scene(RIG, speed_rpm=1000.0, axial_load=load, ring="follows")
    with pytest.warns(trb.RunWarning, match="largest pressure on a raceway"):
        result = trb.Simulation(rising).run(duration=1.2e-3)
    assert sum("ISO 76" in text for text in result.warnings) == 1


def test_a_pure_radial_load_points_to_displacement() -> None:
    with pytest.raises(trb.InputError, match=r"axial_load = 0\.0 : must be > 0.*displacement = \(None, None, -20e-6\)"):
        trb.Simulation(trb.Scene(RIG, speed_rpm=1000.0, radial_load=3e3))
    scene = trb.Scene(RIG, speed_rpm=1000.0, radial_load=3e3, displacement=(None, None, -20e-6))
    assert trb.Simulation(scene).equilibrium.outer_load.max() > 0.0


def test_an_oil_by_its_name() -> None:
    scene = trb.Scene(RIG, speed_rpm=1000.0, axial_load=1e3, lubricant="vg68")
    assert scene.lubricant == trb.Lubricant(oil="vg68", temperature_c=60.0)
    assert scene.lubricant == trb.lubricants.vg68()
    with pytest.raises(trb.InputError, match=r"lubricant = 'vg69' : must be one of vg100"):
        trb.Scene(RIG, speed_rpm=1000.0, axial_load=1e3, lubricant="vg69")
    for name, made in trb.lubricants.OILS.items():
        assert getattr(trb.lubricants, name) is made
        oil = made(50.0)
        assert oil.temperature_c == 50.0
        assert pickle.loads(pickle.dumps(made)) is made
        assert pickle.loads(pickle.dumps(oil)) == oil


def test_files_of_the_package_are_no_names_for_users() -> None:
    assert not {"lubricant", "shipped", "supply", "viscosity"} & set(dir(trb.lubricants))
    assert math.isclose(trb.lubricants.wooster(0.0346), 2.085e-8, rel_tol=1e-3)


@pytest.mark.parametrize(
    ("effects", "roughness", "words"),
    [
        ({"pocket_film": 5e-3}, 1e-6, "more than a tenth of the roller's diameter"),
        ({"pocket_film": 1e-5}, 1e-4, "less than twice bearing.roughness.pocket"),
        ({"pocket_film": 1e-5, "lubrication": "boundary"}, 1e-6, "makes no film"),
        ({"pocket_film": 1e-5}, 1e-6, ""),
    ],
)
def test_a_film_in_the_pockets_that_is_hardly_one(effects: dict[str, Any], roughness: float, words: str) -> None:
    bearing = RIG.replace({"roughness.pocket": roughness})
    scene = trb.Scene(bearing, speed_rpm=1000.0, axial_load=1e3, effects=trb.Effects.standard().replace(**effects))
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        trb.Simulation(scene)
    found = [str(one.message) for one in said if issubclass(one.category, UnusualInput)]
    assert (words in found[0]) if words else not found


@pytest.mark.parametrize(
    ("path", "value"),
    [("cage.play_radial", 0.25), ("cage.play_axial", 0.4), ("land.clearance", 0.1)],
)
def test_a_clearance_in_millimetres_is_refused(path: str, value: float) -> None:
    with pytest.raises(
        trb.InputError, match=rf"{path} = {value:g} : must be below the diameter.* would be {1e-3 * value:g} m"
    ):
        RIG.replace({path: value})


def test_a_misalignment_in_milliradians_is_said() -> None:
    with pytest.warns(UnusualInput, match=r"misalignment_x = 0\.03 rad is 1\.72 degrees.*give 3e-05"):
        trb.Simulation(trb.cases.scene_30310(misalignment_x=0.03, axial_load=20e3))


def test_a_change_without_its_table_is_told_where_it_belongs(capsys: pytest.CaptureFixture[str], tmp_path: Any) -> None:
    from trbdyn.cli import main

    assert main(["run", "rig_30310", "--set", "speed_rpm=500", "-o", str(tmp_path / "a.h5")]) != 0
    assert "did you mean scene.speed_rpm?" in capsys.readouterr().err
