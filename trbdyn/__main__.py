"""``python -m trbdyn``."""

from __future__ import annotations

import sys

from trbdyn.cli import main

if __name__ == "__main__":
    sys.exit(main())
