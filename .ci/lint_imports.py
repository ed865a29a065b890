"""Rules of the Python package's imports beside its layers. Prints each breach and exits with 1 if there is one.

Circles: no modules import each other in a circle, not even through an import inside of a function. Imports for type checkers do
not run and do not count.

Knots: modules of which each needs each other, where imports for type checkers count, too. None is larger, and none is elsewhere,
than KNOTS says; what is untied is taken out of the table.

Late imports: an import stands at the top of its file. Inside of a function stand only those that would make every start slow, or
need a package that is optional: the packages of HEAVY, the modules of the package that load them, and what commands need
(trbdyn/cli).

Kinds of subjects: what works for one bearing works for several on a shaft. Nothing outside of the models looks whether a subject
is an assembly, or a result that of one.
"""

import ast
import sys
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from itertools import takewhile
from pathlib import Path

import grimp
import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = "trbdyn"
HEAVY = (
    "pythonfmu3",
    "dask",
    "distributed",
    "ezdxf",
    "filelock",
    "gmsh",
    "h5py",
    "matplotlib",
    "psutil",
    "pydantic_core",
    "pyoctaveband",
    "SALib",
    "scipy",
    "shapely",
    "skfem",
    "sklearn",
    "tqdm",
    "xarray",
)
LOAD_HEAVY = (
    "trbdyn.plot",
    "trbdyn.reporting.page",
    "trbdyn.results.export",
    "trbdyn.results.file_source",
    "trbdyn.results.hdf5_file",
    "trbdyn.results.result",
    "trbdyn.results.result_file",
    "trbdyn.extras.design.front",
    "trbdyn.extras.design.planning.picture",
    "trbdyn.extras.heat.preload_picture",
    "trbdyn.extras.heat.thermal_picture",
    "trbdyn.extras.maps.cage_map_picture",
    "trbdyn.extras.maps.slip_picture",
    "trbdyn.extras.maps.torque_picture",
)
KNOTS = {
    "trbdyn.model": (25,),
    "trbdyn.run": (9,),
    "trbdyn.results": (2,),
    "trbdyn.extras.app": (3,),
    "trbdyn.extras.design": (2,),
    "trbdyn.extras.design.planning": (2,),
}
"""Sizes of the knots by the folder that holds them."""
COMMANDS = ("trbdyn/cli/",)
MODELS = ("trbdyn/model/",)


def circle(package: str) -> list[str]:
    """Modules of which each imports the next, and the last the first; empty if there is no such circle."""
    graph = grimp.build_graph(package, exclude_type_checking_imports=True, cache_dir=None)
    try:
        TopologicalSorter({one: graph.find_modules_directly_imported_by(one) for one in graph.modules}).prepare()
    except CycleError as error:
        return list(error.args[1])[::-1]
    return []


def knots(package: str) -> dict[str, tuple[int, ...]]:
    """Sizes of the knots by the folder that holds them, the largest first; without the package's own file, which names all."""
    graph = grimp.build_graph(package, cache_dir=None)
    modules = sorted(graph.modules - {package})
    places = {module: place for place, module in enumerate(modules)}
    pairs = [
        (places[one], places[other])
        for one in modules
        for other in graph.find_modules_directly_imported_by(one)
        if other in places
    ]
    arrows = coo_array((np.ones(len(pairs)), tuple(zip(*pairs, strict=True))), shape=(len(modules),) * 2)
    _, labels = connected_components(arrows, connection="strong")
    found: dict[str, list[int]] = {}
    for label, size in enumerate(np.bincount(labels)):
        if size > 1:
            inside = [module.split(".") for module, own in zip(modules, labels, strict=True) if own == label]
            common = [parts[0] for parts in takewhile(lambda parts: len(set(parts)) == 1, zip(*inside, strict=False))]
            found.setdefault(".".join(common), []).append(int(size))
    return {folder: tuple(sorted(sizes, reverse=True)) for folder, sizes in found.items()}


def late_imports(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Line and module of each import inside of a function."""
    for function in ast.walk(tree):
        if not isinstance(function, ast.FunctionDef | ast.AsyncFunctionDef):
            continue
        for node in ast.walk(function):
            if isinstance(node, ast.Import):
                yield from ((node.lineno, alias.name) for alias in node.names)
            elif isinstance(node, ast.ImportFrom) and node.module:
                yield from ((node.lineno, f"{node.module}.{alias.name}") for alias in node.names)


def looks_for_assemblies(tree: ast.AST) -> Iterator[int]:
    """Lines that look whether something is an assembly, or the result of one."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "isinstance":
            kinds = {part.id for part in ast.walk(node.args[1]) if isinstance(part, ast.Name)}
            if kinds & {"Assembly", "AssemblyResult"}:
                yield node.lineno


def below(module: str, tops: tuple[str, ...]) -> bool:
    return any(module == top or module.startswith(top + ".") for top in tops)


def main() -> int:
    found = circle(PACKAGE)
    breaches = [f"imports run in a circle: {' -> '.join(found)}"] if found else []
    if (tied := knots(PACKAGE)) != KNOTS:
        breaches.append(
            f"knots of imports are {tied}, and KNOTS says {KNOTS}: untie what is new, take out what is gone"
        )
    for path in sorted((ROOT / PACKAGE).rglob("*.py")):
        name, tree = path.relative_to(ROOT).as_posix(), ast.parse(path.read_text(encoding="utf-8"))
        for line in () if name.startswith(MODELS) else looks_for_assemblies(tree):
            breaches.append(f"{name}:{line}: what works for one bearing works for an assembly: use what both have")
        if name.startswith(COMMANDS):
            continue
        for line, module in sorted(set(late_imports(tree))):
            if not below(module, HEAVY + LOAD_HEAVY):
                breaches.append(f"{name}:{line}: {module} is imported inside of a function: import it at the top")
    for breach in breaches:
        print(breach)
    return 1 if breaches else 0


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    sys.exit(main())
