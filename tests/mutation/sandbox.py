"""A copy of the sources with a build and a Python environment of its own: every process of a test finds this copy, and no other.

The environment finds the packages of the one that runs this, but not its editable install: that one would lead a subprocess of
a test (`python -m trbdyn`) to the sources without the fault.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from faults import ROOT, Fault

WORK = ROOT / "build" / "mutation"
TREE = WORK / "tree"
BUILD = WORK / "package"
VENV = WORK / "venv"
PYTHON = VENV / "bin" / "python"
COPIED = ("csrc", "trbdyn", "tests", "benchmarks", "docs", "README.md", "Makefile", "pyproject.toml")
TOOLS = ROOT / ".venv" / "bin"
FLAGS = [
    "-DCMAKE_BUILD_TYPE=None",
    "-DCMAKE_C_FLAGS=-O1",
    "-DTRB_BUILD_TESTS=ON",
    "-DTRB_FLAG_V3=OFF",
    "-DTRB_FLAG_V4=OFF",
]
"""Without vectors wider than every machine has, and without the last percent of speed: it compiles in half the time."""


def _copy_sources() -> None:
    for name in COPIED:
        source, target = ROOT / name, TREE / name
        files = [source] if source.is_file() else [path for path in source.rglob("*") if path.is_file()]
        files = [path for path in files if "__pycache__" not in path.parts and path.suffix not in (".so", ".pyc")]
        wanted = {TREE / path.relative_to(ROOT) for path in files}
        for path in files:
            copy = TREE / path.relative_to(ROOT)
            text = path.read_bytes()
            if path.name == "TrbKernels.cmake":
                text = text.replace(b"-O3", b"-O1")
            if not copy.exists() or copy.read_bytes() != text:
                copy.parent.mkdir(parents=True, exist_ok=True)
                copy.write_bytes(text)
        for path in target.rglob("*") if target.is_dir() else []:
            if path.is_file() and path not in wanted and path.suffix not in (".so", ".pyc"):
                path.unlink()


def _make_environment() -> None:
    if not PYTHON.exists():
        subprocess.run([sys.executable, "-m", "venv", "--without-pip", VENV], check=True)
    packages = sysconfig.get_path("purelib", vars={"base": str(VENV), "platbase": str(VENV)})
    others = sysconfig.get_path("purelib", vars={"base": str(ROOT / ".venv"), "platbase": str(ROOT / ".venv")})
    # a folder that a .pth file names is searched, but the .pth files in it, and with them editable installs, are not read
    (Path(packages) / "sources_with_a_fault.pth").write_text(f"{TREE}\n{others}\n", encoding="utf-8")


def prepare() -> None:
    """Brings the copy, its environment and its build up to date."""
    TREE.mkdir(parents=True, exist_ok=True)
    _copy_sources()
    _make_environment()
    words = [TOOLS / "cmake", "-S", TREE / "csrc", "-B", BUILD, "-G", "Ninja", *FLAGS]
    words += [f"-DCMAKE_MAKE_PROGRAM={TOOLS / 'ninja'}", f"-DPython_EXECUTABLE={ROOT / '.venv' / 'bin' / 'python'}"]
    if not (BUILD / "build.ninja").exists():
        subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)
    compile_core()
    compile_c_tests()
    # compiled Python that is checked by its source's hash: two faults of one second and one length are not taken for each other
    words = [PYTHON, "-m", "compileall", "-q", "--invalidation-mode", "checked-hash", TREE / "trbdyn"]
    subprocess.run([str(word) for word in words], check=True, cwd=TREE)
    # what pytest makes of the tests is kept: they are not changed by faults
    words = [PYTHON, "-m", "pytest", "--collect-only", "-q", "-p", "no:cacheprovider", "-p", "no:nbmake", "tests"]
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    silent = subprocess.DEVNULL
    subprocess.run([str(word) for word in words], check=False, cwd=TREE, env=environment, stdout=silent, stderr=silent)


def _ninja(*targets: str) -> bool:
    words = [str(TOOLS / "ninja"), "-C", str(BUILD), "-j", "1", *targets]
    return subprocess.run(words, capture_output=True, check=False).returncode == 0


def core() -> Path:
    (module,) = BUILD.glob("_core*.so")
    return module


def _put_core() -> None:
    # a new file each time: the old one may still be mapped
    target = TREE / "trbdyn" / core().name
    target.unlink(missing_ok=True)
    shutil.copyfile(core(), target)


def compile_core() -> bool:
    done = _ninja("_core")
    if done:
        _put_core()
    return done


def compile_c_tests(names: Sequence[str] = ()) -> bool:
    """All of them unless some are named."""
    return _ninja(*(names or ["all"]))


def fingerprint(*names: str) -> str:
    """Of files of the copy: changes when one of them does."""
    found = hashlib.sha256()
    for name in names:
        for path in sorted((TREE / name).rglob("*")) if (TREE / name).is_dir() else [TREE / name]:
            if path.is_file() and path.suffix not in (".pyc", ".so") and path.parent.name != "mutation":
                found.update(str(path.relative_to(TREE)).encode() + b"\0" + path.read_bytes())
    return found.hexdigest()[:16]


class Snapshot:
    """The build as it is without a fault; put back after each fault, so that nothing is compiled twice for it."""

    def __init__(self) -> None:
        self.kept = WORK / "package.kept"
        shutil.rmtree(self.kept, ignore_errors=True)
        shutil.copytree(BUILD, self.kept, symlinks=True)
        self.times = {path: path.stat().st_mtime_ns for path in self._files()}

    def _files(self) -> Iterator[Path]:
        for folder, _, names in os.walk(BUILD):
            for name in names:
                if not Path(folder, name).is_symlink():
                    yield Path(folder, name)

    def put_back(self) -> None:
        there = list(self._files())
        for path in there:
            if path not in self.times:
                path.unlink()
        for path, time in self.times.items():
            if not path.exists() or path.stat().st_mtime_ns != time:
                path.unlink(missing_ok=True)
                shutil.copy2(self.kept / path.relative_to(BUILD), path)
        _put_core()

    def same_program(self) -> bool:
        """The compiler made the same core and the same C tests."""
        return all(
            path.read_bytes() == (self.kept / path.relative_to(BUILD)).read_bytes()
            for path in [core(), *BUILD.rglob("*.a")]
        )


@contextmanager
def planted(fault: Fault, snapshot: Snapshot) -> Iterator[bool]:
    """The copy with a fault; says whether it compiles."""
    file = TREE / fault.file
    text, times = file.read_text(encoding="utf-8"), file.stat()
    file.write_text(fault.applied(text), encoding="utf-8")
    is_c = fault.file.startswith("csrc")
    try:
        if is_c:
            yield compile_core()
        else:
            try:
                compile(file.read_text(encoding="utf-8"), fault.file, "exec")
            except SyntaxError:
                yield False
            else:
                yield True
    finally:
        # the build first: whoever ends this process here leaves a source that is newer than what was compiled of it
        if is_c:
            snapshot.put_back()
        file.write_text(text, encoding="utf-8")
        os.utime(file, ns=(times.st_atime_ns, times.st_mtime_ns))
