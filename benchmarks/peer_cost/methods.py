"""What is compared: the core's integrators, and those that a user would pick for the NumPy model.

An alternative gets what its package takes: the pattern of the Jacobian where it takes one, states in batches, the limit of
order. Beside these stand the same integrators with our Jacobian, `Jacobian` of numpy_model: differences of each roller's own
block, all columns in one batch. That is the core's idea, written for NumPy.
"""

from __future__ import annotations

import typing
from collections.abc import Callable
from functools import partial

from numpy_model import solvers

from trbdyn import RunOptions

from .bench import EXACT, Bench, Method

OURS = ", our Jacobian"
"""Behind the name of an alternative that is handed the batched Jacobian."""

Peer = tuple[str, Callable[..., solvers.Run], list[float], bool]
"""Name, integration, factors on the tolerances, whether it is slow."""


def own(bench: Bench) -> list[Method]:
    """The core's integrators, the standard one first."""
    standard = RunOptions().integrator
    every = typing.get_args(RunOptions.model_fields["integrator"].annotation)
    out = []
    for name in (standard, standard + EXACT, *(name for name in every if name not in (standard, "multirate"))):
        explicit = name == "erk"
        factors = [10.0, 1.0, 0.1] if explicit else [30.0, 10.0, 3.0, 1.0, 0.3, 0.1]
        out.append(
            Method(f"trbdyn {name}", "core", partial(bench.core, integrator=name), factors, 1 if explicit else 3)
        )
    return out


def _packages(quick: bool) -> list[Peer]:
    """What the packages do by themselves."""
    # these take long: one tolerance, at which they are the least slow, has to do in a quick run
    peers: list[Peer] = [
        ("SciPy Radau", partial(solvers.radau, ours=False), [100.0] if quick else [30.0, 10.0], True),
        ("SciPy BDF", partial(solvers.bdf, ours=False), [10.0] if quick else [10.0, 3.0], True),
        ("SciPy LSODA", partial(solvers.lsoda, ours=False), [30.0] if quick else [30.0, 10.0], True),
    ]
    if not quick:
        peers.append(("SciPy BDF, order 2", partial(solvers.bdf_two, ours=False), [10.0, 3.0], True))
    peers.append(("scikit-sundae CVODE", solvers.sundae_pattern, [3.0] if quick else [10.0, 3.0, 1.0], False))
    return peers


def _handed(quick: bool) -> list[Peer]:
    """The same with our Jacobian."""
    peers: list[Peer] = [
        ("SciPy Radau", solvers.radau, [3.0] if quick else [30.0, 3.0, 1.0], True),
        ("SciPy BDF", solvers.bdf, [10.0] if quick else [10.0, 3.0, 1.0], True),
        ("SciPy BDF, order 2", solvers.bdf_two, [3.0, 1.0] if quick else [10.0, 3.0, 1.0], False),
        ("SciPy LSODA", solvers.lsoda, [10.0] if quick else [30.0, 10.0, 3.0], True),
        ("SciPy LSODA, order 2", solvers.lsoda_two, [10.0] if quick else [30.0, 10.0, 3.0], False),
    ]
    peers.append(("scikit-sundae CVODE", solvers.sundae, [1.0, 0.3] if quick else [10.0, 3.0, 1.0, 0.3], False))
    if not quick:
        peers.append(("scikit-sundae CVODE, dense", solvers.sundae_dense, [10.0, 3.0, 1.0, 0.3], False))
    return [(name + OURS, *rest) for name, *rest in peers]


def alternatives(bench: Bench, quick: bool, smoke: bool = False) -> list[Method]:
    """The packages by themselves, then with our Jacobian; `smoke`: the fastest of each. One that is not installed is among
    them: its run says why it fails.
    """
    out = []
    for name, run, factors, slow in [*_packages(quick), *_handed(quick)]:
        if smoke and not name.startswith("SciPy LSODA"):
            continue
        ours = name.endswith(OURS)
        more = sorted({100.0, *factors, 0.3, 0.1}, reverse=True) if ours and not quick else factors
        out.append(Method(name, "numpy", partial(bench.peer, run=run), more, slow=slow))
    return out
