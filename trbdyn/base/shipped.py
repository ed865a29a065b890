"""Where the files lie that ship with the package."""

from __future__ import annotations

from pathlib import Path
from typing import Final

DATA: Final = Path(__file__).parent.parent / "data"
"""Folder of cases, studies and measured tables."""
