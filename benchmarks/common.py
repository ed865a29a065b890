"""What the benchmark scripts share: command line, machine and versions, JSON, tables, pictures, medians of timings.

A script is run as ``python benchmarks/<name>.py [--quick] [--json FILE]`` and writes ``benchmarks/pictures/<name>.png``.
Import this module before NumPy: numbers are for one core, so that the threads of BLAS are set to one.

Schema of every JSON file (``schema`` names it)::

    schema    "trbdyn-benchmark-1"
    benchmark name of the script
    quick     whether it ran with --quick
    command   arguments
    date      ISO 8601, UTC
    machine   what machine() gives: processor, cores, load, system, versions of everything that matters
    wall_s    how long the script ran
    inputs    {name: value}: what was run
    columns   {name: "unit: text"}: the entries of a row of results, and of summary
    results   list of rows {name: value}; a value that could not be measured is null
    summary   {name: value}: what the issue of the benchmark asks for
    notes     list of sentences
"""

from __future__ import annotations

import argparse
import datetime
import hashlib
import json
import math
import os
import platform
import subprocess
import sys
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

os.environ.update(dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1"))

import numpy as np

SCHEMA = "trbdyn-benchmark-1"
HERE = Path(__file__).resolve().parent
PICTURES = HERE / "pictures"


class _Smoke(argparse.Action):
    """The shortest form is a quick one, too: what a script does not shorten further is as it is with --quick."""

    def __call__(self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, *_: object) -> None:
        namespace.smoke = namespace.quick = True


def parser(description: str | None) -> argparse.ArgumentParser:
    """The command line that all benchmarks have; a script may add to it."""
    out = argparse.ArgumentParser(
        description=(description or "").split("\n")[0], formatter_class=argparse.ArgumentDefaultsHelpFormatter
    )
    out.add_argument("--quick", action="store_true", help="fewer cases and repeats, under two minutes")
    out.add_argument("--smoke", action=_Smoke, nargs=0, default=False, help="the least that goes through every part")
    out.add_argument("--json", type=Path, metavar="FILE", default=None, help="write results to a JSON file")
    out.add_argument("--no-picture", action="store_true", help="draw no picture")
    out.add_argument("--write-readme", action="store_true", help="put the results into benchmarks/README.md")
    return out


def processor() -> dict[str, Any]:
    """Name, clock and vector instructions of the processor, as far as the system tells."""
    out: dict[str, Any] = {"name": platform.processor() or platform.machine(), "mhz": None, "vector": []}
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return out
    found: dict[str, str] = {}
    for line in lines:
        key, _, value = line.partition(":")
        found.setdefault(key.strip(), value.strip())
    out["name"] = found.get("model name", out["name"])
    if "cpu MHz" in found:
        out["mhz"] = float(found["cpu MHz"])
    wanted = {"sse2", "avx", "avx2", "fma", "avx512f", "avx512dq", "avx512vl"}
    out["vector"] = sorted(wanted & set(found.get("flags", "").split()))
    return out


def revision() -> str | None:
    """Revision of the sources, with "+" if they were changed since."""
    try:
        head = _git("rev-parse", "--short", "HEAD")
        return head + ("+" if _git("status", "--porcelain", "--untracked-files=no") else "")
    except (OSError, subprocess.SubprocessError):
        return None


def defaults_mark() -> str:
    """Eight digits that change with the defaults which figures depend on: effects, tolerances, integrator. What is off is left
    out, so that a new effect that is off changes nothing.
    """
    import trbdyn as trb
    from trbdyn.run.options import ACCURACY, IMPACT_SHARE, RINGS_SHARE, RunOptions

    parts = {
        "standard": trb.Effects().to_dict(),
        "paper": trb.Effects.paper().to_dict(),
        "accuracy": {name: preset.to_dict() for name, preset in ACCURACY.items()},
        "shares": [RINGS_SHARE, IMPACT_SHARE],
        "run": RunOptions(revolutions=1.0).to_dict(),
        "integrator": trb.Simulation(trb.cases.scene_30310(3000.0, 4930.0)).options.integrator,
    }
    return hashlib.sha256(json.dumps(_what_is_on(parts), sort_keys=True).encode()).hexdigest()[:8]


def _what_is_on(value: Any) -> Any:
    if not isinstance(value, Mapping):
        return value
    return {name: _what_is_on(item) for name, item in value.items() if item not in (None, False, 0.0, "off", {}, [])}


def _git(*arguments: str) -> str:
    done = subprocess.run(["git", "-C", str(HERE), *arguments], capture_output=True, text=True, check=True, timeout=20)
    return done.stdout.strip()


def machine() -> dict[str, Any]:
    """Machine, system and versions that the timings belong to."""
    import scipy

    import trbdyn
    from trbdyn import _core

    load = os.getloadavg() if hasattr(os, "getloadavg") else (math.nan,) * 3
    return {
        "processor": processor(),
        "cores": os.cpu_count(),
        "load": [round(value, 2) for value in load],
        "system": f"{platform.system()} {platform.release()}",
        "python": platform.python_version(),
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "trbdyn": trbdyn.__version__,
        "revision": revision(),
        "defaults": defaults_mark(),
        "sundials": _core.sundials_version(),
        "instruction_sets": _core.instruction_sets(),
    }


@dataclass
class Report:
    """Collects what a benchmark found; prints and writes it.

    Attributes
    ----------
    name : str
        Name of the script.
    options : Namespace
        What `parser` gave.
    columns : dict of str to str
        "unit: text" of every entry of results and summary.
    readme : str
        Results for benchmarks/README.md, Markdown; empty for a script that has no place there.
    measured : dict
        Where results that were taken from a file come from: entries that take the place of this run's.
    """

    name: str
    options: argparse.Namespace
    columns: dict[str, str]
    inputs: dict[str, Any] = field(default_factory=dict)
    results: list[dict[str, Any]] = field(default_factory=list)
    summary: dict[str, Any] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    readme: str = ""
    measured: dict[str, Any] = field(default_factory=dict)
    began: float = field(default_factory=time.perf_counter)

    def add(self, **row: Any) -> dict[str, Any]:
        """Another row of results; names that `columns` does not hold are an error."""
        _known(row, self.columns)
        self.results.append(row)
        return row

    def take(self, path: Path) -> None:
        """Take what another run of the script wrote to a JSON file: results, and when and where they were measured.

        Raises
        ------
        ValueError
            If the file is not of this script.
        """
        found = json.loads(path.read_text(encoding="utf-8"))
        if found.get("schema") != SCHEMA or found.get("benchmark") != self.name:
            raise ValueError(f"{path} is not a file of {self.name}")
        self.results, self.summary = found["results"], found["summary"]
        self.inputs, self.notes = found["inputs"], found["notes"]
        self.measured = {name: found[name] for name in ("quick", "command", "date", "machine", "wall_s")}

    def to_dict(self) -> dict[str, Any]:
        """Everything, as it is written."""
        _known(self.summary, self.columns)
        out: dict[str, Any] = plain(
            {
                "schema": SCHEMA,
                "benchmark": self.name,
                "quick": self.options.quick,
                "command": sys.argv[1:],
                "date": datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds"),
                "machine": machine(),
                "wall_s": time.perf_counter() - self.began,
                "inputs": self.inputs,
                "columns": self.columns,
                "results": self.results,
                "summary": self.summary,
                "notes": self.notes,
            }
            | self.measured
        )
        return out

    def finish(self) -> dict[str, Any]:
        """Write the JSON file and the part of the README that were asked for; say where everything is."""
        out = self.to_dict()
        if getattr(self.options, "write_readme", False) and self.readme:
            write_readme(self.name, f"{_stamp(out)}\n\n{self.readme}")
        if self.options.json is not None:
            self.options.json.parent.mkdir(parents=True, exist_ok=True)
            self.options.json.write_text(json.dumps(out, indent=1, allow_nan=False) + "\n", encoding="utf-8")
            print(f"wrote {self.options.json}")
        print(f"{self.name}: {out['wall_s']:.0f} s")
        return out


def _known(row: Mapping[str, Any], columns: Mapping[str, str]) -> None:
    unknown = sorted(set(row) - set(columns))
    if unknown:
        raise KeyError(f"not described in columns: {', '.join(unknown)}")


def plain(value: Any) -> Any:
    """For JSON: NumPy's numbers and arrays as Python's; what is not finite as None."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, (list, tuple, set)):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Path):
        return value.name
    return value


def table(rows: Sequence[Mapping[str, Any]], columns: Iterable[str], digits: int = 3) -> str:
    """Rows as a Markdown table that also reads well in a terminal."""
    names = list(columns)
    cells = [names, *([_cell(row.get(name), digits) for name in names] for row in rows)]
    widths = [max(3, *(len(line[i]) for line in cells)) for i in range(len(names))]
    numeric = [all(isinstance(row.get(name), (int, float, np.number, type(None))) for row in rows) for name in names]

    def line(parts: Sequence[str]) -> str:
        placed = [
            part.rjust(width) if right else part.ljust(width)
            for part, width, right in zip(parts, widths, numeric, strict=True)
        ]
        return f"| {' | '.join(placed)} |"

    rule = [("-" * (width - 1) + ":") if right else "-" * width for width, right in zip(widths, numeric, strict=True)]
    return "\n".join([line(cells[0]), f"| {' | '.join(rule)} |", *(line(row) for row in cells[1:])])


def _cell(value: Any, digits: int) -> str:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "-"
    if isinstance(value, (bool, str)):
        return str(value)
    if isinstance(value, (int, np.integer)):
        return f"{value:d}"
    if isinstance(value, (float, np.floating)):
        text = f"{value:.{digits}g}"
        return f"{float(text):.0f}" if "e+" in text and abs(value) < 1e6 else text
    return str(value)


def _stamp(found: Mapping[str, Any]) -> str:
    """When and where results were measured, in a sentence."""
    where = found["machine"]
    cores = f"{where['processor']['name']}, {where['cores']} cores, load {where['load'][0]:g}"
    quick = ", with --quick" if found["quick"] else ""
    made = f", defaults {where['defaults']}" if "defaults" in where else ""
    core = f"trbdyn {where['trbdyn']}, revision {where['revision'] or 'unknown'}{made}{quick}"
    return f"Measured {found['date'][:10]}, {core}; {cores}."


def write_readme(name: str, text: str, path: Path = HERE / "README.md") -> None:
    """Put a text between the comments ``<!-- name -->`` and ``<!-- /name -->`` of a page.

    Raises
    ------
    ValueError
        If the page has not exactly one such place.
    """
    page = path.read_text(encoding="utf-8")
    begin, end = f"<!-- {name} -->", f"<!-- /{name} -->"
    if page.count(begin) != 1 or page.count(end) != 1 or page.index(begin) > page.index(end):
        raise ValueError(f"{path.name} must have one {begin} and, after it, one {end}")
    head, rest = page.split(begin)
    path.write_text(f"{head}{begin}\n{text.strip()}\n{end}{rest.split(end)[1]}", encoding="utf-8")
    print(f"wrote {path.name}")


def save_picture(figure: Any, name: str) -> Path:
    """Write ``pictures/<name>.png``."""
    PICTURES.mkdir(exist_ok=True)
    path = PICTURES / f"{name}.png"
    figure.savefig(path, dpi=120)
    print(f"wrote {path.relative_to(HERE.parent)}")
    return path


def pyplot() -> Any:
    """Matplotlib without a window."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    return plt
