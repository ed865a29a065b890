"""``python benchmarks/validation``: from any folder."""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
BENCHMARKS = HERE.parents[0]

# Python puts this folder first, whose modules are those of a package; the package is found from the folder above it
sys.path[:] = [str(BENCHMARKS), *(place for place in sys.path if Path(place).resolve() != HERE)]

from validation.command import main  # noqa: E402

if __name__ == "__main__":
    sys.exit(main())
