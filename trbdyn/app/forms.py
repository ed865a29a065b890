"""The forms of the page: a field for each input, the bearing with its drawing, speed and loads, effects."""

from __future__ import annotations

import contextlib
import threading
import tomllib
from collections.abc import Iterable
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from nicegui import events, run, ui

from trbdyn.app import fields as of
from trbdyn.app import units
from trbdyn.app.design import Built, scene_fields
from trbdyn.app.fields import Field
from trbdyn.errors import TrbError
from trbdyn.model.cases import BEARINGS
from trbdyn.model.effects import Effects
from trbdyn.model.pocket_shapes import SHAPES
from trbdyn.reporting.page import image
from trbdyn.run.toml_assembly import subject_from_dict

if TYPE_CHECKING:
    from trbdyn.app.page import Page
    from trbdyn.model.bearing import Bearing

GRID: Final = "w-full grid gap-x-4 gap-y-2 items-start trb-grid"
GROUPS: Final = {
    "roller": "Rollers and their profile",
    "ribs": "Ribs",
    "cage": "Cage",
    "land": "Land that guides the cage",
    "material": "Material",
    "roughness": "Roughness",
    "ratings": "Ratings",
    "": "More of the bearing",
}
LARGEST_CASE: Final = 1 << 20
"""Largest case file that is opened (bytes)."""
_DRAWING = threading.Lock()


def show_field(page: Page, one: Field, hint: str = "") -> None:
    """The widget of a field."""
    typed = page.bench.design.typed.get(one.path, "")

    def changed(event: events.ValueChangeEventArguments[Any]) -> None:
        value = event.value
        text = (
            {True: "on", False: "off"}.get(value, "" if value is None else str(value))
            if not isinstance(value, str)
            else value
        )
        page.typed(one.path, text)

    widget: Any
    if one.choices == ("on", "off"):
        with ui.column().classes("gap-0"):
            widget = ui.switch(one.words, value=one.value(typed) if typed else bool(one.default), on_change=changed)
            ui.label(hint or one.meaning).classes("text-xs text-gray-600")
    elif one.choices:
        chosen = typed or (None if one.default is None else str(one.default))
        shown = chosen if chosen in one.choices else None
        widget = ui.select(list(one.choices), label=one.words, value=shown, on_change=changed)
        widget.props["hint"] = hint or one.meaning
    else:
        widget = ui.input(one.words, value=typed, on_change=changed).props("debounce=250 stack-label")
        widget.props["hint"] = hint or one.meaning
        page.place(one, widget)
    widget.props["data-path"] = one.path
    widget.classes("w-full")
    page.widgets[one.path] = widget


def show_fields(page: Page, listed: Iterable[Field], hints: dict[str, str] | None = None) -> None:
    """Fields side by side, as many as there is room for."""
    with ui.element("div").classes(GRID):
        for one in listed:
            show_field(page, one, (hints or {}).get(one.path, ""))


def show_source(page: Page) -> None:
    """Which bearing: one that ships, a catalogue page, a case."""
    design = page.bench.design
    names = {name: f"{name} (ships with trbdyn)" for name in BEARINGS} | {"page": "a catalogue page, typed in"}
    if design.case is not None:
        names["case"] = "the case that was opened"

    def choose(event: events.ValueChangeEventArguments[Any]) -> None:
        design.source = event.value
        design.typed = {path: text for path, text in design.typed.items() if not path.startswith("bearing.")}
        page.restructured()

    with ui.row().classes("w-full items-end gap-4"):
        source = ui.select(
            names, label="bearing", value=design.source if design.source in names else "30310", on_change=choose
        )
        source.props["data-path"] = "source"
        source.classes("min-w-64")
        upload = ui.upload(
            label="open a case (TOML)", auto_upload=True, max_file_size=LARGEST_CASE, on_upload=page.open_case
        )
        upload.props("accept=.toml flat bordered").classes("w-64 trb-upload")
    if design.source == "page":
        listed = of.page_fields()
        main = [one for one in listed if one.path.removeprefix("page.") in (*of.MAIN, "name")]
        show_fields(page, main)
        with ui.expansion("more numbers of the page: what is given is not estimated").classes("w-full"):
            show_fields(page, [one for one in listed if one not in main])


def show_bearing(page: Page) -> None:
    """The inside of the bearing: what is estimated first, then the rest by parts."""
    base = page.built.base
    if base is None:
        ui.label("The bearing is shown here when its numbers are complete.").classes("text-gray-600")
        return
    listed = {one.path: one for one in of.bearing_fields(base)}
    hints = {
        f"bearing.{one.path}": _band(page, one.low, one.high, listed[f"bearing.{one.path}"].unit, one.source)
        for one in base.estimated
        if f"bearing.{one.path}" in listed
    }
    if hints:
        ui.label("Estimated: type what you know better").classes("text-lg font-medium")
        show_fields(page, [listed.pop(path) for path in hints], hints)
    ui.label("Cage and pocket").classes("text-lg font-medium")
    shape = page.bench.design.typed.get(of.SHAPE, "default")
    plays = [
        listed.pop(f"bearing.cage.{name}")
        for name in ("play_radial", "play_circumferential", "play_axial", "bar_width", "mass")
        if f"bearing.cage.{name}" in listed
    ]
    show_fields(page, [*of.pocket_fields(shape if shape in SHAPES else "default"), *plays])
    for part, title in GROUPS.items():
        inside = [one for path, one in listed.items() if _part(path) == part]
        if inside:
            with ui.expansion(title).classes("w-full"):
                show_fields(page, inside)


def _part(path: str) -> str:
    part = path.split(".")[1]
    return part if part in GROUPS and path.count(".") > 1 else ""


def _band(page: Page, low: float, high: float, si: str, source: str) -> str:
    unit = page.bench.design.unit(si) if si else ""
    band = f"{units.show(low, si, unit)} to {units.show(high, si, unit)} {unit}" if si else f"{low:g} to {high:g}"
    return f"estimated, {band}: {source}"


def show_operation(page: Page) -> None:
    """Speed, loads, oil, and the pair on a shaft."""
    design = page.bench.design
    ui.label("Speed and loads").classes("text-lg font-medium")
    show_fields(page, scene_fields())
    ui.label("Oil").classes("text-lg font-medium")
    show_fields(page, of.oil_fields())

    def choose(event: events.ValueChangeEventArguments[Any]) -> None:
        design.pair = bool(event.value)
        page.restructured()

    switch = ui.switch(
        "two of this bearing on a shaft; the loads then act on the shaft", value=design.pair, on_change=choose
    )
    switch.props["data-path"] = "pair"
    if design.pair:
        show_fields(page, of.pair_fields())


def show_effects(page: Page) -> None:
    """Every effect with a word on it."""
    ui.label("Each effect is a switch or a choice of the simulation; those shown are the recommended ones.").classes(
        "text-gray-600"
    )
    show_fields(page, of.fields_of(Effects(), "effects."))


def open_case(content: bytes) -> dict[str, Any]:
    """The tables of a case file, checked: an `InputError` or a `ValueError` if it is none."""
    try:
        tables = tomllib.loads(content.decode("utf-8"))
        subject_from_dict(tables)
    except RecursionError:
        raise ValueError("its tables are nested too deeply") from None
    return tables


async def draw(built: Built) -> list[str]:
    """Drawings of the bearing and its pocket, as addresses of pictures; none where they cannot be drawn."""
    bearing = built.bearing
    return [] if bearing is None else await run.io_bound(_drawn, bearing) or []


def _drawn(bearing: Bearing) -> list[str]:
    import matplotlib

    matplotlib.use("Agg")

    from trbdyn.plot import bearing_drawing, pocket_drawing

    found = []
    with _DRAWING:
        for draw in (bearing_drawing, pocket_drawing):
            with contextlib.suppress(TrbError):
                found.append(image(partial(draw, bearing), dpi=100))
    return found
