"""The paper's reproduction is a package in benchmarks/, beside the installed one."""

from __future__ import annotations

import sys
from pathlib import Path

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"

if BENCHMARKS.is_dir():
    sys.path.insert(0, str(BENCHMARKS))
else:  # a source distribution has no benchmarks
    collect_ignore_glob = ["test_*.py"]
