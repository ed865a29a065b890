"""Print requirements out of pyproject.toml, one a line: `requirements.py build dependencies EXTRA...`."""

import sys
import tomllib
from pathlib import Path

table = tomllib.loads((Path(__file__).parent.parent / "pyproject.toml").read_text(encoding="utf-8"))
lists = {
    "build": [*table["build-system"]["requires"], "cmake>=3.26", "ninja"],
    "dependencies": table["project"]["dependencies"],
    **table["project"]["optional-dependencies"],
}
for name in sys.argv[1:]:
    print(*lists[name], sep="\n")
