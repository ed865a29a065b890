"""Torque and power by source, and the energy audit (docs/theory/energy.md#closure).

The core integrates every term of the audit beside the motion; none is what remains of the others. So the residual

    work_shaft + work_ring + work_gravity - d(kinetic) - d(elastic) - sum of losses

measures the error of the integration, and its size over the dissipated work is the closure. The energy drawn by the rolling
film's pressure force counts as a loss.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

WORK, LOSS, POWER, TORQUE = "work_", "loss_", "power_", "inner_torque_"
STORED = ("kinetic_energy", "elastic_energy")
NOTHING_LOST = 5e-8
"""Losses over the largest term of the audit up to which nothing is lost; a run is not watched below it, either."""


@dataclass(frozen=True, slots=True)
class EnergyAudit:
    """Energy over a span of time. All energies in J.

    Attributes
    ----------
    work : dict of str to float
        Work put in, by source.
    stored : dict of str to float
        Growth of kinetic and elastic energy.
    losses : dict of str to float
        Energy lost, by kind.
    residual : float
        Work minus growth minus losses: zero for an exact integration.
    dissipated : float
        Sum of the losses.
    closure : float
        \\|residual\\| over the dissipated work; nan where as good as nothing is dissipated.
    relative_residual : float
        \\|residual\\| over the largest term: also defined without dissipation.
    """

    work: dict[str, float]
    stored: dict[str, float]
    losses: dict[str, float]
    residual: float
    dissipated: float
    closure: float
    relative_residual: float


def _part(terms: Mapping[str, ArrayLike], prefix: str) -> dict[str, Array]:
    return {
        name.removeprefix(prefix): np.asarray(values, dtype=float)
        for name, values in terms.items()
        if name.startswith(prefix)
    }


def _stored(terms: Mapping[str, ArrayLike]) -> dict[str, Array]:
    missing = [name for name in (*STORED, "work_shaft") if name not in terms]
    if missing:
        raise ValueError(f"an energy audit needs {', '.join(missing)}")
    return {name.removesuffix("_energy"): np.asarray(terms[name], dtype=float) for name in STORED}


def energy_balance(terms: Mapping[str, ArrayLike]) -> dict[str, Array]:
    """Every term of the audit since the first record.

    Parameters
    ----------
    terms : mapping of str to array_like, shape (T,)
        Fields of the group ``"energy"``: work\\_..., loss\\_..., kinetic_energy, elastic_energy, J.

    Returns
    -------
    dict of str to ndarray, shape (T,)
        The terms by their names, less their first values, and ``"residual"``, J.

    Raises
    ------
    ValueError
        If a term is missing.
    """
    stored = _stored(terms)
    work, losses = _part(terms, WORK), _part(terms, LOSS)
    out = {f"work_{name}": values - values[0] for name, values in work.items()}
    out |= {f"{name}_energy": values - values[0] for name, values in stored.items()}
    out |= {f"loss_{name}": values - values[0] for name, values in losses.items()}
    signs = {name: 1.0 if name.startswith(WORK) else -1.0 for name in out}
    out["residual"] = np.sum([signs[name] * values for name, values in out.items()], axis=0)
    return out


def energy_audit(terms: Mapping[str, ArrayLike]) -> EnergyAudit:
    """Audit the energy between the first and the last record.

    Parameters
    ----------
    terms : mapping of str to array_like, shape (T,)
        As in `energy_balance`.

    Returns
    -------
    EnergyAudit
        Terms, residual and closure.

    Raises
    ------
    ValueError
        If a term is missing.
    """
    change = {name: float(values[-1]) for name, values in energy_balance(terms).items()}
    residual = change.pop("residual")
    work = {name.removeprefix(WORK): value for name, value in change.items() if name.startswith(WORK)}
    losses = {name.removeprefix(LOSS): value for name, value in change.items() if name.startswith(LOSS)}
    stored = {name.removesuffix("_energy"): change[name] for name in STORED}
    dissipated = float(sum(losses.values()))
    largest = max(abs(value) for value in change.values())
    return EnergyAudit(
        work=work,
        stored=stored,
        losses=losses,
        residual=residual,
        dissipated=dissipated,
        closure=abs(residual) / abs(dissipated) if abs(dissipated) > NOTHING_LOST * largest else float("nan"),
        relative_residual=abs(residual) / largest if largest else 0.0,
    )


def power_split(
    time: ArrayLike, energy: Mapping[str, ArrayLike] | None = None, power: Mapping[str, ArrayLike] | None = None
) -> dict[str, float]:
    """Mean power loss by kind.

    Parameters
    ----------
    time : array_like, shape (T,)
        Times, s.
    energy : mapping of str to array_like, shape (T,), optional
        Fields loss\\_..., J. With them the means are exact: growth over duration.
    power : mapping of str to array_like, shape (T,), optional
        Fields power\\_..., W, averaged over the records where `energy` has no losses.

    Returns
    -------
    dict of str to float
        Mean loss by kind, W; empty if neither is given.
    """
    t = np.asarray(time, dtype=float)
    losses = _part(energy or {}, LOSS)
    if losses and t.size > 1:
        return {name: float((values[-1] - values[0]) / (t[-1] - t[0])) for name, values in losses.items()}
    powers = _part(power or {}, POWER)
    powers.pop("loss", None)
    return {name: float(values.mean()) for name, values in powers.items()}


def torque_split(torque: Mapping[str, ArrayLike]) -> dict[str, float]:
    """Mean of the shaft's friction torque by source.

    Parameters
    ----------
    torque : mapping of str to array_like, shape (T,)
        Fields of the group ``"torque"``, N m.

    Returns
    -------
    dict of str to float
        Mean share of each source, N m.
    """
    return {name: float(values.mean()) for name, values in _part(torque, TORQUE).items()}
