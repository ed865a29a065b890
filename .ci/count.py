"""How many lines the sources in Python and C have, by folder: of the files that git knows.

Lines are counted as they are, with comments and empty ones. With ``--since REVISION`` a third column counts those of files
that came after that revision: the file was not there, and git finds none that it is a copy of.
"""

import argparse
import subprocess
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
ENDINGS = (".py", ".c", ".h")
PARTS = {
    "csrc, without tests": ("csrc/", "csrc/tests/"),
    "csrc/tests": ("csrc/tests/", None),
    "trbdyn, the core": ("trbdyn/", "trbdyn/extras/"),
    "trbdyn/extras": ("trbdyn/extras/", None),
    "tests": ("tests/", None),
    "benchmarks": ("benchmarks/", None),
    ".ci": (".ci/", None),
}
BY_FOLDER = ("csrc, without tests", "trbdyn, the core", "trbdyn/extras")
"""Parts whose folders are told, too."""


def git(*words: str) -> list[str]:
    """What a command of git lists between zeros."""
    return subprocess.run(["git", *words], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\0")


def lines_by_file() -> dict[str, int]:
    names = [name for name in git("ls-files", "-z") if name.endswith(ENDINGS) and (ROOT / name).is_file()]
    return {name: len((ROOT / name).read_bytes().splitlines()) for name in names}


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    parser.add_argument("--since", metavar="REVISION", help="count lines of files that came after it apart")
    since = parser.parse_args().since
    counted = lines_by_file()
    came = set(git("diff", "-z", "--name-only", "--diff-filter=A", "-C40", "-l0", since, "HEAD")) if since else set()
    print(f"{'lines':>7} {'files':>6} {'new' if since else '':>6}  folder")
    total = 0
    for part, (folder, without) in PARTS.items():
        own = {
            name: n
            for name, n in counted.items()
            if name.startswith(folder) and not (without and name.startswith(without))
        }
        total += sum(own.values())
        new = sum(n for name, n in own.items() if name in came) if since else ""
        print(f"{sum(own.values()):7d} {len(own):6d} {new:>6}  {part}")
        below: Counter[str] = Counter()
        for name, n in own.items():
            below["/".join(name.removeprefix(folder).split("/")[:-1][:1])] += n
        for name, n in sorted(below.items()) if part in BY_FOLDER else ():
            print(f"{n:14d}    {name or 'files'}")
    print(f"{total:7d} {len(counted):6d} {'':>6}  in all")
    return 0


if __name__ == "__main__":
    sys.exit(main())
