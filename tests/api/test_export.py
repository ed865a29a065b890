"""Files for other programs hold the numbers of the result: read again by pandas, SciPy and h5py."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pandas
import pytest
from scipy.io import loadmat

import trbdyn as trb

AXIAL, RADIAL = 3000.0, 4000.0


@pytest.fixture(scope="module")
def result() -> trb.Result:
    scene = trb.Scene(trb.cases.rig_30310(), speed_rpm=2000, axial_load=AXIAL, radial_load=RADIAL)
    return trb.Simulation(scene, accuracy="fast").run(revolutions=0.05)


@pytest.fixture(scope="module")
def pair() -> trb.AssemblyResult:
    return trb.Simulation(trb.load_assembly("pair_30310"), accuracy="fast").run(revolutions=0.02)


def test_a_table(result: trb.Result, tmp_path: Path) -> None:
    table = pandas.read_csv(result.export(tmp_path / "run.csv"))
    assert next(iter(table)) == "time [s]"
    np.testing.assert_allclose(table["time [s]"], result.time, rtol=1e-14)
    np.testing.assert_allclose(table["outer_load[3] [N]"], result.outer_load[:, 3], rtol=1e-14)
    np.testing.assert_allclose(table["roller_position[2].y [m]"], result.roller_position[:, 2, 1], rtol=1e-14)
    assert len(table.columns) == sum(result[field.name][0].size for field in result.fields)


def test_matlab(result: trb.Result, pair: trb.AssemblyResult, tmp_path: Path) -> None:
    one = loadmat(result.export(tmp_path / "run.mat"), simplify_cells=True)["trbdyn"]
    for field in result.fields:
        assert np.array_equal(one[field.name], result[field.name]), field.name
        assert one["units"][field.name] == field.unit
    both = loadmat(pair.export(tmp_path / "pair.mat"), simplify_cells=True)
    for name, bearing in pair.items():
        assert np.array_equal(both[name]["inner_load"], bearing.inner_load)


def points_of(path: Path) -> tuple[np.ndarray, dict[str, np.ndarray], np.ndarray]:
    with h5py.File(path) as file:
        root = file["VTKHDF"]
        steps, count = root["Steps"].attrs["NSteps"], root["NumberOfPoints"][0]
        assert root.attrs["Type"] == b"PolyData"
        data = {name: values[:].reshape(steps, count, *values.shape[1:]) for name, values in root["PointData"].items()}
        return root["Points"][:].reshape(steps, count, 3), data, root["Steps/Values"][:]


def test_vtk_has_positions_and_forces_that_carry_the_load(result: trb.Result, tmp_path: Path) -> None:
    points, data, time = points_of(result.export(tmp_path / "run.vtkhdf"))
    rollers = result.n_rollers
    assert np.array_equal(time, result.time)
    assert points.shape == (len(result), rollers + 1, 3)
    plane = [0.0, 0.0, result.scene.bearing.geometry.centre_plane]
    assert points[:, :-1] == pytest.approx(result.roller_position - plane, abs=1e-8)
    assert points[:, -1] == pytest.approx(result.cage_position, abs=1e-9)
    assert data["outer_load"][:, :-1] == pytest.approx(result.outer_load, rel=1e-6)
    # the outer ring holds the load: axial force along z, radial force against +y
    carried = data["outer_force"].sum(axis=1).mean(axis=0)
    assert carried == pytest.approx([0.0, -RADIAL, AXIAL], abs=0.01 * RADIAL)


def test_vtk_of_a_pair_is_in_the_axes_of_the_shaft(pair: trb.AssemblyResult, tmp_path: Path) -> None:
    points, data, _ = points_of(pair.export(tmp_path / "pair.vtkhdf"))
    assert pair.assembly is not None
    for number, at in enumerate(pair.assembly.bearings):
        own = points[0][data["bearing"][0] == number]
        assert own[:, 2].mean() == pytest.approx(at.centre_plane, abs=2e-3)
    # with no load across, each ring pushes along the shaft against the other
    forces = [data["outer_force"][0][data["bearing"][0] == number].sum(axis=0)[2] for number in range(2)]
    assert forces[0] * forces[1] < 0.0


def test_endings_groups_and_files_that_are_there(result: trb.Result, tmp_path: Path) -> None:
    with pytest.raises(trb.InputError, match=r"\.csv"):
        result.export(tmp_path / "run.xlsx")
    path = result.export(tmp_path / "run.mat")
    with pytest.raises(trb.FileError, match="exists already"):
        result.export(path)
    with pytest.raises(trb.InputError, match="'contacts'"):
        result.select(["cage", "rollers"]).export(tmp_path / "run.vtkhdf")
