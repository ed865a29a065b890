"""Builds of the core without the code of an effect, from a copy of the C sources with the flags of the installed one.

Needs ``build/package``, which ``make install`` leaves: its commands are repeated on the copy. All cores that are compared,
that with everything among them, are built in this way and loaded side by side.
"""

from __future__ import annotations

import concurrent.futures
import importlib.util
import json
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

from effect_cost.catalogue import Patch

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "build" / "package"


class BuildError(Exception):
    """Why there is no build."""


class Builds:
    """Cores out of one copy of the sources.

    Parameters
    ----------
    folder : Path
        Where they go; made, and left to the caller to remove.
    instruction_set : str
        Kernel variant that is measured: of the kernels only it is compiled without an effect's code.
    """

    def __init__(self, folder: Path, instruction_set: str) -> None:
        if not (PACKAGE / "compile_commands.json").exists():
            raise BuildError("build/package is missing: run make install")
        self.folder = folder
        self.variant = instruction_set
        shutil.copytree(ROOT / "csrc", folder / "csrc")
        text = (PACKAGE / "compile_commands.json").read_text(encoding="utf-8")
        entries = [entry for entry in json.loads(text) if "/csrc/tests/" not in entry["file"]]
        self.entries = [entry for entry in entries if "sundials_bindings" not in entry["file"]]
        self.link = self._link_command()
        self.objects = self._compile(self.entries, folder / "csrc", "whole")

    def _link_command(self) -> list[str]:
        module = next(PACKAGE.glob("_core*.so"), None)
        ninja = shutil.which("ninja", path=str(Path(sys.executable).parent)) or shutil.which("ninja")
        if module is None or ninja is None:
            raise BuildError("neither a built module nor ninja is there")
        shown = subprocess.run(
            [ninja, "-C", str(PACKAGE), "-t", "commands", module.name], capture_output=True, text=True
        )
        if shown.returncode:
            raise BuildError(f"ninja does not tell its commands: {shown.stderr.strip()}")
        line = next(line for line in reversed(shown.stdout.splitlines()) if "-shared" in line)
        words = shlex.split(line)
        return words[words.index("&&") + 1 : words.index("&&", 2)]

    def _compile(self, entries: list[dict[str, Any]], sources: Path, name: str) -> dict[str, Path]:
        """Object files of some entries by the output's name in the build."""
        target = self.folder / name
        out = {entry["output"]: target / f"{i}.o" for i, entry in enumerate(entries)}
        target.mkdir(exist_ok=True)

        def one(entry: dict[str, Any]) -> None:
            words = shlex.split(entry["command"].replace(str(ROOT / "csrc"), str(sources)))
            words[words.index("-o") + 1] = str(out[entry["output"]])
            words = [word for word in words if word != "-Werror"] + ["-w"]
            done = subprocess.run(words, capture_output=True, text=True, cwd=PACKAGE)
            if done.returncode:
                raise BuildError(f"{name}: {Path(entry['file']).name} does not compile: {done.stderr[:400]}")

        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            list(pool.map(one, entries))
        return out

    def _link(self, name: str, objects: dict[str, Path]) -> ModuleType:
        path = self.folder / name / "_core.so"
        words = [word for word in self.link if not word.endswith((".c.o", "libtrbdyn_core.a"))]
        words[words.index("-o") + 1] = str(path)
        first = next(i for i, word in enumerate(words) if word.endswith(".a"))
        words[first:first] = [str(item) for item in objects.values()]
        done = subprocess.run(words, capture_output=True, text=True, cwd=PACKAGE)
        if done.returncode:
            raise BuildError(f"{name} does not link: {done.stderr[:400]}")
        spec = importlib.util.spec_from_file_location(f"{name}._core", path)
        if spec is None or spec.loader is None:
            raise BuildError(f"{path} cannot be loaded")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module

    def whole(self) -> ModuleType:
        """The core with everything."""
        return self._link("whole", self.objects)

    def without(self, name: str, patch: Patch) -> ModuleType:
        """The core with a patch."""
        name = name.replace(" ", "_")
        sources = self.folder / f"csrc_{name}"
        shutil.copytree(self.folder / "csrc", sources)
        apply(patch, sources)
        headers = any(file.endswith(".h") for file in patch)
        touched = [entry for entry in self.entries if self._touched(entry, patch, headers)]
        return self._link(name, self.objects | self._compile(touched, sources, name))

    def _touched(self, entry: dict[str, Any], patch: Patch, headers: bool) -> bool:
        place = Path(entry["file"]).relative_to(ROOT / "csrc").as_posix()
        if place.endswith("_kernel.c") and f"TRB_KERNEL_VARIANT={self.variant}" not in entry["command"]:
            return False
        return place in patch or headers


def apply(patch: Patch, sources: Path) -> None:
    """Take code out of a copy of the sources.

    Raises
    ------
    BuildError
        If an expression does not match.
    """
    for file, changes in patch.items():
        text = (sources / file).read_text(encoding="utf-8")
        for pattern, replacement in changes:
            text, count = re.subn(pattern, replacement, text, flags=re.DOTALL)
            if count == 0:
                raise BuildError(f"{file} has changed: nothing matches {pattern!r}")
        (sources / file).write_text(text, encoding="utf-8")
