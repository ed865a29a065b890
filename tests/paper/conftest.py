"""The paper's reproduction is a package in benchmarks/, which a source distribution has not."""

from __future__ import annotations

import importlib.util

if importlib.util.find_spec("paper") is None:
    collect_ignore_glob = ["test_*.py"]
