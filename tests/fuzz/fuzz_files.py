"""Fuzz target of files: results, checkpoints and case files with damage of every kind go through whatever reads them.

Each file is tried in a process of its own with bounds of memory and time. It is read, or one of the package's errors is raised:
anything else, a crash, a bound that is reached, is a failure, and the file is kept.

    .venv/bin/python tests/fuzz/fuzz_files.py --minutes 10 --seed 1
"""

from __future__ import annotations

import argparse
import json
import os
import random
import resource
import signal
import sys
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np

import trbdyn as trb
from trbdyn.base.shipped import CASES
from trbdyn.errors import TrbError
from trbdyn.model.cases import scene_30310
from trbdyn.run import checkpoint

MEMORY = 2 << 30
"""Memory that a file may take beyond what the process has (byte)."""
SECONDS = 60.0
"""Processor time that a file may take (s)."""
ODD = (
    None, True, 0, -1, 1, 2**31, 2**63, -(2**70), 1e308, -1e308, 1e-320, float("nan"), float("inf"), "", "a", "\0", "\ud800",
    "../x", "/dev/zero", "$x^{$", "<!--<script>", "9" * 5000, [], {}, [[]], [None] * 50, {"": {}}, [1.0] * 5,
)  # fmt: skip
"""What takes the place of a value in a text."""
TOKENS = (
    "=",
    "[",
    "]",
    "[[",
    '"',
    "{",
    ",",
    "nan",
    "-inf",
    "1e400",
    "0x",
    "\n[run]\n",
    "#",
    "\0",
    "é",
    "9" * 400,
    "true",
)
"""What is put into a case file."""


# ---- what reads a file ----


def read_result(path: Path) -> None:
    """Every field, the summary, what is shown, the report and the view."""
    result = trb.load(path)
    for one in getattr(result, "values", lambda: [result])():
        for field in one.fields:
            one[field.name]
        str(one), one._repr_html_()
    result.summary()
    trb.report(result, path.with_name("report.html"), pictures=[], overwrite=True)
    trb.view(result, path.with_name("view.html"), overwrite=True)


def read_checkpoint(path: Path) -> None:
    """What it holds, and a run that goes on from it for some steps."""
    checkpoint.read(path)
    trb.resume(path.with_suffix(""), callback=lambda sim: True)


def read_case(path: Path) -> None:
    """The scene, its text, and its case file again."""
    scene, run = trb.load_case(path)
    str(scene), scene._repr_html_(), str(run)
    assert type(scene).from_dict(scene.to_dict()) == scene


READERS: dict[str, Callable[[Path], None]] = {".h5": read_result, ".checkpoint": read_checkpoint, ".toml": read_case}


# ---- damage ----


def bytes_changed(data: bytes, draw: random.Random) -> bytes:
    """Bits, bytes, zeros, parts that are doubled or left out; often at the ends, where most of the structure is."""
    changed = bytearray(data)
    for _ in range(draw.choice((1, 1, 2, 8))):
        size = len(changed)
        at = min(draw.choice((draw.randrange(size), draw.randrange(min(size, 4096)))), size - 1)
        length = draw.choice((1, 8, 100, 4096))
        kind = draw.choice(("bit", "byte", "zeros", "end", "double", "without"))
        if kind == "bit":
            changed[at] ^= 1 << draw.randrange(8)
        elif kind == "byte":
            changed[at] = draw.randrange(256)
        elif kind == "zeros":
            changed[at : at + length] = bytes(len(changed[at : at + length]))
        elif kind == "end":
            del changed[max(at, 1) :]
        elif kind == "double":
            changed[at:at] = changed[at : at + length]
        elif size > length + 1:
            del changed[at : at + length]
    return bytes(changed)


def value_changed(table: Any, draw: random.Random) -> Any:
    """A copy of what JSON holds, in which one value is another one, or gone."""
    if isinstance(table, dict) and table and draw.random() < 0.93:
        key = draw.choice(list(table))
        if draw.random() < 0.05:
            return {name: value for name, value in table.items() if name != key}
        return table | {key: value_changed(table[key], draw)}
    if isinstance(table, list) and table and draw.random() < 0.9:
        place = draw.randrange(len(table))
        return [*table[:place], value_changed(table[place], draw), *table[place + 1 :]]
    if isinstance(table, float | int) and not isinstance(table, bool) and draw.random() < 0.5:
        return table * draw.choice((-1, 0, 0.5, 2, 1e3, 1e-9, 1e30))
    return draw.choice(ODD)


def text_of(table: Any) -> bytes:
    return json.dumps(table).encode("utf-8", "surrogatepass")


def content_changed(path: Path, draw: random.Random) -> None:
    """Damage of a result that checksums do not find: its own libraries write it."""
    with h5py.File(path, "r+") as file:
        groups = [file, *(entry for name, entry in file.items() if isinstance(entry, h5py.Group) and name != "run")]
        group = draw.choice([one for one in groups if "run" in one])
        run, kind = group["run"], draw.choice(("head", "head", "head", "ending", "committed", "field", "field", "none"))
        if kind == "head":
            replaced(run, "head", np.array([text_of(value_changed(json.loads(run["head"][0]), draw))]))
        elif kind == "ending":
            size = int(run["committed"][1])
            text = text_of(value_changed(json.loads(run["ending"][:size].tobytes()), draw))
            replaced(run, "ending", np.frombuffer(text, dtype="u1"))
            run["committed"][1] = len(text)
        elif kind == "committed":
            run["committed"][draw.randrange(3)] = draw.choice((-1, 0, 1, 5, 2**40, 2**62))
        else:
            name = draw.choice([key for key in group if isinstance(group[key], h5py.Dataset)])
            values = group[name][()]
            if kind == "none":
                del group[name]
            elif values.dtype.kind == "f":
                odd = draw.choice((np.nan, np.inf, -np.inf, 1e300, -1.0, 0.0, 1e-300))
                with np.errstate(all="ignore"):
                    if draw.random() < 0.5 and values.size:
                        values.flat[draw.randrange(values.size)] = odd
                    else:
                        values[...] = odd
                group[name][...] = values
            else:
                replaced(group, name, draw.choice((values[:1], values.astype("S8"), np.zeros((3, 3)))))


def replaced(group: h5py.Group, name: str, values: Any) -> None:
    del group[name]
    group.create_dataset(
        name, data=values, chunks=values.shape if values.size else None, maxshape=(None,) * values.ndim
    )


def checkpoint_changed(data: bytes, draw: random.Random) -> bytes:
    """A checkpoint whose checksum is right and whose content is not."""
    import hashlib

    first, digest, rest = data.split(b"\n", 2)
    table, numbers = rest.split(b"\n", 1)
    if draw.random() < 0.7:
        table = text_of(value_changed(json.loads(table), draw))
    else:
        values = np.frombuffer(numbers, dtype="<f8").copy()
        values[draw.randrange(values.size)] = draw.choice((np.nan, np.inf, 1e300, -1.0, 0.0))
        numbers = values.tobytes()[: draw.choice((None, None, 8, 12))]
    rest = table + b"\n" + numbers
    found = hashlib.sha256(rest).hexdigest().encode()
    return first + b"\n" + digest[: len(digest) - 64] + found + b"\n" + rest


def lines_changed(data: bytes, draw: random.Random) -> bytes:
    """A case file with a line twice, gone or elsewhere, or with something put into it."""
    lines = data.decode().split("\n")
    for _ in range(draw.choice((1, 1, 3))):
        at, kind = draw.randrange(len(lines)), draw.choice(("double", "gone", "move", "put", "value", "value"))
        if kind == "double":
            lines.insert(at, lines[at])
        elif kind == "gone" and len(lines) > 1:
            del lines[at]
        elif kind == "move":
            lines.insert(draw.randrange(len(lines)), lines.pop(at))
        elif kind == "value" and "=" in lines[at]:
            lines[at] = (
                lines[at].lstrip("# ").split("=")[0]
                + "= "
                + draw.choice(
                    (
                        *TOKENS,
                        "1",
                        "-1",
                        "0",
                        "1e300",
                        "nan",
                        '""',
                        "[]",
                        "{}",
                        "[1, 2]",
                        '"standard"',
                        "2026-01-01",
                        "1e-300",
                    )
                )
            )
        else:
            place = draw.randrange(len(lines[at]) + 1)
            lines[at] = lines[at][:place] + draw.choice(TOKENS) + lines[at][place:]
    return "\n".join(lines).encode()


def damage(path: Path, draw: random.Random) -> None:
    """Change a file in one of the ways that suit its kind."""
    if draw.random() < 0.3:
        path.write_bytes(bytes_changed(path.read_bytes(), draw))
    elif path.suffix == ".h5":
        content_changed(path, draw)
    else:
        change = checkpoint_changed if path.suffix == ".checkpoint" else lines_changed
        path.write_bytes(change(path.read_bytes(), draw))


# ---- trials ----


def seeds(folder: Path) -> list[tuple[Path, ...]]:
    """Sound files: the one that is damaged, and what must lie beside it."""
    scene, pair = scene_30310(), trb.load_assembly("pair_30310")
    made: list[tuple[Path, ...]] = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        trb.Simulation(scene, accuracy="fast").run(duration=2e-3, save_every=5e-5, output=folder / "run.h5")
        trb.Simulation(pair, accuracy="fast").run(duration=5e-4, save_every=5e-5, output=folder / "pair.h5")
        trb.Simulation(scene, accuracy="fast").run(
            duration=4e-3,
            save_every=5e-5,
            checkpoint_every=5e-4,
            output=folder / "cut.h5",
            callback=lambda sim: sim.time > 1e-3,
        )
    made += [(folder / "run.h5",), (folder / "pair.h5",), (folder / "cut.h5.checkpoint", folder / "cut.h5")]
    for name in ("rig_30310", "bearing_32216", "bearing_nj210"):
        path = folder / f"{name}.toml"
        path.write_bytes(CASES.find(name).read_bytes())
        made.append((path,))
    return made


def tried(path: Path, said: Path) -> str:
    """Read a file in a child; what went wrong, or nothing."""
    child = os.fork()
    if child == 0:
        code = 1
        try:
            with said.open("w", encoding="utf-8", errors="replace") as out:
                try:
                    bounded()
                    with warnings.catch_warnings():
                        warnings.simplefilter("ignore")
                        READERS[path.suffix](path)
                    code = 0
                except TrbError as error:
                    str(error).encode("utf-8", "backslashreplace")
                    code = 0
                except BaseException:
                    traceback.print_exc(file=out)
        finally:
            os._exit(code)
    _, status = os.waitpid(child, 0)
    if status == 0:
        return ""
    if os.WIFSIGNALED(status):
        number = os.WTERMSIG(status)
        return (
            f"took more than {SECONDS:g} s"
            if number in (signal.SIGPROF, signal.SIGXCPU)
            else f"ended by signal {number}"
        )
    return said.read_text(encoding="utf-8") or f"ended with code {os.WEXITSTATUS(status)}"


def bounded() -> None:
    """Bounds of memory and processor time of this process, from now on."""
    taken = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (taken + MEMORY, taken + MEMORY))
    signal.signal(signal.SIGPROF, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_PROF, SECONDS)


def place_of(failure: str) -> str:
    """By what failures are told apart: the last line of ours in a traceback, and the error."""
    lines = [line.strip() for line in failure.strip().splitlines()]
    ours = [line for line in lines if line.startswith("File") and "/trbdyn/" in line]
    return f"{ours[-1] if ours else ''} {lines[-1].split(':')[0] if lines else ''}"


def fuzz(*, seed: int, folder: Path, count: int | None = None, minutes: float = 0.0) -> tuple[int, dict[str, str]]:
    """Try damaged files, so many or for so long: the number of trials, and the failures, whose files are kept in `folder`."""
    draw, until, failures, trials = random.Random(seed), time.monotonic() + 60.0 * minutes, {}, 0
    with tempfile.TemporaryDirectory() as name:
        sound, work = Path(name) / "sound", Path(name) / "work"
        sound.mkdir()
        given = seeds(sound)
        for files in given:
            if failure := trial(files, work, None):
                raise AssertionError(f"{files[0].name} is sound, and cannot be read: {failure}")
        while trials < count if count is not None else time.monotonic() < until:
            files = given[trials % len(given)]
            failure = trial(files, work, draw)
            trials += 1
            if failure and place_of(failure) not in failures:
                failures[place_of(failure)] = failure
                folder.mkdir(parents=True, exist_ok=True)
                kept = folder / f"{seed}_{trials}_{files[0].name}"
                kept.write_bytes((work / files[0].name).read_bytes())
                print(f"{kept}: {failure}", flush=True)
    return trials, failures


def trial(files: tuple[Path, ...], work: Path, draw: random.Random | None) -> str:
    """Damage a copy of a file, or not, and read it."""
    work.mkdir(exist_ok=True)
    for old in work.iterdir():
        old.unlink()
    for path in files:
        (work / path.name).write_bytes(path.read_bytes())
    if draw is not None:
        damage(work / files[0].name, draw)
    return tried(work / files[0].name, work / "said")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    trials, failures = fuzz(seed=options.seed, folder=Path("build/fuzz/files"), minutes=options.minutes)
    print(f"{trials} files, {len(failures)} kinds of failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
