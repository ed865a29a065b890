"""``python -m trbdyn.paper.sensitivity``."""

import sys

from trbdyn.paper.sensitivity.command import main

if __name__ == "__main__":
    sys.exit(main())
