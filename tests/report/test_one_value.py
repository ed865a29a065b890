"""No report shows two values for one number: every torque and power that its sentences, tables, captions and pictures tell is one
of the summary's, to the digits shown.
"""

from __future__ import annotations

import html
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text

import trbdyn as trb
from trbdyn.results.numbers import TABLE, rows
from trbdyn.run.torque_laws import torque_laws

TOLD = re.compile(r"(?<![\w.])(\d[\d.]*(?:e[+-]?\d+)?) (N m|W)\b")
SPLITS = ("torque_split", "power_split")


def scenes() -> dict[str, Any]:
    catalogue = {"bore": 0.05, "outside": 0.09, "width": 0.02, "C": 73.5e3, "C0": 69.5e3, "F": 0.0595}
    nu = trb.Bearing.from_catalogue(**catalogue, flanges="NU", name="NU 210")
    return {
        "30310": trb.cases.scene_30310(3000.0, 4930.0, radial_load=4000.0),
        "NU 210": trb.Scene(nu, speed_rpm=2000.0, radial_load=7000.0),
        "pair": trb.load_assembly("pair_30310"),
    }


@pytest.fixture(scope="module", params=["30310", "NU 210", "pair"])
def result(request: pytest.FixtureRequest) -> Any:
    return trb.Simulation(scenes()[request.param], accuracy="fast").run(revolutions=1.5)


def values_of(numbers: Mapping[str, Any]) -> Iterator[float]:
    """All torques and powers of a summary, those of its tables and half widths among them."""
    widths = numbers.get("confidence", {})
    for row in rows():
        if row.unit in ("N m", "W") and row.name in numbers:
            value = numbers[row.name]
            yield from value.values() if isinstance(value, Mapping) else [value, widths.get(row.name, 0.0)]


def is_one_of(text: str, known: list[float]) -> bool:
    """Whether a number as it is written is one of some others, to its digits."""
    digits, _, power = text.partition("e")
    step = 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))
    return any(abs(float(text) - abs(value)) <= 0.5001 * step for value in known)


def test_every_torque_and_power_of_a_report_is_that_of_the_summary(
    result: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[str] = []

    def read(draw: Any, dpi: int = 110) -> str:
        picture = draw()
        figure = picture if isinstance(picture, Figure) else picture.get_figure(root=True)
        drawn.extend(text.get_text() for text in figure.findobj(Text))
        plt.close(figure)
        return ""

    monkeypatch.setattr("trbdyn.reporting.page.image", read)
    text = trb.report(result, tmp_path / "r.html", pictures=[*SPLITS, "energy_audit"]).read_text(encoding="utf-8")
    text = re.sub(r"<details><summary>All inputs.*?</details>", "", text, flags=re.DOTALL)
    plain = " ".join(html.unescape(re.sub(r"<[^>]*>", " ", text)).split())
    known = [value for part in result.parts for value in values_of(part.summary())]
    known += [value for name, value in result.numbers().items() if name in ("torque", "power_loss")]
    # of one bearing: what other laws of rolling resistance make of its torque
    laws = [torque_laws(part.scene) for part in result.parts]
    bands = [law.words(*2 * [part.summary()["torque"]]) for law, part in zip(laws, result.parts, strict=True) if law]
    said = [one for one in TOLD.findall(plain) if not any(one[0] in band for band in bands)]
    assert len(said) > 8 * len(result.parts)
    for number, unit in said + TOLD.findall(" \n ".join(drawn)):
        assert is_one_of(number, known), (number, unit)
    for part in result.parts:
        torque = part.summary()["torque"]
        assert f"{torque:.4g} N m in all" in " ".join(drawn)
        assert f"friction torque of the shaft: {torque:.4g} N m" in plain
        assert f"{part.summary()['power_loss']:.4g} W in all" in " ".join(drawn)


def test_parts_of_a_torque_and_a_loss_add_up(result: Any) -> None:
    for part in result.parts:
        numbers = part.summary()
        assert sum(numbers["torque_by_loss"].values()) == pytest.approx(numbers["torque"], rel=1e-9)
        assert sum(numbers["torque_split"].values()) == pytest.approx(numbers["torque"], rel=1e-9)
        assert sum(numbers["power_split"].values()) == pytest.approx(numbers["power_loss"], rel=1e-9)


def test_rows_that_pictures_tell_are_of_one_stretch() -> None:
    for name in {picture for row in TABLE.values() for picture in row.pictures}:
        assert len({row.of for row in TABLE.values() if name in row.pictures}) == 1, name


@pytest.mark.usefixtures("drawn_only")
def test_a_pair_has_a_verdict_and_a_total_and_is_compared(tmp_path: Path) -> None:
    pair = trb.load_assembly("pair_30310")
    runs = [
        trb.Simulation(pair.replace(speed_rpm=speed), accuracy="fast").run(revolutions=0.2)
        for speed in (2000.0, 2200.0)
    ]
    path = trb.report(runs[0], tmp_path / "r.html", other=runs[1], names=["slow", "fast"], pictures=[])
    text = path.read_text(encoding="utf-8")
    assert "Verdict of the shaft of slow" in text
    total = runs[0].numbers()["torque"]
    assert total == pytest.approx(sum(one.summary()["torque"] for one in runs[0].parts))
    assert f"{total:.3g} N m of friction in all" in text
    assert "fast against slow" in text
    assert f"<td class='n number'>{total:.5g}</td>" in text
    with pytest.raises(trb.InputError, match="must be a run of the same bearings, left, right"):
        trb.report(runs[0], tmp_path / "b.html", other=runs[0]["left"])
    data = runs[0].to_xarray()
    assert data["left_cage_position"].dims == ("time", "xyz")
    assert data["right_outer_load"].dims == ("time", "right_roller")
    assert data.attrs["torque"] == pytest.approx(total)
    assert data.attrs["left_torque"] == runs[0]["left"].summary()["torque"]
