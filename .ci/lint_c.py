"""Rules of the C sources that no compiler checks. Prints each breach as file:line: text and exits with 1 if there is one.

Sources: includes point one way (ORDER), and no units include each other in a circle, where a unit is a header with the source
file of its name; SUNDIALS and Python headers stay where they belong, nothing prints, exits or aborts, and what
moves and steps a system names none of its bodies (NAMED).
Objects (with --objects BUILD): exported symbols start with trb_, the core keeps no writable globals, the extension module shows
nothing but its init function.
"""

import argparse
import re
import subprocess
import sys
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CSRC = ROOT / "csrc"
ORDER = ["base", "laws", "surface", "bearing", "body", "contact", "system", "motion", "stepping", "api", "python"]
SUNDIALS_HEADERS = re.compile(r"(sundials|cvodes?|arkode|kinsol|idas?|nvector|sunmatrix|sunlinsol|sunnonlinsol)/")
CALLS = "v?f?printf|f?puts|putchar|perror|exit|_Exit|_exit|quick_exit|abort|system"
FORBIDDEN = re.compile(rf"\b((?:{CALLS})\s*\(|(?:stdout|stderr)\b)")
# motion/ and stepping/ loop over the bodies and pairs of a system. The table of recorded quantities names those that files show;
# the kinematic orbit is a number of the geometry, and a speed that is prescribed has the name that users know.
NUMBER = r"(?-i:\bTRB_(?:BODY|PAIR)_\w+)"
NAMED = re.compile(rf"\b\w*(?:cage|inner|outer)\w*\b|{NUMBER}", re.I)
MAY_NAME = {"motion/fields.h": "", "motion/shown.c": NUMBER}  # what these must not name all the same
MAY_BE_NAMED = {"cage_speed_ratio", "TRB_CHANNEL_outer_speed"}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.M)
# comments, strings, characters
NOT_CODE = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.S)


def code_only(text: str) -> str:
    """The text with comments, strings and characters blanked out, lines kept."""
    return NOT_CODE.sub(lambda found: re.sub(r"[^\n]", " ", found.group()), text)


def may_include_sundials(path: str) -> bool:
    return path.startswith("stepping/") or path == "motion/equilibrium.c"


def check_includes(path: str, text: str) -> list[tuple[int, str]]:
    found = []
    folder = path.split("/")[0]
    commented = re.sub(r"/\*.*?\*/", lambda comment: re.sub(r"[^\n]", " ", comment.group()), text, flags=re.S)
    for match in INCLUDE.finditer(commented):
        line = text.count("\n", 0, match.start()) + 1
        quote, header = match.groups()
        if SUNDIALS_HEADERS.match(header):
            if not may_include_sundials(path):
                found.append((line, f"{header}: SUNDIALS belongs to stepping/ and motion/equilibrium.c"))
        elif header == "Python.h" or header.startswith("numpy/"):
            if folder != "python":
                found.append((line, f"{header}: Python belongs to python/"))
        elif quote == '"' and folder in ORDER:
            if not (CSRC / header).is_file():
                found.append((line, f"{header}: write included paths from csrc/ on"))
            elif "/" in header:
                other = header.split("/")[0]
                if other not in ORDER or ORDER.index(other) > ORDER.index(folder):
                    found.append((line, f"{header}: {folder}/ must not include {other}/ ({' <- '.join(ORDER)})"))
    return found


def circle_of_units() -> list[str]:
    """Units that include each other in a circle, as a line of text; nothing if there is none."""
    units: dict[str, set[str]] = {}
    for file in CSRC.glob("*/*.[ch]"):
        unit = file.relative_to(CSRC).with_suffix("").as_posix()
        headers = {header.removesuffix(".h") for _, header in INCLUDE.findall(file.read_text(encoding="utf-8"))}
        units.setdefault(unit, set()).update(headers - {unit})
    try:
        TopologicalSorter(units).prepare()
    except CycleError as error:
        return [f"csrc: includes run in a circle: {' -> '.join(error.args[1][::-1])}"]
    return []


def check_sources() -> list[str]:
    breaches = circle_of_units()
    for file in sorted([*CSRC.glob("*/*.[ch]"), *CSRC.glob("*.h")]):
        path = file.relative_to(CSRC).as_posix()
        if path.startswith(("tests/", "cmake/")):
            continue
        text = file.read_text(encoding="utf-8")
        found = check_includes(path, text)
        code = code_only(text)
        for match in FORBIDDEN.finditer(code):
            line = code.count("\n", 0, match.start()) + 1
            found.append(
                (line, f"{match.group(1).rstrip('( ')}: the core reports through trb_message and status codes")
            )
        if path.startswith(("motion/", "stepping/")) and MAY_NAME.get(path) != "":
            for match in re.finditer(MAY_NAME.get(path, NAMED), code):
                if match.group() not in MAY_BE_NAMED:
                    line = code.count("\n", 0, match.start()) + 1
                    found.append((line, f"{match.group()}: motion/ and stepping/ name no body of a system"))
        if path.endswith(".h") and "#ifndef TRB_" not in text and "#pragma once" not in text:
            found.append((1, "no include guard TRB_..."))
        breaches += [f"csrc/{path}:{line}: {text}" for line, text in sorted(found)]
    return breaches


def run(*command: str | Path) -> list[str]:
    return subprocess.run(
        [str(word) for word in command], check=True, capture_output=True, text=True
    ).stdout.splitlines()


def check_objects(build: Path) -> list[str]:
    objects = [
        file
        for file in sorted(build.rglob("*.o"))
        if re.search(r"CMakeFiles/(trbdyn_core|trb_kernel_\w+|_core|trbdyn)\.dir", str(file))
    ]
    if not objects:
        return [f"{build}: holds no object files; build first"]
    breaches = []
    for file in objects:
        name = str(file.relative_to(build)).split(".dir/")[1].removesuffix(".o")
        if not (CSRC / name).is_file():
            continue  # left over from a source that is gone
        for line in run("nm", "--extern-only", "--defined-only", file):
            symbol = line.split()[-1]
            if not symbol.startswith(("trb_", "PyInit_")):
                breaches.append(f"csrc/{name}: symbol {symbol} does not start with trb_")
        if not name.startswith("python/"):
            for line in run("objdump", "--syms", file):
                match = re.search(r"\bO\s+(\.(?:data|bss|tbss|tdata)\S*)\s+\S+\s+(?:\.hidden\s+)?(\S+)$", line)
                if match and not match.group(1).startswith(".data.rel.ro"):
                    breaches.append(f"csrc/{name}: {match.group(2)} is a writable global ({match.group(1)})")
    for module in build.glob("_core*.so"):
        symbols = [line.split()[-1] for line in run("nm", "--dynamic", "--defined-only", module)]
        breaches += [f"{module.name}: shows {symbol}" for symbol in symbols if symbol != "PyInit__core"]
        missing = [line.split()[-1] for line in run("nm", "--dynamic", "--undefined-only", module)]
        breaches += [f"{module.name}: {symbol} is defined nowhere" for symbol in missing if symbol.startswith("trb_")]
        if any("crtfastmath" in line or line.endswith(" set_fast_math") for line in run("nm", module)):
            breaches.append(f"{module.name}: -ffast-math reached the link: the process would flush denormals to zero")
    return breaches


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--objects", type=Path, metavar="BUILD", help="build folder whose object files to check too")
    options = parser.parse_args()
    breaches = check_sources() + (check_objects(options.objects) if options.objects else [])
    for breach in breaches:
        print(breach, file=sys.stderr)
    print(f"C rules: {len(breaches)} breach(es)" if breaches else "C rules: kept")
    return bool(breaches)


if __name__ == "__main__":
    sys.exit(main())
