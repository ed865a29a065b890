"""Profiles from measured traces and drawn lines: known ones are found back, and others are refused with the reason."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trbdyn as trb
from trbdyn.model.profiles import drop_of

LENGTH = 19.8e-3
HALF = 0.5 * LENGTH


def with_profile(profile: trb.Profile) -> trb.Bearing:
    return trb.cases.rig_30310().replace({"roller.profile": profile})


def shape(profile: trb.Profile, x: np.ndarray) -> np.ndarray:
    """Height over a profile with chamfers beyond the effective length."""
    bearing = with_profile(profile)
    return -drop_of(bearing, bearing.roller.profile, x) - 0.3 * np.clip(np.abs(x) - HALF, 0.0, None)


def rough(profile: trb.Profile, *, noise: float = 50e-9, spikes: int = 30) -> tuple[np.ndarray, np.ndarray]:
    """A trace of 20.2 mm, tilted by 1.3 degrees, with noise, grinding marks and spikes."""
    random = np.random.default_rng(4)
    x = np.arange(-HALF - 0.2e-3, HALF + 0.2e-3, 5e-6)
    z = shape(profile, x) + np.tan(np.radians(1.3)) * x
    if noise:
        z += random.normal(0.0, noise, x.size) + 2.0 * noise * np.sin(2.0 * np.pi * x / 40e-6)
    hit = random.choice(x.size, spikes, replace=False)
    z[hit] += random.choice([-5e-6, 5e-6], spikes)
    return x, z


def written(path: Path, x: np.ndarray, z: np.ndarray, *, head: str = "X [mm];Z [µm]") -> Path:
    rows = [f"{1e3 * a:.6f};{1e6 * b:.5f}".replace(".", ",") for a, b in zip(x, z, strict=True)]
    path.write_text("\n".join(["Instrument 5", head, *rows, ""]), encoding="latin-1")
    return path


@pytest.mark.parametrize(
    "profile", [trb.Profile.iso(a_p=0.00035), trb.Profile.logarithmic(), trb.Profile.crowned(20.0)]
)
def test_a_profile_is_found_back_from_a_rough_tilted_trace_with_spikes(tmp_path: Path, profile: trb.Profile) -> None:
    x, z = rough(profile)
    trace = trb.read_trace(written(tmp_path / "t.csv", x + 12e-3, z), LENGTH)
    error = trace.drops + shape(profile, trace.stations)
    inner = np.abs(trace.stations) < HALF - 0.25e-3
    assert np.abs(error[inner]).max() < 70e-9
    edge = np.abs(trace.stations) < HALF - 0.05e-3  # within the cut-off of the ends steep drops are rounded
    assert np.all(np.abs(error[edge]) < 80e-9 + 0.03 * trace.drops[edge])
    assert trace.angle_deg == pytest.approx(1.3, abs=3e-4)
    assert 28 <= np.count_nonzero(trace.outlier) <= 45
    assert "outliers at" in str(trace)
    assert trace.roughness == pytest.approx(50e-9 * np.sqrt(3.0), rel=0.15)
    assert trace.left_out == pytest.approx(80, abs=4)


def test_half_of_an_amplitude_passes_at_the_cutoff(tmp_path: Path) -> None:
    x = np.arange(-HALF, HALF + 1e-9, 5e-6)
    wave = 1e-6 * np.cos(2.0 * np.pi * x / 0.4e-3)
    file = written(tmp_path / "t.csv", x, wave)
    for cutoff, passed in ((0.4e-3, 0.5), (0.8e-3, 0.0625), (0.2e-3, 0.5**0.25)):
        trace = trb.read_trace(file, LENGTH, cutoff=cutoff, hollow=True)
        # the residual has what did not pass; its Rq is that of a cosine
        assert trace.roughness == pytest.approx((1.0 - passed) * 1e-6 / np.sqrt(2.0), rel=0.03)


def test_direction_side_and_slope_are_obeyed(tmp_path: Path) -> None:
    x = np.arange(-HALF, HALF + 1e-9, 5e-6)
    z = -np.where(x > 0.0, 4e-6, 2e-6) * (x / HALF) ** 2
    plain = trb.read_trace(written(tmp_path / "a.csv", x, z), LENGTH, level="mean")
    assert plain.drops[[0, -1]] == pytest.approx([2e-6, 4e-6], abs=2e-8)
    turned = trb.read_trace(written(tmp_path / "b.csv", x[::-1], z[::-1]), LENGTH, level="mean")
    assert turned.drops == pytest.approx(plain.drops, abs=1e-10)
    first = trb.read_trace(tmp_path / "a.csv", LENGTH, level="mean", large_end="first")
    assert first.drops == pytest.approx(plain.drops[::-1], abs=1e-10)
    inward = trb.read_trace(written(tmp_path / "c.csv", x, -z), LENGTH, level="mean", material="above")
    assert inward.drops == pytest.approx(plain.drops, abs=1e-10)
    with pytest.raises(trb.FileError, match=r"higher than the middle.*material='above'.*hollow=True"):
        trb.read_trace(tmp_path / "c.csv", LENGTH, level="mean")
    assert trb.read_trace(tmp_path / "c.csv", LENGTH, level="mean", hollow=True).drops[40] == pytest.approx(
        4e-6, abs=3e-8
    )
    off = trb.read_trace(written(tmp_path / "d.csv", x + 5e-3, z), LENGTH, level="mean", centre=5e-3)
    assert off.drops == pytest.approx(plain.drops, abs=1e-9)


def test_heads_and_separators(tmp_path: Path) -> None:
    x, z = rough(trb.Profile.crowned(20.0), spikes=0)
    want = trb.read_trace(written(tmp_path / "a.csv", x, z), LENGTH).drops
    rows = np.stack([1e3 * x, 1e6 * z], axis=1)
    for separator, head, how in (
        (",", "position_mm,height_um", {}),
        ("\t", "X (mm)\tZ (um)", {}),
        (" ", "trace of roller 7", {"position_unit": "mm", "height_unit": "um"}),
    ):
        np.savetxt(tmp_path / "b.csv", rows, delimiter=separator, header=head, comments="", fmt="%.6f")
        assert trb.read_trace(tmp_path / "b.csv", LENGTH, **how).drops == pytest.approx(want, abs=1e-10)


def changed(name: str, x: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    if name == "passes":
        return np.r_[x, x[::-1]], np.r_[z, z[::-1]]
    if name == "twice":
        return np.r_[x[:5], x[4:]], np.r_[z[:5], z[4:]]
    if name == "few":
        return x[::100], z[::100]
    if name == "coarse":
        return x[::40], z[::40]
    if name == "gap":
        return np.delete(x, slice(1000, 1100)), np.delete(z, slice(1000, 1100))
    if name == "short":
        return x[200:], z[200:]
    if name == "nan":
        z = z.copy()
        z[3] = np.nan
    return x, z


@pytest.mark.parametrize(
    ("name", "how", "said"),
    [
        ("passes", {}, r"turn back, first at point 4041.*two passes"),
        ("twice", {}, r"is there twice"),
        ("few", {}, r"has 39 points.*at least 50"),
        ("coarse", {}, r"a point every 0\.2 mm"),
        ("gap", {}, r"a gap of 0\.505 mm"),
        ("short", {}, r"must be covered"),
        ("nan", {}, r"line 6: must be two finite numbers"),
        ("", {"position_unit": "um"}, r"must be covered.*position_unit"),
        ("", {"position_unit": "m"}, r"less than a third.*position_unit"),
        ("", {"height_unit": "mm"}, r"height_unit"),
        ("", {"height_unit": "nm", "level": "mean"}, r"flatter than any ground surface.*height_unit"),
    ],
)
def test_what_is_no_single_trace_in_its_units_is_refused(
    tmp_path: Path, name: str, how: dict[str, Any], said: str
) -> None:
    x, z = changed(name, *rough(trb.Profile.crowned(20.0), spikes=0))
    if how.get("height_unit") == "nm":
        z = shape(trb.Profile.crowned(20.0), x)
    head = "position;height" if how else "X [mm];Z [µm]"
    with pytest.raises(trb.FileError, match=said):
        trb.read_trace(
            written(tmp_path / "t.csv", x, z, head=head), LENGTH, **{"position_unit": "mm", "height_unit": "um", **how}
        )


def test_units_and_arguments_that_cannot_be_are_refused(tmp_path: Path) -> None:
    x, z = rough(trb.Profile.crowned(20.0), spikes=0)
    file = written(tmp_path / "t.csv", x, z, head="position;height")
    with pytest.raises(trb.InputError, match=r"position_unit.*must be given"):
        trb.read_trace(file, LENGTH)
    with pytest.raises(trb.InputError, match=r"must be the unit in the head"):
        trb.read_trace(written(tmp_path / "u.csv", x, z), LENGTH, height_unit="mm")
    for how, said in (
        ({"height_unit": "feet"}, "height_unit"),
        ({"cutoff": 1.0}, "cutoff"),
        ({"level": "none"}, "level"),
        ({"layer": "0"}, "layer"),
    ):
        with pytest.raises(trb.InputError, match=said):
            trb.read_trace(file, LENGTH, **{"position_unit": "mm", **how})
    (tmp_path / "e.csv").write_text("nothing here\n", encoding="utf-8")
    with pytest.raises(trb.FileError, match="no line of two numbers"):
        trb.read_trace(tmp_path / "e.csv", LENGTH)
    with pytest.raises(trb.FileError, match="no such file"):
        trb.read_trace(tmp_path / "none.csv", LENGTH)


def drawing(path: Path, draw: Any, units: int = 4) -> Path:
    ezdxf = pytest.importorskip("ezdxf")
    document = ezdxf.new(units=units)
    draw(document.modelspace())
    document.saveas(path)
    return path


def test_a_drawn_arc_is_the_crowned_profile_turned_and_in_other_units(tmp_path: Path) -> None:
    radius = 20.0

    def arc(scale: float, turn: float) -> Any:
        middle, half = 90.0 + turn, np.degrees(np.arcsin(10e-3 / radius))
        at = -scale * radius * np.array([np.cos(np.radians(middle)), np.sin(np.radians(middle))]) + 7.0
        return lambda space: space.add_arc(tuple(at), scale * radius, middle - half, middle + half)

    for units, scale, turn in ((4, 1e3, 0.0), (4, 1e3, 17.0), (1, 1.0 / 0.0254, -5.0), (6, 1.0, 0.0)):
        trace = trb.read_trace(drawing(tmp_path / "a.dxf", arc(scale, turn), units), LENGTH)
        assert trace.drops == pytest.approx(radius - np.sqrt(radius**2 - trace.stations**2), abs=2e-9)
        assert trace.angle_deg == pytest.approx(turn, abs=1e-6)
    with pytest.raises(trb.InputError, match=r"position_unit.*names no unit"):
        trb.read_trace(drawing(tmp_path / "a.dxf", arc(1e3, 0.0), 0), LENGTH)


def test_drawn_pieces_join_and_others_are_refused(tmp_path: Path) -> None:
    """A straight middle with sloped ends, heights drawn 1000 times larger, the pieces in any order and direction."""

    def pieces(space: Any) -> None:
        space.add_line((6.0, 0.0), (10.0, -8.0))
        space.add_lwpolyline([(-10.0, -8.0), (-6.0, 0.0)])
        space.add_line((6.0, 0.0), (-6.0, 0.0))

    trace = trb.read_trace(drawing(tmp_path / "a.dxf", pieces), LENGTH, magnification=1e3)
    want = np.interp(np.abs(trace.stations), [6e-3, 10e-3], [0.0, 8e-6])
    assert trace.drops == pytest.approx(want, abs=1e-10)

    def apart(space: Any) -> None:
        pieces(space)
        space.add_line((0.0, 5.0), (1.0, 5.0), dxfattribs={"layer": "dimensions"})

    with pytest.raises(trb.FileError, match=r"do not join.*layers: 0, dimensions"):
        trb.read_trace(drawing(tmp_path / "b.dxf", apart), LENGTH, magnification=1e3)
    layer = trb.read_trace(tmp_path / "b.dxf", LENGTH, magnification=1e3, layer="0")
    assert layer.drops == pytest.approx(trace.drops, abs=1e-12)
    with pytest.raises(trb.InputError, match=r"layer.*0, dimensions"):
        trb.read_trace(tmp_path / "b.dxf", LENGTH, layer="profile")
    (tmp_path / "c.dxf").write_text("no drawing", encoding="utf-8")
    with pytest.raises(trb.FileError, match="not a DXF file"):
        trb.read_trace(tmp_path / "c.dxf", LENGTH)


def test_pressure_and_torque_with_the_trace_are_those_of_the_formula(tmp_path: Path) -> None:
    profile = trb.Profile.logarithmic()
    file = written(tmp_path / "t.csv", *rough(profile))
    traced = trb.Profile.from_trace(file, LENGTH)

    def numbers(profile: trb.Profile) -> tuple[float, float]:
        sim = trb.Simulation(trb.cases.scene_30310(bearing=with_profile(profile)), accuracy="fast")
        pressure = float(sim.contacts()["raceway_pressure"].max())
        return pressure, sim.run(duration=2e-3, save_every=1e-4).inner_torque.mean()

    formula, measured, straight = (numbers(entry) for entry in (profile, traced, trb.Profile.crowned(5.0)))
    assert measured == pytest.approx(formula, rel=0.01)
    assert straight[0] > 1.05 * formula[0]


def test_a_case_takes_traces_for_rollers_and_raceways(tmp_path: Path) -> None:
    file = written(tmp_path / "t.csv", *rough(trb.Profile.crowned(20.0)))
    case = tmp_path / "case.toml"
    case.write_text(
        f"""[bearing]
case = "30310"
roller.profile = {{ trace = "{file}", cutoff = 0.4e-3 }}
cup_profile = {{ trace = "{file}", large_end = "first" }}
[scene]
speed_rpm = 3000
axial_load = 4930
""",
        encoding="utf-8",
    )
    bearing = trb.load_case(case)[0].bearing
    # the constants of laws that a trace does not use stay those of the case
    traced, own = trb.Profile.from_trace(file, LENGTH, cutoff=0.4e-3), bearing.roller.profile
    assert own.to_dict() == traced.to_dict() | {"a_p": own.a_p}
    cup, turned = bearing.cup_profile, trb.Profile.from_trace(file, LENGTH, large_end="first")
    assert cup is not None
    assert cup.to_dict() == turned.to_dict() | {"a_p": cup.a_p}
    assert trb.Simulation(trb.load_case(case)[0]).contacts()["raceway_pressure"].max() > 1e8
    case.write_text(case.read_text(encoding="utf-8").replace("large_end", "large_ends"), encoding="utf-8")
    with pytest.raises(trb.InputError, match=r"bearing\.cup_profile\.large_ends"):
        trb.load_case(case)


def test_the_picture_has_trace_outliers_and_profile(tmp_path: Path) -> None:
    trace = trb.read_trace(written(tmp_path / "t.csv", *rough(trb.Profile.crowned(20.0))), LENGTH)
    axes = trb.plot.profile_trace(trace)
    lines = {line.get_label().split(",")[0]: line for line in axes.get_lines()}
    assert lines["profile used"].get_ydata() == pytest.approx(-1e6 * trace.drops)
    count = int(np.count_nonzero(trace.outlier))
    assert len(lines[f"{count} outliers"].get_xdata()) == count
