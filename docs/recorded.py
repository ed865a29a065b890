"""Figures that commands gave: ``python docs/recorded.py demo`` makes those of one command again and puts them into pages.

`recorded.json` holds what each command gave, the revision of the core, and a mark of the defaults (`common.defaults_mark`). In a
page a figure is followed by a comment that names its record, ``1.859<!-- demo.torque -->``. A test says which figures differ from
their record, which figures of a table of measured values have none, and which records are older than today's defaults without
words of the page that say so. Pages of the benchmarks carry the same in the line ``Measured ..., revision ..., defaults ...``
above their tables; ``python docs/recorded.py --mark`` writes `OLDER` behind lines whose defaults are not those of today.
"""

from __future__ import annotations

import argparse
import datetime
import json
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "benchmarks"))
KEPT: Final = ROOT / "docs" / "recorded.json"
PAGES: Final = tuple(
    ROOT / name for name in ("README.md", "docs/validation.md", "docs/howto/cost.md") if (ROOT / name).exists()
)
"""Pages whose figures name their records."""
STAMPED: Final = tuple(
    ROOT / "benchmarks" / name
    for name in ("README.md", "paper/README.md", "paper/sensitivity.md", "paper/creep_map.md", "paper/beyond.md")
)
"""Pages whose tables carry a line of when they were measured. The logs of work are histories, and old by their nature."""
MEASURED: Final = "measured"
"""How heads of columns begin whose figures come from commands."""
OLDER: Final = "Older than today's defaults: effects, tolerances and integrator are those of then."

FIGURE: Final = re.compile(r"(-?\d+(?:\.\d+)?(?:e-?\d+)?)<!-- (\w+)\.([\w.]+) -->")
STAMP: Final = re.compile(r"^Measured \d{4}-\d\d-\d\d.*(?:\n(?!\n).+)*", re.MULTILINE)
MARK: Final = re.compile(r", defaults ([0-9a-f]{8})")

Record = dict[str, Any]


def demo() -> dict[str, float]:
    """What ``make demo`` writes."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "demo"
        command = [sys.executable, "-m", "trbdyn", "demo", "-o", str(place), "--quiet"]
        subprocess.run(command, check=True)
        return of_summary(json.loads((place / "summary.json").read_text(encoding="utf-8")))


def of_summary(summary: Mapping[str, Any]) -> dict[str, float]:
    """The numbers of a summary, and what follows from them."""
    found = {name: value for name, value in summary.items() if isinstance(value, int | float)}
    return {name: float(value) for name, value in found.items() if not isinstance(value, bool)}


CHANGES: Final[dict[str, dict[str, Any]]] = {
    "minimal": {"effects": "minimal"},
    "dry": {"effects.lubrication": "dry"},
    "without_rolling_resistance": {"effects.rolling_resistance": False, "effects.rolling_pressure_force": False},
    "without_pressure_force": {"effects.rolling_pressure_force": False},
    "without_heat": {"effects.thermal": False},
    "without_damping": {"effects.damping": "off"},
    "exponential_mixing": {"effects.mixed_law": "exponential"},
    "pocket_film": {"effects.pocket_film": 5e-5},
    "drag": {"effects.oil_fill": 0.1},
    "flooded_gaps": {"effects.flooded_gaps": True},
    "hysteresis": {"effects.hysteresis": 0.01},
    "oil_height": {"effects.oil_height": 2e-5},
    "rib_turning": {"effects.rib_turning": True},
    "guiding_land": {"effects.guidance": "inner_land"},
    "spacer": {"effects.bodies": "rollers_and_spacer"},
    "nodes_8": {"effects.n_slices": 8},
    "nodes_24": {"effects.n_slices": 24},
}
"""Changes of the default scene whose evaluations are counted; those of the table of effects that change the scene come after."""


def instructions() -> dict[str, float]:
    """Instructions of one force evaluation with the default effects (thousands), and by how much each change alters them (%)."""
    from effect_cost.catalogue import EFFECTS
    from effect_cost.instructions import counted, described

    import trbdyn as trb

    base = trb.cases.scene_30310(3000.0, 4930.0)
    scenes = {"default": base}
    for name, change in CHANGES.items():
        scenes[name] = base.replace(effects=trb.Effects.minimal()) if name == "minimal" else base.replace(change)
    scenes |= {effect.name.replace(" ", "_"): base.replace(dict(effect.scene)) for effect in EFFECTS if effect.scene}
    with tempfile.TemporaryDirectory() as folder:
        # the first evaluation of a process takes some percent more
        counts = counted([described(base), *map(described, scenes.values())], Path(folder))[1:]
    found = dict(zip(scenes, counts, strict=True))
    default = found.pop("default")
    return {"default": default} | {name: 100.0 * (count / default - 1.0) for name, count in found.items()}


MAKERS: Final[dict[str, tuple[str, Callable[[], dict[str, float]]]]] = {
    "demo": ("make demo", demo),
    "instructions": ("python docs/recorded.py instructions", instructions),
}
"""Commands, and who runs them. Records without a maker are figures of long runs, with the command that gave them."""


def kept() -> dict[str, Record]:
    """All records."""
    found: dict[str, Record] = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.exists() else {}
    return found


def keep(name: str, command: str, figures: Mapping[str, float], revision: str | None) -> None:
    """Keep what a command gave today."""
    import common

    records = kept()
    records[name] = {
        "command": command,
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
        "revision": revision,
        "defaults": common.defaults_mark(),
        "older": None,
        "figures": dict(figures),
    }
    KEPT.write_text(json.dumps(dict(sorted(records.items())), indent=1) + "\n", encoding="utf-8")


def as_shown(value: float, like: str) -> str:
    """A value in as many digits as a figure that is there."""
    mantissa, _, exponent = like.partition("e")
    digits = len(mantissa.partition(".")[2])
    if not exponent:
        return f"{value:.{digits}f}"
    mantissa, _, exponent = f"{value:.{digits}e}".partition("e")
    return f"{mantissa}e{int(exponent)}"


def value_of(records: Mapping[str, Record], name: str, key: str) -> float | None:
    """A recorded figure; None where there is none."""
    value = records.get(name, {}).get("figures", {}).get(key)
    return None if value is None else float(value)


def unlike(text: str, records: Mapping[str, Record]) -> list[str]:
    """Figures of a page that are not those of their records."""
    out = []
    for shown, name, key in FIGURE.findall(text):
        value = value_of(records, name, key)
        if value is None:
            out.append(f"{shown}: {name}.{key} is not recorded")
        elif as_shown(value, shown) != shown:
            out.append(f"{shown}: {name}.{key} is {as_shown(value, shown)}")
    return out


def without_record(text: str) -> list[str]:
    """Cells of columns of measured values with a figure that names no record."""
    out: list[str] = []
    columns: list[int] | None = None
    for line in text.splitlines():
        if not line.startswith("|"):
            columns = None
            continue
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if columns is None:
            columns = [index for index, head in enumerate(cells) if head.startswith(MEASURED) and "band" not in cells]
            continue
        for cell in (cells[column] for column in columns):
            if re.search(r"\d", re.sub(r"`[^`]*`|\([^)]*\)", "", FIGURE.sub("", cell))):
                out.append(f"{cells[0]}: {cell}")
    return out


def older(text: str, records: Mapping[str, Record], mark: str) -> list[str]:
    """Records of a page that were made with other defaults than today's, where the page does not say so; and words about age that
    are not true any more.
    """
    out = []
    for name in sorted({name for _, name, _ in FIGURE.findall(text)} & set(records)):
        record = records[name]
        words, old = record["older"], record["defaults"] != mark
        if old and not (words and words in text):
            out.append(
                f"{name} ({record['command']}) is older than the defaults: make it again, or say with what it was made"
            )
        if words and not old:
            out.append(f"{name} is made with today's defaults, but says: {words}")
    return out


def old_stamps(text: str, mark: str) -> list[str]:
    """Lines of when something was measured whose defaults are not those of today and which do not say so, or the reverse."""
    out = []
    for found in STAMP.finditer(text):
        made = MARK.search(found[0])
        if (made is None or made[1] != mark) != (OLDER in found[0]):
            out.append(found[0].splitlines()[0])
    return out


def marked(text: str, mark: str) -> str:
    """A page whose lines say which tables are older than today's defaults."""

    def one(found: re.Match[str]) -> str:
        made, bare = MARK.search(found[0]), found[0].replace(f" {OLDER}", "")
        return bare if made is not None and made[1] == mark else f"{bare} {OLDER}"

    return STAMP.sub(one, text)


def renewed(text: str, records: Mapping[str, Record]) -> str:
    """A page with the figures of the records."""

    def one(found: re.Match[str]) -> str:
        value = value_of(records, found[2], found[3])
        shown = found[1] if value is None else as_shown(value, found[1])
        return f"{shown}<!-- {found[2]}.{found[3]} -->"

    return FIGURE.sub(one, text)


def main(arguments: Sequence[str] | None = None) -> None:
    import common

    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("names", nargs="*", choices=(*MAKERS, []), help="commands that are run again")
    parser.add_argument("--mark", action="store_true", help="say in pages which tables are older than today's defaults")
    options = parser.parse_args(arguments)
    for name in options.names:
        command, make = MAKERS[name]
        keep(name, command, make(), common.revision())
    records, mark = kept(), common.defaults_mark()
    for page in (*PAGES, *(STAMPED if options.mark else ())):
        before = page.read_text(encoding="utf-8")
        after = renewed(before, records) if page in PAGES else marked(before, mark)
        if after != before:
            page.write_text(after, encoding="utf-8")
            print(f"wrote {page.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
