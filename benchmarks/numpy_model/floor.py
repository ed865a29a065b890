"""The least that a force evaluation can take on this machine: operations of the laws over measured rates. An estimate.

Counted are the operations of one raceway node with the paper's effects, as the laws are written, and of what comes once a
roller. Rates are those of long vectorised loops over data in the first cache: compiled ones if there is a C compiler,
NumPy's otherwise; additions and multiplications at the rate of a matrix product. No loads, no reductions, no waiting for
one another, so that the floor cannot be reached.
"""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np

NODE = {
    "geometry": {"flop": 113, "sqrt": 1, "divide": 1},
    "load, width, pressure": {"flop": 12, "log": 1, "exp": 1, "sqrt": 2},
    "speeds": {"flop": 14, "log": 1, "sqrt": 2, "divide": 1},
    "films": {"flop": 14, "exp": 1, "divide": 1},
    "thermal factor": {"flop": 22, "log": 1, "exp": 3, "divide": 1},
    "traction": {"flop": 40, "log": 1, "exp": 1, "sqrt": 1, "divide": 7},
    "rolling resistance": {"flop": 24, "exp": 1, "divide": 1},
    "sums": {"flop": 88, "divide": 2},
}
"""Operations of a raceway node, by pass; a fused multiply-add counts two, the logarithm of asinh as a logarithm."""

ROLLER = {
    "pose": {"flop": 120, "sincos": 3, "divide": 1},
    "rib": {"flop": 230, "log": 4, "exp": 7, "sqrt": 7, "divide": 13},
    "front rib and pocket, out of reach": {"flop": 330},
    "Newton and Euler": {"flop": 130, "divide": 1},
}
"""Operations that come once a roller, in the same way."""

SINCOS = 2.5
"""A sine and cosine together, in exponentials; assumed."""

SOURCE = r"""
#include <math.h>
#define LOOP(name, expression) \
  void name(int n, int times, const double *restrict x, double *restrict y) { \
    for (int k = 0; k < times; k++) { \
      for (int i = 0; i < n; i++) y[i] = expression; \
      __asm__ volatile("" : : "r"(y) : "memory"); \
    } \
  }
LOOP(loop_exp, exp(x[i]))
LOOP(loop_log, log(x[i]))
LOOP(loop_sqrt, sqrt(x[i]))
LOOP(loop_divide, 1.5 / x[i])
"""
KINDS = ("exp", "log", "sqrt", "divide")


@dataclass(frozen=True)
class Rates:
    """What the machine does.

    Attributes
    ----------
    how : str
        'compiled' or 'numpy'.
    nanoseconds : dict of str to float
        Time of one operation in a long loop, by kind; 'flop' among them.
    """

    how: str
    nanoseconds: dict[str, float] = field(default_factory=dict)

    def of(self, counts: dict[str, dict[str, int]]) -> float:
        """Time of a table of operations (ns)."""
        cost = self.nanoseconds | {"sincos": SINCOS * self.nanoseconds["exp"]}
        return sum(number * cost[kind] for part in counts.values() for kind, number in part.items())


def totals(counts: dict[str, dict[str, int]]) -> dict[str, int]:
    """Operations of a table by kind."""
    out: dict[str, int] = {}
    for part in counts.values():
        for kind, number in part.items():
            out[kind] = out.get(kind, 0) + number
    return out


def measure(repeats: int = 9) -> Rates:
    """Rates of this machine, on one core."""
    n = 1024
    x = np.random.default_rng(0).uniform(0.5, 2.0, n)
    y = np.empty(n)
    compiled = _compiled(x, y)
    if compiled is None:
        functions: dict[str, Callable[..., object]] = {
            "exp": np.exp,
            "log": np.log,
            "sqrt": np.sqrt,
            "divide": lambda a, out: np.divide(1.5, a, out=out),
        }
        found = {kind: _slope(functions[kind], repeats) for kind in KINDS}
        return Rates("numpy", found | {"flop": _flop(repeats)})
    found = {}
    for kind in KINDS:
        compiled[kind](200)
        found[kind] = 1e9 * min(_spent(partial(compiled[kind], 500)) for _ in range(repeats)) / (500 * n)
    return Rates("compiled", found | {"flop": _flop(repeats)})


def _spent(function: Callable[[], object]) -> float:
    began = time.process_time()
    function()
    return time.process_time() - began


def _flop(repeats: int) -> float:
    """Time of an addition or multiplication in a matrix product (ns)."""
    n = 384
    a = np.random.default_rng(1).normal(size=(n, n))
    out = a @ a
    return 1e9 * min(_spent(lambda: np.matmul(a, a, out=out)) for _ in range(3 * repeats)) / (2.0 * n**3)


def _slope(function: Callable[..., object], repeats: int) -> float:
    """Time of one more element in a NumPy call (ns), without the call's own."""
    few, many = np.linspace(0.5, 2.0, 512), np.linspace(0.5, 2.0, 2560)

    def loop(a: np.ndarray) -> float:
        out = np.empty_like(a)
        return min(_spent(lambda: [function(a, out=out) for _ in range(300)]) for _ in range(repeats)) / 300

    return 1e9 * (loop(many) - loop(few)) / (many.size - few.size)


def _compiled(x: np.ndarray, y: np.ndarray) -> dict[str, Callable[[int], object]] | None:
    """Loops over x into y, compiled as the core's kernels are; None without a compiler."""
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if compiler is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        source, thing, library = (Path(folder) / name for name in ("loops.c", "loops.o", "loops.so"))
        source.write_text(SOURCE, encoding="utf-8")
        flags = ["-O3", "-ffast-math", "-fPIC", "-march=native", "-mprefer-vector-width=512"]
        try:
            # fast-math not at the link: it would flush denormals for the whole process
            subprocess.run(
                [compiler, *flags, "-c", str(source), "-o", str(thing)], check=True, capture_output=True, timeout=60
            )
            link = [compiler, "-shared", str(thing), "-o", str(library), "-lm"]
            if subprocess.run([*link, "-lmvec"], check=False, capture_output=True, timeout=60).returncode:
                subprocess.run(link, check=True, capture_output=True, timeout=60)
            loaded = ctypes.CDLL(str(library))
        except (OSError, subprocess.SubprocessError):
            return None
    out: dict[str, Callable[[int], object]] = {}
    for kind in KINDS:
        loop = getattr(loaded, f"loop_{kind}")
        pointers = [ctypes.c_void_p(array.ctypes.data) for array in (x, y)]
        out[kind] = partial(_call, loop, pointers, x.size)
    return out


def _call(loop: Callable[..., object], pointers: list[ctypes.c_void_p], size: int, times: int) -> object:
    return loop(size, times, *pointers)
