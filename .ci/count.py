"""How many lines the sources in Python and C have, by folder: of the files that git knows.

Lines are counted as they are, with comments and empty ones.
"""

import subprocess
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ENDINGS = (".py", ".c", ".h")
PARTS = {
    "csrc, without tests": ("csrc/", "csrc/tests/"),
    "csrc/tests": ("csrc/tests/", None),
    "trbdyn": ("trbdyn/", None),
    "tests": ("tests/", None),
    "benchmarks": ("benchmarks/", None),
    ".ci": (".ci/", None),
}


def lines_by_file() -> dict[str, int]:
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    names = [name for name in listed.split("\0") if name.endswith(ENDINGS) and (ROOT / name).is_file()]
    return {name: len((ROOT / name).read_bytes().splitlines()) for name in names}


def main() -> int:
    counted = lines_by_file()
    print(f"{'lines':>7} {'files':>6}  folder")
    total = 0
    for part, (folder, without) in PARTS.items():
        own = {
            name: n
            for name, n in counted.items()
            if name.startswith(folder) and not (without and name.startswith(without))
        }
        total += sum(own.values())
        print(f"{sum(own.values()):7d} {len(own):6d}  {part}")
        below: Counter[str] = Counter()
        for name, n in own.items():
            below["/".join(name.removeprefix(folder).split("/")[:-1][:1])] += n
        for name, n in sorted(below.items()) if part in ("csrc, without tests", "trbdyn") else ():
            print(f"{n:14d}    {name or 'files'}")
    print(f"{total:7d} {len(counted):6d}  in all")
    return 0


if __name__ == "__main__":
    sys.exit(main())
