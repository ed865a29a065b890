"""Which files of csrc one right-hand side passes through for a plain scene of one bearing, with the functions of each.

Needs gcc with gcov, and what `make install` builds. The sources are compiled once more with --coverage and the plain kernels,
csrc/tests/walk.c is run, and functions that it enters are listed. Sources (.c) are counted; headers have laws, vectors, surfaces.
"""

import gzip
import json
import re
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CSRC, BUILD = ROOT / "csrc", ROOT / "build" / "package"
FOLDERS = ("base", "laws", "bearing", "body", "contact", "system", "motion")


def compiled(folder: Path) -> list[str]:
    """Objects of the sources, with coverage."""
    kernels = sorted(CSRC.glob("contact/*_kernel.c"))
    sources = [(file, "scalar") for name in FOLDERS for file in sorted((CSRC / name).glob("*.c"))]
    sources += [(file, "base") for file in kernels] + [(CSRC / "tests" / "walk.c", "scalar")]
    objects = []
    for file, variant in sources:
        out = f"{file.parent.name}_{file.stem}_{variant}.o"
        flags = [
            f"-I{CSRC}",
            f"-I{CSRC / 'tests'}",
            f"-DTRB_KERNEL_VARIANT={variant}",
            "-std=gnu11",
            "-O0",
            "--coverage",
        ]
        headers = BUILD / "sundials_wheel" / "include"
        flags += ["-isystem", str(headers), "-DTRB_SUNDIALS_CVODES=1"] if headers.is_dir() else []
        subprocess.run(["gcc", *flags, "-c", str(file), "-o", out], cwd=folder, check=True)
        objects.append(out)
    return objects


def libraries() -> list[str]:
    """What a test is linked with; our objects come before."""
    text = (BUILD / "build.ninja").read_text(encoding="utf-8")
    found = re.search(r"\nbuild tests/test_motion:.*?LINK_LIBRARIES = ([^\n]*)", text, re.S)
    assert found is not None
    return [str(BUILD / word) if word.endswith((".a", ".so")) else word for word in found.group(1).split()]


def entered(folder: Path) -> dict[str, list[tuple[str, int]]]:
    """Functions that were entered, with how often, by file."""
    subprocess.run(
        ["gcov", "--json-format", *map(str, folder.glob("*.gcno"))], cwd=folder, check=True, capture_output=True
    )
    calls: dict[tuple[str, str], int] = defaultdict(int)
    for report in folder.glob("*.gcov.json.gz"):
        for file in json.loads(gzip.decompress(report.read_bytes()))["files"]:
            name = file["file"].removeprefix(f"{CSRC}/")
            for function in file["functions"] if not name.startswith(("/", "tests/")) else ():
                calls[name, function["name"]] += function["execution_count"]
    files = defaultdict(list)
    for (name, function), count in sorted(calls.items()):
        if count:
            files[name].append((function, count))
    return files


def main() -> int:
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        subprocess.run(["gcc", "--coverage", *compiled(folder), *libraries(), "-o", "walk"], cwd=folder, check=True)
        subprocess.run(["./walk"], cwd=folder, check=True)
        files = entered(folder)
    for name, functions in files.items():
        print(name, *(f"{function} ({count})" for function, count in functions), sep="\n    ")
    print(f"{sum(name.endswith('.c') for name in files)} sources, {len(files)} files with headers")
    return 0


if __name__ == "__main__":
    sys.exit(main())
