"""No file of 1 MB takes more than 200 MB of memory or 5 s, whatever is in it: each reader, against what strangers may send.

Each file is read in a process of its own, forked from this one, whose memory and time are limited by the system.
"""

from __future__ import annotations

import math
import os
import resource
import signal
import struct
import sys
import time
import traceback
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import trbdyn as trb
from trbdyn.errors import TrbError
from trbdyn.extras.elastic.modes import CageModes
from trbdyn.extras.study.definition import Base
from trbdyn.run.toml_case import read_tables

MEMORY, SECONDS = 200 << 20, 5.0
MB = 1_000_000
pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="limits of a process as Linux has them")


def taken_by(read: Callable[[], object]) -> tuple[str, int, float]:
    """How reading ended ('read', 'refused' or what went wrong), and the memory (bytes) and processor time (s) that it took."""
    out, back = os.pipe()
    before = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    child = os.fork()
    if child == 0:
        text = "ended"
        try:
            resource.setrlimit(resource.RLIMIT_AS, (before + 4 * MEMORY, -1))
            signal.alarm(int(4 * SECONDS))
            start, began = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
            try:
                read()
                text = "read"
            except TrbError as error:
                text = f"message of {len(str(error))} letters" if len(str(error)) > 10_000 else "refused"
            except BaseException as error:
                text = f"{type(error).__name__}: {error} {traceback.format_exc()[-300:]}"
            text = f"{resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - start} {time.process_time() - began} {text}"
        finally:
            os.write(back, text.encode()[:4000])
            os._exit(0)
    os.close(back)
    told = b"".join(iter(lambda: os.read(out, 4096), b"")).decode()
    os.close(out)
    _, status = os.waitpid(child, 0)
    if status:
        return f"killed, {status}", 0, 4 * SECONDS
    memory, took, how = told.split(" ", 2)
    return how, 1024 * int(memory), float(took)


def toml_files() -> dict[str, str]:
    row = "a" * 20
    return {
        "deep key": ".".join(["a"] * (MB // 2)) + " = 1",
        "deep key of 20000 parts": ".".join(["a"] * 20_000) + " = 1",
        "keys of 39 parts": "\n".join(f"k{n}." + ".".join(["a"] * 38) + " = 1" for n in range(MB // 90)),
        "digits as keys": "\n".join(f"{n}." + ".".join(["1"] * 30) + " = 1" for n in range(MB // 75)),
        "deep header": "[" + ".".join(["a"] * 40_000) + "]",
        "many headers": "\n".join(f"[a{n}.b.c]" for n in range(MB // 12)),
        "many unknown keys": "\n".join(f"{row}{n} = {n}" for n in range(MB // 34)),
        "unknown keys of a table": "[bearing]\ncase = '30310'\n[scene]\n"
        + "\n".join(f"k{n} = 1" for n in range(15_000)),
        "deep lists": "x = " + "[" * (MB // 2),
        "deep inline tables": "x = " + "{a=" * (MB // 4),
        "open text": 'x = """' + '\\"""' * (MB // 5),
        "many open texts": "x = '''" + "''" * (MB // 4),
        "one letter": "a" * MB,
        "long number": "x = " + "9" * (MB - 10),
        "many small lists": "x = [" + "[]," * (MB // 4) + "]",
        "name of 1 MB": f"[bearing]\ncase = '30310'\n{'k' * (MB - 100)} = 1",
    }


def dxf(entities: str) -> str:
    return (
        f"0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n"
    )


def line(x: float, z: float, x2: float, z2: float) -> str:
    return f"0\nLINE\n8\n0\n10\n{x}\n20\n{z}\n11\n{x2}\n21\n{z2}\n"


def arc(radius: float, end: float = 90.0) -> str:
    return f"0\nARC\n8\n0\n10\n0\n20\n0\n40\n{radius}\n50\n0\n51\n{end}\n"


def dxf_files() -> dict[str, str]:
    spline = "0\nSPLINE\n8\n0\n70\n8\n71\n{0}\n72\n{1}\n73\n{2}\n{3}{4}"
    count = 8000
    knots = "".join(f"40\n{k}\n" for k in range(count + 4))
    points = "".join(f"10\n{k}\n20\n{k % 7}\n" for k in range(count))
    return {
        "arc of 1e8 mm": dxf(arc(1e8)),
        "arc of nan": dxf(arc(math.nan)),
        "arc of inf": dxf(arc(math.inf)),
        "line to nan": dxf(line(0, 0, math.nan, 0)),
        "line to inf": dxf(line(0, 0, math.inf, 0)),
        "polyline without vertices": dxf("0\nPOLYLINE\n8\n0\n66\n1\n0\nSEQEND\n8\n0\n"),
        "light polyline without vertices": dxf("0\nLWPOLYLINE\n8\n0\n90\n0\n"),
        "arcs of 5 m": dxf(arc(5000.0) * (MB // 45)),
        "lines": dxf("".join(line(n, 0, n + 1, 0) for n in range(MB // 60))),
        "lines in no order": dxf("".join(line(n * 7919 % 9973, 0, n * 7919 % 9973 + 1, 0) for n in range(9000))),
        "spline of many points": dxf(spline.format(3, count + 4, count, knots, points)),
        "spline of high degree": dxf(spline.format(2000, count + 4, 5000, knots, points)),
        "noise": "\n".join(str(n % 1000) for n in range(MB // 4)),
    }


def csv_files() -> dict[str, str]:
    close = [f"{1e-9 * n:.12f},0" for n in range(5000)] + [f"{0.1 * n:.4f},{n % 3}" for n in range(1, 300)]
    even = 25 * (MB // 520)
    return {
        "points close together": "x_mm,z_um\n" + "\n".join(close),
        "many points": "x_mm,z_um\n" + "\n".join(f"{40.0 * n / even - 20.0:.5f},{n % 3}" for n in range(even)),
        "one column of many": ",".join("1" * (MB // 2)),
        "empty lines": "\n" * MB,
    }


def hdf5_bomb(path: Path, *, records: bool) -> None:
    """A result whose texts, or whose records, are packed 500 times and more."""
    with h5py.File(path, "r+") as file:
        name = "time" if records else "run/head"
        shape, kind = ((200_000_000,), "<f8") if records else ((60 << 20,), "u1")
        del file[name]
        made = file.create_dataset(name, shape, kind, chunks=(1 << 20,), compression="gzip", compression_opts=9)
        packed = zlib.compress(np.full(1 << 20, 0 if records else ord("["), kind).tobytes(), 9)
        for start in range(0, shape[0], 1 << 20):
            made.id.write_direct_chunk((start,), packed)
        if records:
            file["run/committed"][0] = shape[0]
    assert path.stat().st_size < 3 * MB


def step_files() -> dict[str, str]:
    name = "FILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('A'));"
    head = f"ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n{name}\nENDSEC;\nDATA;\n"
    end, count = "ENDSEC;\nEND-ISO-10303-21;\n", range(1, MB // 45)
    return {
        "deep brackets": head + "#1=A(" + "(" * (MB // 2) + ")" * (MB // 2 - 200) + f");\n{end}",
        "noise": head + "#1=B(1);\n" * (MB // 12),
        "points": head + "".join(f"#{n}=CARTESIAN_POINT('',(0.,0.,{n}.));\n" for n in count) + end,
        "faces in a circle": head + "".join(f"#{n}=ADVANCED_FACE('',(#{n + 1}),#{n + 2},.T.);\n" for n in count) + end,
    }


def rexs_files() -> dict[str, str]:
    """Units with many of each; 80 bytes each, and what the bearings need."""
    attribute = "<attribute id='{}' unit='{}'>{}</attribute>".format
    kind = "rolling_bearing_with_catalog_geometry"
    bearing = f"<component id='b{{}}' type='{kind}'>{attribute('catalogue_designation', '', '32208')}</component>"
    forces = "".join(attribute(one, "N", 100) for one in ("axial_force", "radial_force_in_v", "radial_force_in_w"))
    inside = f"<component id='b{{}}'>{forces}{attribute('speed_inner_ring', '1 / min', 9)}</component>"
    share = f"<component id='c0'>{attribute('load_duration_fraction', '%', 1)}</component>"
    oil = attribute("viscosity_at_40_degree_celsius", "mm^2 / s", 100) + attribute(
        "viscosity_at_100_degree_celsius", "mm^2 / s", 11
    )
    warm = f"<component id='o' type='lubricant'>{oil}{attribute('temperature_lubricant', 'C', 70)}</component>"
    casing = "<component id='c{}' type='gear_casing'/>"

    def unit(bearings: int, casings: int, cases: int, relations: int = 0) -> str:
        parts = "".join(map(bearing.format, range(bearings))) + "".join(map(casing.format, range(casings))) + warm
        joined = "<relation><ref id='b0'/><ref id='s'/></relation>" * relations
        loads = "".join(map(inside.format, range(bearings)))
        listed = "".join(f"<load_case id='{n}'>{loads}{share}</load_case>" for n in range(cases))
        return f"<model><relations>{joined}</relations><components>{parts}</components>{listed}</model>"

    return {
        "entities": "<!DOCTYPE a [<!ENTITY a 'aaaaaaaaaa'><!ENTITY b '&a;&a;&a;&a;&a;'>]><model>&b;</model>",
        "deep elements": "<a>" * (MB // 3),
        "many elements": f"<model>{'<a/>' * (MB // 5)}</model>",
        "many attributes": "<model " + " ".join(f"a{n}='1'" for n in range(MB // 12)) + "/>",
        "a unit that is read": unit(1, 1, 3),
        "many bearings": unit(1900, 1, 1),
        "as many bearings as are read": unit(50, 1, 10),
        "many casings and cases": unit(1, 10_000, 900),
        "many cases": unit(1, 1, 1900),
        "as many cases as are read": unit(1, 19, 500),
        "many relations": unit(1, 1, 1, 20_000),
    }


def stl_files() -> dict[str, bytes]:
    count = (MB - 84) // 50
    random = np.random.default_rng(0)
    rows = np.zeros(count, dtype=np.dtype([("v", "<f4", (4, 3)), ("a", "<u2")]))
    rows["v"] = random.normal(size=(count, 4, 3))
    head = b" " * 80 + struct.pack("<I", count)
    flat = np.zeros_like(rows)
    huge = rows.copy()
    huge["v"] *= 1e30
    return {
        "noise": head + rows.tobytes(),
        "all at one place": head + flat.tobytes(),
        "as large as a planet": head + huge.tobytes(),
        "vertices as text": b"solid\n" + b"vertex 0 0 1 " * (MB // 13),
        "vertices that end": b"solid\n" + b"vertex " * (MB // 7),
    }


def box_of_step(path: Path, size: float) -> None:
    gmsh = pytest.importorskip("gmsh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addBox(0, 0, 0, size, size, size)
        gmsh.model.occ.synchronize()
        gmsh.write(str(path))
    finally:
        gmsh.finalize()


def readers(folder: Path, small_result: bytes) -> dict[str, tuple[Path, Callable[[Path], object]]]:
    """Every file with its reader."""
    bearing = trb.cases.rig_30310()
    found: dict[str, tuple[Path, Callable[[Path], object]]] = {}

    def add(kind: str, name: str, ending: str, content: str | bytes, read: Callable[[Path], object]) -> None:
        path = folder / f"{len(found)}{ending}"
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        assert path.stat().st_size <= 1.1 * MB, name
        found[f"{kind}: {name}"] = (path, read)

    for name, text in toml_files().items():
        add("TOML", name, ".toml", text, trb.load_case)
    for name, text in dxf_files().items():
        add("DXF", name, ".dxf", text, lambda path: trb.read_trace(path, 20e-3, position_unit="mm"))
    for name, text in csv_files().items():
        add("CSV trace", name, ".csv", text, lambda path: trb.read_trace(path, 20e-3))
        add("CSV profile", name, ".csv", text, trb.Profile.from_csv)
        add("CSV table", name, ".csv", text, trb.designations)
        add("CSV spectrum", name, ".csv", text, lambda path: trb.spectrum("rig_30310", path))
    cases = "share;speed_rpm\n" + "\n".join(f"1;{n % 5000 + 100}" for n in range(MB // 8))
    add("CSV spectrum", "many cases", ".csv", cases, lambda path: trb.spectrum("rig_30310", path))
    rows = "\n".join(f"{20e-3 * n / 60_000 - 10e-3:.7f},{n % 5}" for n in range(60_000))
    add("CSV profile", "many rows", ".csv", f"station_m,drop_um\n{rows}", trb.Profile.from_csv)
    for name, text in step_files().items():
        add("STEP", name, ".step", text, lambda path: trb.Bearing.replace(bearing, cage=cage_of(path, bearing)))
    for name, text in rexs_files().items():
        add("REXS", name, ".rexs", text, trb.read_rexs)
    for name, data in stl_files().items():
        add("STL", name, ".stl", data, lambda path: cage_of(path, bearing))
    for size in (1e3, 1e6, 1e9):
        path = folder / f"box{size:g}.step"
        box_of_step(path, size)
        found[f"STEP: box of {size:g} mm"] = (path, lambda path: cage_of(path, bearing))
    for records in (True, False):
        path = folder / f"bomb{records}.h5"
        path.write_bytes(small_result)
        hdf5_bomb(path, records=records)
        found[f"HDF5: records {records}"] = (path, lambda path: trb.load(path).time)
    with h5py.File(folder / "modes.h5", "w") as file:
        CageModes_bomb(file)
    found["HDF5: modes"] = (folder / "modes.h5", CageModes.load)
    return found


def CageModes_bomb(file: h5py.File) -> None:
    from trbdyn.extras.elastic.modes import FORMAT, UNITS, VERSION

    file.attrs.update({"format": FORMAT, "version": VERSION, "source": ""})
    for name in UNITS:
        file.create_dataset(name, (100_000_000,), "<f8", chunks=(1 << 20,), compression="gzip")


def cage_of(path: Path, bearing: trb.Bearing) -> object:
    return type(bearing.cage).from_step(path, bearing)


@pytest.fixture(scope="module")
def small_result(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    path = tmp_path_factory.mktemp("small") / "run.h5"
    trb.Simulation(trb.cases.scene_30310(3000.0, 4930.0)).run(duration=1e-4, output=path)
    return path.read_bytes()


FIRST = ("deep key of 20000 parts", "many unknown keys", "arc of 1e8 mm", "arc of nan", "polyline", "line to inf",
         "close together", "deep brackets", "box of 1e+06 mm", "all at one place", "records True", "many cases", "many casings",
         "a unit that is read")  # fmt: skip
"""Those that are read in every run of the tests."""


@pytest.mark.parametrize("every", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_no_file_of_1_mb_takes_200_mb_or_5_s(tmp_path: Path, small_result: bytes, every: bool) -> None:
    listed = readers(tmp_path, small_result)
    Base.of("rig_30310")
    trb.Bearing.named("32208")  # what readers import is there before memory is measured
    for ending in (".dxf", ".step"):
        with pytest.raises((TrbError, ImportError)):
            cage_of(tmp_path / f"none{ending}", trb.cases.rig_30310())
    pytest.importorskip("ezdxf.path")
    wrong = {}
    for name, (path, read) in listed.items():
        if not every and not any(word in name for word in FIRST):
            continue
        how, memory, took = taken_by(lambda path=path, read=read: read(path))
        if os.environ.get("TRB_SHOW_LIMITS"):
            print(f"{name:45s} {how:10.10s} {memory / 1e6:7.0f} MB {took:6.2f} s")
        if how not in ("refused", "read") or memory > MEMORY or took > SECONDS:
            wrong[name] = (how, f"{memory / 1e6:.0f} MB", f"{took:.1f} s")
    assert not wrong


@pytest.mark.parametrize("kind", ["pipe", "device", "folder", "name of 300 letters", "path of 5000 letters"])
def test_what_is_no_regular_file_is_refused_at_once(tmp_path: Path, kind: str) -> None:
    bearing = trb.cases.rig_30310()
    made: dict[str, Callable[[Path], Any]] = {
        ".toml": trb.load_case,
        ".dxf": lambda path: trb.read_trace(path, 20e-3),
        ".csv": lambda path: trb.read_trace(path, 20e-3),
        ".step": lambda path: cage_of(path, bearing),
        ".stl": lambda path: cage_of(path, bearing),
        ".h5": trb.load,
        ".modes": CageModes.load,
        ".profile": trb.Profile.from_csv,
        ".table": trb.designations,
        ".rexs": trb.read_rexs,
        ".spectrum": lambda path: trb.spectrum("rig_30310", path),
        ".assembly": trb.load_assembly,
        ".tables": read_tables,
    }
    for ending, read in made.items():
        path = tmp_path / f"file{ending}"
        if kind == "pipe":
            os.mkfifo(path)
        elif kind == "device":
            path.symlink_to("/dev/zero")
        elif kind == "folder":
            path.mkdir()
        elif kind.startswith("name"):
            path = tmp_path / f"{'a' * 300}{ending}"
        else:
            path = Path(f"{'a/' * 2500}{ending}")
        with pytest.raises(trb.FileError, match=r"regular file|folder|too long|no such file"):
            read(path)


def test_no_name_of_a_file_to_write_is_too_long_for_its_error(tmp_path: Path) -> None:
    import matplotlib.pyplot as plt

    result = trb.Simulation(trb.cases.scene_30310(3000.0, 4930.0)).run(duration=1e-4)
    name = tmp_path / ("a" * 300)
    for write in (
        lambda: trb.report(result, f"{name}.html"),
        lambda: trb.view(result, f"{name}.html"),
        lambda: trb.plot.save(plt.figure(), f"{name}.png"),
        lambda: result.export(f"{name}.csv"),
        lambda: trb.Simulation(trb.cases.scene_30310(3000.0, 4930.0)).run(duration=1e-4, output=f"{name}.h5"),
    ):
        with pytest.raises(trb.FileError, match="too long"):
            write()
    plt.close("all")


def test_names_of_a_stranger_are_told_in_short() -> None:
    with pytest.raises(trb.InputError) as caught:
        trb.Scene(trb.cases.rig_30310(), speed_rpm=1.0, axial_load=1.0, **{f"{'k' * 5000}{n}": 1 for n in range(100)})
    assert len(str(caught.value)) < 20_000
