"""Small faults: one changed operator, number, component, name or function of a source, or one statement taken away."""

from __future__ import annotations

import ast
import functools
import hashlib
import io
import re
import tokenize
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

AREAS: dict[str, tuple[float, list[str]]] = {
    "laws": (0.14, ["csrc/laws/*.[ch]"]),
    "contacts": (0.19, ["csrc/surface/*.[ch]", "csrc/contact/*.[ch]"]),
    "records": (0.10, ["csrc/motion/record.c", "csrc/motion/shown.c", "csrc/motion/peak*.c"]),
    "motion": (
        0.13,
        ["csrc/bearing/*.[ch]", "csrc/motion/[def]*.c", "csrc/motion/r[hi]*.c", "csrc/motion/bound.[ch]"],
    ),
    "stepping": (0.15, ["csrc/stepping/*.c"]),
    "results": (
        0.14,
        [
            "trbdyn/results/observables/*.py",
            "trbdyn/plot/*.py",
            "trbdyn/results/derived.py",
            "trbdyn/results/summary.py",
            "trbdyn/results/rows/*.py",
            "trbdyn/results/result.py",
            "trbdyn/results/records.py",
            "trbdyn/results/peaks.py",
        ],
    ),
    "model": (
        0.09,
        [
            "trbdyn/model/bearing.py",
            "trbdyn/model/cage.py",
            "trbdyn/model/ribs.py",
            "trbdyn/model/roller.py",
            "trbdyn/model/pocket*.py",
            "trbdyn/model/lubricants/*.py",
            "trbdyn/model/effects.py",
            "trbdyn/model/start.py",
            "trbdyn/model/rotating_load.py",
            "trbdyn/model/scene.py",
            "trbdyn/model/flatten.py",
            "trbdyn/model/geometry.py",
            "trbdyn/model/motion.py",
            "trbdyn/statics/equilibrium.py",
            "trbdyn/statics/ring_motion.py",
            "trbdyn/statics/start.py",
        ],
    ),
    "runs": (
        0.06,
        [
            "trbdyn/run/running.py",
            "trbdyn/run/checkpoint.py",
            "trbdyn/results/file_source.py",
            "trbdyn/run/simulation.py",
        ],
    ),
}
"""Share of the faults, and sources, of each area."""

SWAPS = {
    "+": "-", "-": "+", "*": "/", "/": "*", "<": ">=", ">": "<=", "<=": ">", ">=": "<", "==": "!=", "!=": "==",
    "&&": "||", "||": "&&", "+=": "-=", "-=": "+=", "and": "or", "or": "and", "min": "max", "max": "min",
    "trb_min": "trb_max", "trb_max": "trb_min", "fmin": "fmax", "fmax": "fmin", "cos": "sin", "sin": "cos", "cosine": "sine",
    "sine": "cosine", "trb_add": "trb_sub", "trb_sub": "trb_add", "mean": "max", "argmin": "argmax", "argmax": "argmin",
    ".x": ".y", ".y": ".z", ".z": ".x", "inner": "outer", "outer": "inner", "TRB_RACE_OUTER": "TRB_RACE_INNER",
    "TRB_RACE_INNER": "TRB_RACE_OUTER", "True": "False", "False": "True",
}  # fmt: skip
C_TOKEN = re.compile(
    r"(?P<skip>/\*.*?\*/|//[^\n]*|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'|^[ \t]*#[^\n]*(?:\\\n[^\n]*)*)"
    r"|(?P<number>(?<![\w.])\d+\.\d*(?:e[+-]?\d+)?)|(?P<word>\.[xyz]\b|[A-Za-z_]\w*)"
    r"|(?P<sign>->|\+\+|--|[-+*/&|=<>!]=|&&|\|\||<<|>>|[-+*/<>])",
    re.S | re.M,
)
CALL = re.compile(r"^[ \t]+[\w.\->\[\]]+(?: = | \+= | -= |\()[^;{}=]*;$", re.M)


LOOKS = re.compile(
    r"linewidth|alpha|canvas\(|figsize|fontsize|pad=|zorder|ncols|markersize|shrink|margins|xytext|height=|offset"
)
"""Lines that say how a picture looks, not what it shows."""


@dataclass(frozen=True)
class Fault:
    """One change of one source."""

    area: str
    file: str
    place: int
    old: str
    new: str
    line: int
    text: str
    """The line of the source that holds it."""
    column: int
    """Where in that line it begins."""
    nth: int
    """Which one of the lines of this text in the source."""
    source: str
    """Hash of the source without the fault."""

    @property
    def key(self) -> str:
        """Changes with the source, so that an outcome of another source is not taken for this one's."""
        words = (self.file, self.source, self.place, self.old, self.new)
        return hashlib.sha256(repr(words).encode()).hexdigest()[:16]

    def lot(self, seed: int) -> str:
        """Its place in the order of a seed."""
        words = (seed, self.file, self.text, self.column, self.nth, self.old, self.new)
        return hashlib.sha256(repr(words).encode()).hexdigest()

    def applied(self, text: str) -> str:
        if not text.startswith(self.old, self.place):
            raise ValueError(f"{self.file} is not the source that this fault was drawn from")
        return text[: self.place] + self.new + text[self.place + len(self.old) :]

    def __str__(self) -> str:
        old, new = " ".join(self.old.split()), " ".join(self.new.split())
        return f"{self.file}:{self.line}:{self.column}: {old!r} -> {new!r} in {self.text!r}"


def changed_number(text: str) -> str:
    value = float(text)
    return "1.0" if value == 0.0 else repr(value * 1.5)


def faults_of_c(text: str) -> Iterator[tuple[int, str, str]]:
    skipped: list[tuple[int, int]] = []
    for found in C_TOKEN.finditer(text):
        old, before = found.group(), text[: found.start()].rstrip()[-1:]
        if found.lastgroup == "skip":
            skipped.append(found.span())
        elif found.lastgroup == "number":
            yield found.start(), old, changed_number(old)
        elif old in SWAPS and not (old in ("-", "+", "*") and not (before.isalnum() or before in ")]_")):
            declares = old == "*" and re.search(
                r"(?:\*|const|\w_\w+|double|int|char|void|trb_\w+)\s*$", text[: found.start()]
            )
            if not declares:
                yield found.start(), old, SWAPS[old]
    for found in CALL.finditer(text):
        inside = any(start <= found.start() < end for start, end in skipped)
        if not inside and not re.match(r"\s*(return|const|double|int|static)\b", found.group()):
            yield found.start(), found.group(), ";" if "free" not in found.group().lower() else found.group()


def faults_of_python(text: str) -> Iterator[tuple[int, str, str]]:
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    tokens = list(tokenize.generate_tokens(io.StringIO(text).readline))
    signature = 0
    for place, token in enumerate(tokens):
        before = tokens[place - 1] if place else token
        if token.string in ("def", "class", "import", "from", "@"):
            signature = token.end[0]
        if token.start[0] == signature or token.line.lstrip().startswith(("def ", "from ", "import ", "@", "class ")):
            continue
        if LOOKS.search(token.line):
            continue
        at = starts[token.start[0] - 1] + token.start[1]
        binary = before.type in (tokenize.NAME, tokenize.NUMBER) or before.string in (")", "]")
        if token.type == tokenize.NUMBER and "." in token.string:
            yield at, token.string, changed_number(token.string)
        elif token.type == tokenize.NUMBER and before.string in ("[", ":") and token.string in ("0", "1", "2"):
            yield at, token.string, {"0": "1", "1": "0", "2": "1"}[token.string]
        elif (
            token.type == tokenize.OP
            and token.string in SWAPS
            and binary
            and before.string not in ("lambda", "return", "in")
        ):
            if "->" not in token.line and not re.search(r"\*\*?\w+[,)]", token.line):
                yield at, token.string, SWAPS[token.string]
        elif (
            token.type == tokenize.NAME
            and token.string in SWAPS
            and tokens[place + 1].string in ("(", " ", "not", "or", "and")
        ) or (token.type == tokenize.NAME and token.string in ("True", "False", "and", "or")):
            yield at, token.string, SWAPS[token.string]


def statements_of_python(text: str) -> Iterator[tuple[int, str, str]]:
    """Calls for their effect, and sums, taken away."""
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line.encode()))
    raw = text.encode()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.AugAssign) or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)):
            assert node.end_lineno is not None
            assert node.end_col_offset is not None
            begin, end = starts[node.lineno - 1] + node.col_offset, starts[node.end_lineno - 1] + node.end_col_offset
            old = raw[begin:end].decode()
            if not LOOKS.search(old):
                yield len(raw[:begin].decode()), old, "pass"


def faults_of(file: Path, area: str) -> list[Fault]:
    """All faults that one source can get."""
    text, name = file.read_text(encoding="utf-8"), str(file.relative_to(ROOT))
    source = hashlib.sha256(text.encode()).hexdigest()[:16]
    if file.suffix == ".py":
        found = [*faults_of_python(text), *statements_of_python(text)]
    else:
        found = list(faults_of_c(text))
    seen: Counter[str] = Counter()
    nths = []
    for line in text.split("\n"):
        seen[line.strip()] += 1
        nths.append(seen[line.strip()])
    made = []
    for at, old, new in found:
        begin = at + len(old) - len(old.lstrip())
        start = text.rfind("\n", 0, begin) + 1
        end = text.find("\n", begin)
        line = text[start : end if end >= 0 else len(text)]
        column = begin - start - (len(line) - len(line.lstrip()))
        if old != new:
            number = text.count("\n", 0, begin) + 1
            made.append(Fault(area, name, at, old, new, number, line.strip(), column, nths[number - 1], source))
    return made


@functools.cache
def draw(seed: int, only: str | None = None) -> list[Fault]:
    """All faults in the order of a seed, areas mixed by their shares: a run takes as many of the first ones as it is told to."""
    drawn: list[tuple[float, Fault]] = []
    for area, (share, patterns) in AREAS.items():
        files = sorted({path for pattern in patterns for path in ROOT.glob(pattern)})
        places = [fault for file in files for fault in faults_of(file, area)]
        # by what a fault is, not by where: a change of a source leaves the others' faults drawn as they were
        places.sort(key=lambda fault: fault.lot(seed))
        drawn += [((number + 0.5) / share, fault) for number, fault in enumerate(places)]
    drawn.sort(key=lambda pair: (pair[0], pair[1].key))
    return [fault for _, fault in drawn if only in (None, fault.area)]
