"""Names of a package that are imported when they are first used, and are listed once."""

from __future__ import annotations

import ast
import gc
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from trbdyn.base.extras import module as module_of


def lazy_names(package: str, file: str) -> tuple[list[str], Callable[[str], Any], Callable[[], list[str]]]:
    """``__all__``, ``__getattr__`` and ``__dir__`` of a package, from its ``__name__`` and ``__file__``.

    The names are those that its file imports under ``if TYPE_CHECKING``, as ``from module import name as name``: type checkers
    read them there, too.
    """
    blocks = [node for node in ast.parse(Path(file).read_text(encoding="utf-8")).body if isinstance(node, ast.If)]
    places: dict[str, tuple[str, str]] = {}
    for node in (entry for block in blocks for entry in block.body):
        if isinstance(node, ast.ImportFrom) and node.module is not None:
            places |= {alias.asname: (node.module, alias.name) for alias in node.names if alias.asname is not None}

    def found(name: str) -> Any:
        if name not in places:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        module, own = places[name]
        with _uncollected():
            value = None if module == package else getattr(module_of(module, name), own, None)
            value = module_of(f"{module}.{own}", name) if value is None else value
        setattr(sys.modules[package], name, value)
        return value

    return sorted(places), found, lambda: sorted(places)


@contextmanager
def _uncollected() -> Iterator[None]:
    """Without the garbage collector: modules make objects that stay, and going through them takes a seventh of the import."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()
