"""Limits of every file that is read: which files are opened at all, how large they may be, and how much may be in them.

A file may come from a stranger. Each reader begins with `checked_file` or `read_input`, and takes its other limits from here, so
that a small file cannot fill the memory of the machine, or take its time.
"""

from __future__ import annotations

import os
import re
import stat
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

from trbdyn.base.locks import flags
from trbdyn.base.own_files import file_path
from trbdyn.errors import FileError

LARGEST: Final = {
    "TOML": 16 << 20,
    "CSV": 64 << 20,
    "DXF": 64 << 20,
    "STEP": 256 << 20,
    "STL": 256 << 20,
    "HDF5": 1 << 50,
    "XML": 16 << 20,
}
"""Largest file of each kind (bytes). What an HDF5 file takes in memory is told by its datasets, see `unpacked_limit`."""
DEEPEST: Final = 40
"""Most levels of tables and lists in a case; a case has eight."""
MOST_KEYS: Final = 20_000
"""Most parts of keys in a case, ``a.b = 1`` has two; the largest cases have some hundred."""
MOST_POINTS: Final = 1_000_000
"""Most points of a line that is read or drawn."""
MOST_LINES: Final = 10_000
"""Most entities of a drawn line that are joined."""
LARGEST_DRAWN: Final = 20.0
"""Farthest place in a drawing from its origin (m)."""
MOST_CASES: Final = 1000
"""Most load cases of a spectrum."""
MOST_LOADS: Final = 500
"""Most load cases of all bearings of a gear unit together."""
MOST_PARTS: Final = 2000
"""Most components of a gear unit."""
MOST_BEARINGS: Final = 50
"""Most bearings of a gear unit."""
MOST_AROUND: Final = 20
"""Most casings, oils and units of a gear unit."""
MOST_TRIANGLES: Final = 1_000_000
"""Most triangles that cover a drawing."""


def checked_file(path: object, kind: str, *, field: str = "path", hint: str = "") -> Path:
    """The path of a file that may be opened: a regular one, not larger than files of its kind are. A link is followed.

    A FileError says why it may not; where there is none, `hint` is added to the message.
    """
    file = file_path(path, field)
    try:
        found = file.stat()
    except OSError as error:
        raise FileError(f"{file}: {_why(error)}{hint}") from None
    _check(file, found, kind)
    return file


def _why(error: OSError) -> str:
    return "there is no such file" if isinstance(error, FileNotFoundError) else error.strerror or str(error)


def _check(file: Path, found: os.stat_result, kind: str) -> None:
    if stat.S_ISDIR(found.st_mode):
        raise FileError(f"{file}: is a folder, not a file")
    if not stat.S_ISREG(found.st_mode):
        raise FileError(f"{file}: is no regular file: pipes and devices are not read")
    if found.st_size > LARGEST[kind]:
        raise FileError(
            f"{file}: has {found.st_size / 1e6:.0f} MB; {kind} files up to {LARGEST[kind] >> 20} MB are read"
        )


def read_input(path: object, kind: str, *, field: str = "path", hint: str = "") -> bytes:
    """The content of a file that may be read, see `checked_file`."""
    file = file_path(path, field)
    try:
        handle = os.open(file, os.O_RDONLY | flags("O_CLOEXEC", "O_NONBLOCK", "O_BINARY"))
        with _closing(handle):
            _check(file, os.fstat(handle), kind)
            with open(handle, "rb", closefd=False) as stream:
                data = stream.read(LARGEST[kind] + 1)
    except FileError:
        raise
    except OSError as error:
        raise FileError(f"{file}: {_why(error)}{hint}") from None
    if len(data) > LARGEST[kind]:
        raise FileError(f"{file}: {kind} files up to {LARGEST[kind] >> 20} MB are read")
    return data


@contextmanager
def _closing(handle: int) -> Iterator[None]:
    try:
        yield
    finally:
        os.close(handle)


def read_input_text(path: object, kind: str, *, field: str = "path", hint: str = "") -> str:
    """The text of a file that may be read, UTF-8 with or without the mark of its order of bytes."""
    data = read_input(path, kind, field=field, hint=hint)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise FileError(f"{path}: is no text in UTF-8: {error}") from None


def unpacked_limit(size: int) -> int:
    """Most bytes that a dataset of an HDF5 file of `size` bytes takes in memory: records are packed to a tenth at best, and a
    single field can be constant.
    """
    return (96 << 20) + 64 * size


_TEXTS: Final = re.compile(
    r'"""[^\\"]*+(?:(?:\\.|"(?!""))[^\\"]*+)*+(?:"""|\Z)'
    r"|'''[^']*+(?:'(?!'')[^']*+)*+(?:'''|\Z)"
    r'|"(?:[^"\\\n]|\\.)*+(?:"|(?=\n)|\Z)'
    r"|'[^'\n]*+(?:'|(?=\n)|\Z)"
    r"|#[^\n]*+",
    re.DOTALL,
)
_KEY: Final = re.compile(r"(?<![\w.\-])[\w\-]++(?:[ \t]*+\.[ \t]*+[\w\-]++)*+(?=[ \t]*+[=\]])", re.ASCII)


def tables_of(text: str) -> dict[str, Any]:
    """The tables of a text in TOML; a ValueError if it is none, or is nested too deeply or has too many keys to be a case.

    Keys are counted before the text is parsed: parsing a key of n parts takes time and memory of the order of n^2.
    """
    bare = _TEXTS.sub("q", text)
    parts = 0
    for found in _KEY.finditer(bare):
        inside = found[0].count(".") + 1
        if inside > DEEPEST:
            raise ValueError("its tables are nested too deeply: a key has more than 40 parts")
        parts += inside
        if parts > MOST_KEYS:
            raise ValueError(f"it has more than {MOST_KEYS} keys")
    if _deepest_bracket(bare) > DEEPEST:
        raise ValueError("its tables are nested too deeply")
    try:
        tables = tomllib.loads(text)
    except RecursionError:
        raise ValueError("its tables are nested too deeply") from None
    if _depth(tables) > DEEPEST:
        raise ValueError("its tables are nested too deeply")
    return tables


def _deepest_bracket(text: str) -> int:
    deepest = depth = 0
    for one in re.findall(r"[\[\]{}]", text):
        depth += 1 if one in "[{" else -1
        deepest = max(deepest, depth)
    return deepest


def _depth(tables: dict[str, Any]) -> int:
    """How deep tables and lists are nested."""
    level: list[Any] = [tables]
    depth = 0
    while level:
        depth += 1
        inside = [entry for place in level for entry in (place.values() if isinstance(place, dict) else place)]
        level = [entry for entry in inside if isinstance(entry, dict | list)]
    return depth
