"""Files that ship with the package."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from trbdyn.base.own_files import file_path
from trbdyn.errors import InputError, unknown_name

DATA: Final = Path(__file__).parent.parent / "data"
"""Folder of cases, studies and measured tables."""


@dataclass(frozen=True)
class Shipped:
    """TOML files by their names: what a file describes, as one and as many, and the folders where they lie."""

    kind: str
    kinds: str
    folders: tuple[Path, ...]

    def paths(self) -> dict[str, Path]:
        """Files by their names without the ending."""
        return {path.stem: path for folder in self.folders for path in sorted(folder.glob("*.toml"))}

    def names(self) -> tuple[str, ...]:
        """Their names, folder by folder."""
        return tuple(self.paths())

    def find(self, name: str) -> Path:
        """The file of a name, with or without ``.toml``."""
        stem, paths = name.removesuffix(".toml"), self.paths()
        if stem not in paths:
            raise InputError.of(self.kind, name, unknown_name(stem, paths))
        return paths[stem]

    def file(self, path: str | os.PathLike[str]) -> Path:
        """The file of a user; where there is none of this name, the one that ships with the package."""
        file = file_path(path, self.kind)
        ships = not file.exists() and str(path).removesuffix(".toml") in self.names()
        return self.find(str(path)) if ships else file

    def hint(self) -> str:
        """What is added to the message where no file can be opened."""
        return f"; {self.kinds} that ship with the package: {', '.join(self.names())}"


CASES: Final = Shipped("case", "cases", (DATA,))
ASSEMBLIES: Final = Shipped("assembly", "assemblies", (DATA / "assemblies",))
SUBJECTS: Final = Shipped("case", "cases", (DATA, DATA / "assemblies"))
"""Cases of one bearing and of several."""
