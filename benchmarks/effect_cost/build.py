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
from collections.abc import Sequence
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
    instruction_sets : sequence of str
        Kernel variants that are measured: of the kernels only they are compiled without an effect's code.
    """

    def __init__(self, folder: Path, instruction_sets: Sequence[str]) -> None:
        if not (PACKAGE / "compile_commands.json").exists():
            raise BuildError("build/package is missing: run make install")
        self.folder = folder
        self.variants = tuple(instruction_sets)
        shutil.copytree(ROOT / "csrc", folder / "csrc")
        self.link, made = self._link_command()
        self.read = self._files_read()
        text = (PACKAGE / "compile_commands.json").read_text(encoding="utf-8")
        entries = [entry for entry in json.loads(text) if entry["output"] in made]
        self.entries = [entry for entry in entries if "sundials_bindings" not in entry["file"]]
        self.objects = self._compile(self.entries, folder / "csrc", "whole")

    def _ninja(self, *words: str) -> list[str]:
        """Lines that a tool of ninja tells of the build."""
        ninja = shutil.which("ninja", path=str(Path(sys.executable).parent)) or shutil.which("ninja")
        if ninja is None:
            raise BuildError("ninja is not there")
        shown = subprocess.run([ninja, "-C", str(PACKAGE), "-t", *words], capture_output=True, text=True)
        if shown.returncode:
            raise BuildError(f"ninja does not tell its {words[0]}: {shown.stderr.strip()}")
        return shown.stdout.splitlines()

    def _link_command(self) -> tuple[list[str], set[str]]:
        """How the module is linked, and the object files that it needs."""
        module = next(PACKAGE.glob("_core*.so"), None)
        if module is None:
            raise BuildError("a built module is not there")
        lines = [shlex.split(line) for line in self._ninja("commands", module.name)]
        made = {str(PACKAGE / words[words.index("-o") + 1]) for words in lines if "-c" in words and "-o" in words}
        words = next(words for words in reversed(lines) if "-shared" in words)
        return words[words.index("&&") + 1 : words.index("&&", 2)], made

    def _files_read(self) -> dict[str, set[str]]:
        """Files of the sources that each object file was made of, by the output's name in the build."""
        found: dict[str, set[str]] = {}
        sources, output = f"{ROOT / 'csrc'}/", ""
        for line in self._ninja("deps"):
            if line and not line.startswith(" "):
                output = str(PACKAGE / line.partition(":")[0])
            elif line.strip().startswith(sources):
                found.setdefault(output, set()).add(line.strip().removeprefix(sources))
        return found

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
        touched = [entry for entry in self.entries if self._touched(entry, patch)]
        return self._link(name, self.objects | self._compile(touched, sources, name))

    def _touched(self, entry: dict[str, Any], patch: Patch) -> bool:
        of_kernel = entry["file"].endswith("_kernel.c")
        if of_kernel and not any(f"TRB_KERNEL_VARIANT={name}" in entry["command"] for name in self.variants):
            return False
        return not self.read.get(entry["output"], set(patch)).isdisjoint(patch)


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
