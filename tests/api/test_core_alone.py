"""The core for C programs (csrc/api): what it repeats of the package is as the package has it."""

from __future__ import annotations

import re
from pathlib import Path

import standard_case

from trbdyn.run.options import ACCURACY, IMPACT_SHARE, RINGS_SHARE

API = Path(__file__).resolve().parents[2] / "csrc" / "api"


def test_the_standard_case_has_the_numbers_of_the_package() -> None:
    """If not: python .ci/standard_case.py --write"""
    assert standard_case.FILE.read_text(encoding="utf-8") == standard_case.text()


def test_presets_are_those_of_the_package() -> None:
    rows = re.findall(r'\{"(\w+)", ([^}]*)\}', (API / "run.c").read_text(encoding="utf-8"))
    found = {name: [float(number) for number in numbers.split(",")] for name, numbers in rows}
    assert found == {
        name: [*one.model_dump().values(), RINGS_SHARE[name], IMPACT_SHARE[name]] for name, one in ACCURACY.items()
    }
