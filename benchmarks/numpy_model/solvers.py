"""The NumPy model under the integrators that a user would pick: SciPy's `solve_ivp` and scikit-sundae's CVODE.

Each gets what its package takes: the pattern of the arrow-shaped Jacobian or the Jacobian itself, as a sparse matrix where
that is possible, tolerances for each kind of quantity, order 2 where it can be limited (above, lightly damped contact modes
hold the steps down).
"""

from __future__ import annotations

import time as clock
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import BDF, LSODA, Radau, solve_ivp
from scipy.integrate._ivp import bdf as scipy_bdf

from .jacobian import Jacobian
from .model import NumpyModel

Array = NDArray[np.float64]

LEAST_RTOL = 3e-14
"""Stands for no relative tolerance where a package takes none below 100 roundings."""


@dataclass(frozen=True)
class Tolerances:
    """Tolerances of every entry of a state.

    Attributes
    ----------
    relative, absolute : ndarray, shape (n_state,)
        Positions and angles have no relative part, as in the core.
    """

    relative: Array
    absolute: Array


@dataclass(frozen=True)
class Run:
    """What an integration did.

    Attributes
    ----------
    cage : ndarray, shape (times, 2)
        Cage centre in the frame that turns with the kinematic cage angle (m).
    wall : float
        Time (s): of the processor, which on a machine that does nothing else is that of the clock.
    steps, evaluations, jacobians : int
        Steps taken (nan: not counted), states whose rates were evaluated one by one, Jacobians.
    """

    cage: Array
    wall: float
    steps: float
    evaluations: int
    jacobians: int


class TooLong(RuntimeError):
    """An integration took longer than it was given."""


@dataclass
class Problem:
    """Model, start, output times, the time that an integration may take, and whether its steps are to be counted."""

    model: NumpyModel
    jacobian: Jacobian
    state: Array
    times: Array
    limit: float = 600.0
    count: bool = True

    def guarded(self) -> Callable[[float, Array], Array]:
        """The right-hand side, which gives up after `limit` seconds."""
        end, derivative = clock.perf_counter() + self.limit, self.model.derivative

        def rates(time: float, y: Array) -> Array:
            if clock.perf_counter() > end:
                raise TooLong(f"no end after {self.limit:g} s")
            return derivative(time, y)

        return rates

    @property
    def cage(self) -> slice:
        """Where the cage's centre stands in a state."""
        at = 11 * self.model.constants.n_rollers
        return slice(at, at + 2)


class LSODA2(LSODA):  # type: ignore[misc]
    """LSODA whose stiff method goes to order 2 at most; `solve_ivp` does not pass the limit on, the code below it has it."""

    def __init__(self, fun: Any, t0: float, y0: Array, t_bound: float, **options: Any) -> None:
        super().__init__(fun, t0, y0, t_bound, **options)
        solver = self._lsoda_solver
        solver.set_integrator("lsoda", rtol=options["rtol"], atol=options["atol"], max_order_s=2)
        solver.set_initial_value(y0, t0)
        solver._integrator.rwork[0] = self.t_bound
        solver._integrator.call_args[4] = solver._integrator.rwork


class BDF2(BDF):  # type: ignore[misc]
    """SciPy's BDF up to order 2. It has no option for it: a constant of its module is changed while it steps."""

    def _step_impl(self) -> Any:
        before = scipy_bdf.MAX_ORDER
        scipy_bdf.MAX_ORDER = 2
        try:
            return super()._step_impl()
        finally:
            scipy_bdf.MAX_ORDER = before


def under_scipy(
    method: type[Any], problem: Problem, tolerances: Tolerances, *, ours: bool = True, dense: bool = False
) -> Run:
    """An integration with `solve_ivp`: with our Jacobian, or with its own differences over the Jacobian's pattern."""

    class Counted(method):  # type: ignore[misc]
        steps = 0

        def _step_impl(self) -> Any:
            Counted.steps += 1
            return super()._step_impl()

    given: dict[str, Any] = {}
    if ours:
        given = {"jac": problem.jacobian.dense_copy if dense else problem.jacobian.sparse}
    elif not dense:
        # its differences call the model with many states at once
        given = {"jac_sparsity": problem.jacobian.sparsity, "vectorized": True}
    began, before = clock.process_time(), problem.jacobian.count
    found = solve_ivp(
        problem.guarded(),
        (problem.times[0], problem.times[-1]),
        problem.state,
        method=Counted,
        t_eval=problem.times,
        # LSODA takes one for each entry, the others one for all
        rtol=np.maximum(tolerances.relative, LEAST_RTOL) if issubclass(method, LSODA) else tolerances.relative.max(),
        atol=tolerances.absolute,
        **given,
    )
    wall = clock.process_time() - began
    if not found.success:
        raise RuntimeError(found.message)
    jacobians = problem.jacobian.count - before if ours else found.njev
    return Run(found.y[problem.cage].T, wall, Counted.steps, found.nfev, jacobians)


def radau(problem: Problem, tolerances: Tolerances, *, ours: bool = True) -> Run:
    """SciPy, Radau IIA of order 5."""
    return under_scipy(Radau, problem, tolerances, ours=ours)


def bdf(problem: Problem, tolerances: Tolerances, *, ours: bool = True) -> Run:
    """SciPy, backward differentiation up to order 5."""
    return under_scipy(BDF, problem, tolerances, ours=ours)


def bdf_two(problem: Problem, tolerances: Tolerances, *, ours: bool = True) -> Run:
    """SciPy, backward differentiation up to order 2, by changing a private constant."""
    return under_scipy(BDF2, problem, tolerances, ours=ours)


def lsoda(problem: Problem, tolerances: Tolerances, *, ours: bool = True) -> Run:
    """SciPy, LSODA with a dense Jacobian; it takes no other."""
    return under_scipy(LSODA, problem, tolerances, ours=ours, dense=True)


def lsoda_two(problem: Problem, tolerances: Tolerances, *, ours: bool = True) -> Run:
    """SciPy, LSODA whose stiff method goes to order 2 at most, through a subclass."""
    return under_scipy(LSODA2, problem, tolerances, ours=ours, dense=True)


def sundae(problem: Problem, tolerances: Tolerances, linear: str = "sparse") -> Run:
    """CVODE of SUNDIALS through scikit-sundae: BDF up to order 2, Jacobian in place, sparse or dense.

    It takes one relative tolerance for all entries.
    """
    from sksundae.cvode import CVODE

    rates = problem.guarded()
    failure: list[BaseException] = []

    def right_hand_side(time: float, y: Array, out: Array) -> None:
        try:
            out[:] = rates(time, y)
        except TooLong as error:
            failure.append(error)
            raise

    options: dict[str, Any] = {
        "method": "BDF",
        "max_order": 2,
        "rtol": float(tolerances.relative.max()),
        "atol": tolerances.absolute,
        "linsolver": linear,
        "max_num_steps": 10_000_000,
        "max_conv_fails": 25,
    }
    if linear == "pattern":
        options |= {"linsolver": "sparse", "sparsity": problem.jacobian.sparsity}
    elif linear == "sparse":
        options |= {"sparsity": problem.jacobian.sparsity, "jacfn": problem.jacobian.fill_sparse}
    else:
        options |= {"jacfn": problem.jacobian.fill_dense}
    with warnings.catch_warnings():
        # it says that it takes the Jacobian given, not its own
        warnings.simplefilter("ignore", UserWarning)
        solver = CVODE(right_hand_side, **options)
    began = clock.process_time()
    found = solver.solve(problem.times, problem.state)
    wall = clock.process_time() - began
    if failure:
        raise failure[0]
    if not found.success or len(found.t) != len(problem.times):
        raise RuntimeError(found.message)
    # between two times only it gives every step, in a run of its own
    steps = len(solver.solve(problem.times[[0, -1]], problem.state).t) - 1 if problem.count else np.nan
    return Run(found.y[:, problem.cage], wall, steps, int(found.nfev), int(found.njev))


def sundae_dense(problem: Problem, tolerances: Tolerances) -> Run:
    """The same with a dense matrix."""
    return sundae(problem, tolerances, "dense")


def sundae_pattern(problem: Problem, tolerances: Tolerances) -> Run:
    """The same with the package's own differences over the Jacobian's pattern, as it is used without a Jacobian of one's own."""
    return sundae(problem, tolerances, "pattern")
