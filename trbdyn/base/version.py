"""The version of the installed package."""

from __future__ import annotations

import importlib.metadata

try:
    __version__ = importlib.metadata.version("trbdyn")
except importlib.metadata.PackageNotFoundError:
    __version__ = "0+unknown"
