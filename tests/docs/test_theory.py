"""The theory belongs to the code: every pointer of the sources leads to a heading of docs/theory, every equation that the
sources cite stands there, and the constants of the equations are those that the core computes with.
"""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest

from trbdyn import laws

ROOT = Path(__file__).resolve().parents[2]
THEORY = ROOT / "docs" / "theory"
pytestmark = pytest.mark.skipif(not THEORY.is_dir(), reason="the documentation is not part of a source distribution")

PAGES = sorted(THEORY.glob("*.md")) if THEORY.is_dir() else []
SOURCES = sorted(
    path
    for folder, kinds in (("csrc", ("*.c", "*.h")), ("trbdyn", ("*.py",)))
    for kind in kinds
    for path in (ROOT / folder).rglob(kind)
)
POINTER = re.compile(r"docs/theory/(\w+)\.md(?:#([\w-]+))?")
TAG = re.compile(r"\\tag\{(\w+)\}")
PAPER = range(1, 14)
# in sources: "(4)", "(7)-(9)" at the start of a comment or of a law's text, and "eq. 12", "eqs. 2, 6 and 10"
LEADING = re.compile(r'(?:/\* |\* |"|and |, )\((\d{1,2})\)(?:-\((\d{1,2})\))?')
WRITTEN = re.compile(r"\beqs?\.? (\d{1,2}(?!\.?\d)(?:(?:, | and |-)\d{1,2}(?!\.?\d))*)")


def name(path: Path) -> str:
    return str(path.relative_to(ROOT))


def anchors(page: Path) -> set[str]:
    """Anchors of a page's headings, as MyST and GitHub make them."""
    text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    headings = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def pointers(text: str) -> list[tuple[str, str]]:
    return POINTER.findall(text)


def cited(text: str) -> set[int]:
    """Numbers of the paper's equations that a source cites."""
    found: set[int] = set()
    for first, last in LEADING.findall(text):
        found |= set(range(int(first), int(last or first) + 1))
    for numbers in WRITTEN.findall(text):
        found |= {int(number) for number in re.findall(r"\d+", numbers)}
    return found


def test_pointers_of_the_sources_lead_to_headings() -> None:
    known = {page.stem: anchors(page) for page in PAGES}
    seen = 0
    for path in SOURCES:
        for page, anchor in pointers(path.read_text(encoding="utf-8")):
            seen += 1
            assert page in known, f"{name(path)}: docs/theory/{page}.md does not exist"
            assert not anchor or anchor in known[page], f"{name(path)}: docs/theory/{page}.md has no #{anchor}"
    assert seen > 40


def test_pointers_that_lead_nowhere_would_be_found() -> None:
    assert pointers("(docs/theory/motion.md#eulers-equations)") == [("motion", "eulers-equations")]
    assert "eulers-equations" in anchors(THEORY / "motion.md")
    assert "laplaces-equations" not in anchors(THEORY / "motion.md")
    assert cited("/* (7)-(9) x */ /* the paper's eq. 12 */ eqs. 2, 6 and 10. eqs. 4.26-4.28") == {2, 6, 7, 8, 9, 10, 12}


def test_no_pointer_leaves_the_repository() -> None:
    for path in SOURCES:
        assert not re.search(r"\bphysics(\.md|: section)", path.read_text(encoding="utf-8")), name(path)


@pytest.mark.parametrize("folder", ["laws", "body", "contact", "motion", "stepping", "bearing"])
def test_every_folder_of_the_core_points_to_the_theory(folder: str) -> None:
    assert any(pointers(path.read_text(encoding="utf-8")) for path in (ROOT / "csrc" / folder).iterdir())


def test_every_law_has_its_place() -> None:
    headers = [path for path in (ROOT / "csrc" / "laws").glob("*.h") if path.stem not in ("smooth", "table")]
    assert len(headers) > 6
    for path in headers:
        assert pointers(path.read_text(encoding="utf-8")), f"{name(path)} points to no page of the theory"


def test_equations_that_the_sources_cite_stand_in_the_theory() -> None:
    tags = [tag for page in PAGES for tag in TAG.findall(page.read_text(encoding="utf-8"))]
    assert len(tags) == len(set(tags)), "an equation number stands twice"
    assert {str(number) for number in PAPER} <= set(tags)
    everything: set[int] = set()
    for path in SOURCES:
        if "tests" in path.parts:
            continue
        numbers = cited(path.read_text(encoding="utf-8")) & set(PAPER)
        missing = {str(number) for number in numbers} - set(tags)
        assert not missing, f"{name(path)} cites {missing}"
        everything |= numbers
    assert everything == set(PAPER), "equations of the paper that no source cites"


def equation(tag: str) -> str:
    """The formula with this number."""
    for page in PAGES:
        for formula in re.findall(r"\$\$(.*?)\$\$", page.read_text(encoding="utf-8"), re.DOTALL):
            if f"\\tag{{{tag}}}" in formula:
                return formula
    raise AssertionError(tag)


def slope(law: str, arguments: dict[str, float], of: str, by: float = 1e-4) -> float:
    """Exponent of an argument in a law that is a product of powers."""
    here, there = ({**arguments, of: arguments[of] * factor} for factor in (1.0, 1.0 + by))
    function = getattr(laws, law)
    return math.log(float(function(**there)) / float(function(**here))) / math.log1p(by)


@pytest.mark.parametrize(
    ("tag", "law", "symbols"),
    [
        ("4", "film_line_elastic", {"W": 7e-5, "U": 1.6e-10, "G": 4460.0}),
        ("12", "film_point_elastic", {"W": 7e-6, "U": 1.6e-11, "G": 4460.0, "radius_ratio": 0.1}),
    ],
)
def test_exponents_are_those_of_the_core(tag: str, law: str, symbols: dict[str, float]) -> None:
    formula = equation(tag)
    for symbol in ("W", "U", "G"):
        written = re.search(rf"{symbol}\^\{{(-?[\d.]+)\}}", formula)
        assert written is not None
        assert slope(law, symbols, symbol) == pytest.approx(float(written.group(1)), rel=1e-6)


@pytest.mark.parametrize(
    ("tag", "constants", "found"),
    [
        ("1", "0.356", lambda: float(laws.line_load(1e-6, 1e9, 1.0)) / (1e9 * 1e-6 ** (10 / 9))),
        ("4", "2.922", lambda: float(laws.film_line_elastic(1.0, 1.0, 1.0))),
        ("5", "4.9", lambda: float(laws.film_line_rigid(1.0, 1.0))),
        ("12", "4.31", lambda: float(laws.film_point_elastic(1.0, 1.0, 1.0, 1e6))),
        ("10", "29.2", lambda: float(laws.rolling_line(1.0, 1.0, 1.0))),
        ("6", "22.28", lambda: float(laws.friction_boundary(1e-9, 0.1, 22.28, 181.46)) / 1e-9 - 0.1 * 181.46),
    ],
)
def test_constants_are_those_of_the_core(tag: str, constants: str, found) -> None:  # type: ignore[no-untyped-def]
    assert constants in equation(tag)
    assert found() == pytest.approx(float(constants), rel=1e-6)
