"""The forms of the page: a field for each input, the bearing with its drawing, speed and loads, effects."""

from __future__ import annotations

import contextlib
import re
import threading
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final, cast

from nicegui import events, run, ui

from trbdyn.base.reading import tables_of
from trbdyn.errors import TrbError
from trbdyn.extras.app import fields as of
from trbdyn.extras.app import units
from trbdyn.extras.app.design import Built, scene_fields
from trbdyn.extras.app.fields import Field
from trbdyn.extras.app.load_cases import COLUMNS, checked
from trbdyn.extras.app.questions import QUESTIONS
from trbdyn.model.assembly import Assembly
from trbdyn.model.cases import BEARINGS
from trbdyn.model.effects import Effects
from trbdyn.model.pocket_shapes import SHAPES
from trbdyn.reporting.page import image
from trbdyn.run.toml_assembly import subject_from_dict

if TYPE_CHECKING:
    from trbdyn.extras.app.page import Page
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
        widget = ui.select(list(one.choices), label=one.words, value=shown, on_change=changed).without_auto_validation()
        if one.default is None:
            widget.props("clearable")
        widget.props["hint"] = hint or one.meaning
    else:
        widget = ui.input(one.words, value=typed, on_change=changed).props("debounce=250 stack-label")
        widget.without_auto_validation()
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


MACHINES: Final = {
    "one": "one bearing",
    "shaft": "two bearings on a shaft, with a force on it",
    "gear": "two bearings on a shaft with a gear",
    "wheel": "a wheel hub: two bearings whose outer rings turn",
}
"""What may turn."""
ASKED: Final = {
    "one": ("scene.speed_rpm", "scene.axial_load", "scene.radial_load"),
    "shaft": (
        "scene.speed_rpm",
        "scene.axial_load",
        "scene.radial_load",
        "pair.position",
        "pair.spread",
        "pair.end_play",
    ),
    "gear": (
        "scene.speed_rpm",
        "gear.torque",
        "gear.pitch_diameter",
        "gear.helix_angle_deg",
        "gear.position",
        "pair.spread",
    ),
    "wheel": (
        "scene.outer_speed_rpm",
        "wheel.load",
        "wheel.rolling_radius",
        "wheel.cornering",
        "pair.spread",
        "pair.end_play",
    ),
}
"""Fields that are asked for first, by what turns."""


def machine_of(page: Page) -> str:
    """What turns."""
    design = page.bench.design
    return "one" if not design.pair else design.acts or "shaft"


def show_start(page: Page) -> None:
    """Four questions: what turns, which bearing, under which load, and what is asked."""
    design = page.bench.design

    def turn(event: events.ValueChangeEventArguments[Any]) -> None:
        design.pair, design.acts = event.value != "one", event.value if event.value in of.ACTS else ""
        page.restructured()

    _heading("1. What turns?")
    machine = ui.radio(MACHINES, value=machine_of(page), on_change=turn).props('data-path="machine" dense')
    if design.source == "case" and design.case is not None and "assembly" in design.case:
        machine.set_enabled(False)
    _heading("2. Which bearing?")
    show_source(page)
    _heading("3. How fast, under which load?")
    asked = {one.path: one for one in (*scene_fields(), *of.pair_fields())}
    show_fields(page, [asked[path] for path in ASKED[machine_of(page)]])
    ui.label("Oil, temperatures, fits and a spectrum of load cases are under Operation.").classes("text-gray-600")
    _heading("4. What do you want to know?")
    show_questions(page)


def show_questions(page: Page) -> None:
    """What the user wants to know."""
    design = page.bench.design
    with ui.row():
        for name, question in QUESTIONS.items():

            def ask(event: events.ValueChangeEventArguments[Any], name: str = name) -> None:
                design.wants = [one for one in QUESTIONS if (event.value if one == name else one in design.wants)]
                page._take_in()

            box = ui.checkbox(question.words, value=name in design.wants, on_change=ask)
            box.props["data-path"] = f"want.{name}"


def _heading(words: str) -> None:
    ui.label(words).classes("text-lg font-medium mt-2")


def show_source(page: Page) -> None:
    """Which bearing: by its designation, one that ships, a catalogue page, a case."""
    design = page.bench.design
    names = {"named": "by its designation", "page": "a catalogue page, typed in"}
    names |= {name: f"{name} (ships with trbdyn)" for name in BEARINGS}
    if design.case is not None:
        names["case"] = "the case that was opened"

    def choose(event: events.ValueChangeEventArguments[Any]) -> None:
        design.source = event.value
        of_old = ("bearing.", "page.", "named.")
        design.typed = {path: text for path, text in design.typed.items() if not path.startswith(of_old)}
        page.restructured()

    with ui.row().classes("w-full items-end gap-4"):
        source = ui.select(names, label="bearing", value=design.source, on_change=choose)
        source.props["data-path"] = "source"
        source.classes("min-w-64")
        if design.source == "named":
            show_field(page, of.named_fields()[0])
            page.widgets["named.designation"].classes(remove="w-full").classes("min-w-64")
        if design.pair:
            other = next(one for one in of.pair_fields() if one.path == "pair.other")
            show_field(page, other)
            page.widgets["pair.other"].classes(remove="w-full").classes("min-w-64")
        upload = ui.upload(
            label="open a case (TOML)", auto_upload=True, max_file_size=LARGEST_CASE, on_upload=page.open_case
        )
        upload.props("accept=.toml flat bordered").classes("w-64 trb-upload")
    if design.source in ("page", "named"):
        listed = [one for one in of.page_fields() if design.source == "page" or one.path not in OF_ROW]
        main = [one for one in listed if one.path.removeprefix("page.") in (*of.MAIN, "name")]
        if design.source == "page":
            show_fields(page, main)
        words = "more numbers of its page: what is given is not estimated"
        show_folded(page, words, [one for one in listed if one not in main or design.source == "named"])


OF_ROW: Final = (
    "page.name",
    "page.bore",
    "page.outside",
    "page.width",
    "page.flanges",
    "page.F",
    "page.E",
    "page.radial_clearance",
)
"""Numbers of a page that a designation has, or that only cylindrical bearings have."""


def show_folded(page: Page, title: str, listed: Iterable[Field], *, opened: bool = False) -> None:
    """Fields that are folded away until they are asked for, typed into, or wrong."""
    fields = list(listed)
    if not fields:
        return
    typed = page.bench.design.typed
    with ui.expansion(title, value=opened or any(one.path in typed for one in fields)).classes("w-full") as fold:
        fold.props["data-path"] = f"fold.{fields[0].path}"
        show_fields(page, fields)
    page.folds |= {one.path: fold for one in fields}


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
        show_fields(page, [_with_part(listed.pop(path)) for path in hints], hints)
    shape = page.bench.design.typed.get(of.SHAPE, "default")
    plays = [
        listed.pop(f"bearing.cage.{name}")
        for name in ("play_radial", "play_circumferential", "play_axial", "bar_width", "mass")
        if f"bearing.cage.{name}" in listed
    ]
    show_folded(page, "Cage and pocket", [*of.pocket_fields(shape if shape in SHAPES else "default"), *plays])
    for part, title in GROUPS.items():
        show_folded(page, title, [one for path, one in listed.items() if _part(path) == part])


def _with_part(one: Field) -> Field:
    """A field whose words name the part that it is of, for a place below no heading of that part."""
    words = re.sub(r"_(?=\w\w)", " ", one.path.removeprefix("bearing.").removesuffix("_deg").replace(".", " "))
    return replace(one, words=re.sub(r"^n (?=\w)", "number of ", words))


def _part(path: str) -> str:
    part = path.split(".")[1]
    return part if part in GROUPS and path.count(".") > 1 else ""


def _band(page: Page, low: float, high: float, si: str, source: str) -> str:
    unit = page.bench.design.unit(si) if si else ""
    ends = [units.show(end, si or "1", unit or "1", 4) for end in (low, high)]
    band = f"{' to '.join(ends)} {unit}".rstrip()
    return f"estimated, {band}: {source}"


def show_operation(page: Page) -> None:
    """Oil, more of the loads, seats, and load cases."""
    design, asked = page.bench.design, ASKED[machine_of(page)]
    _heading("Oil")
    show_fields(page, [*of.oil_fields(), *of.rating_fields()])
    rest = [one for one in scene_fields() if one.path not in asked]
    show_folded(page, "More of the speeds and loads", rest)
    if design.pair:
        more = [one for one in of.pair_fields() if one.path not in asked and one.path != "pair.other"]
        for prefix, title in (("pair.", "Shaft and bearings"), ("gear.", "Gear"), ("wheel.", "Wheel")):
            if prefix == "pair." or design.acts == prefix[:-1]:
                show_folded(page, title, [one for one in more if one.path.startswith(prefix)])
    sizes = ("fit.bore", "fit.outside", "fit.width") if design.source in ("named", "page") else ()
    show_folded(page, "Seats, fits and temperatures", [one for one in of.fit_fields() if one.path not in sizes])
    with ui.expansion("Spectrum of load cases", value=bool(design.spectrum)).classes("w-full") as fold:
        fold.props["data-path"] = "fold.spectrum"
        show_spectrum(page)


def show_spectrum(page: Page) -> None:
    """A table of load cases, typed, pasted or read."""
    design = page.bench.design

    def changed(event: events.ValueChangeEventArguments[Any]) -> None:
        design.spectrum = str(event.value or "")
        page.spectrum_changed()

    async def read(event: events.UploadEventArguments) -> None:
        try:
            table.value = (await event.file.read()).decode("utf-8-sig")
        except UnicodeDecodeError:
            ui.notify("this is no text in UTF-8", type="negative")

    words = f"Columns: share (time of the case), name, {', '.join(COLUMNS)}; numbers in the units of the page."
    ui.label(f"{words} Commas, semicolons or tabs between; with semicolons numbers may have commas.").classes(
        "text-gray-600"
    )
    table = ui.textarea("load cases", value=design.spectrum, on_change=changed, placeholder="name;share;speed;torque")
    table.props('data-path="spectrum" debounce=400 stack-label autogrow input-style="font-family: monospace"').classes(
        "w-full"
    )
    page.spectrum = table.without_auto_validation()
    page.spectrum.error = checked(design) if design.spectrum else None
    upload = ui.upload(label="read a table (CSV)", auto_upload=True, max_file_size=LARGEST_CASE, on_upload=read)
    upload.props("accept=.csv,.txt flat bordered").classes("w-64 trb-upload")


EFFECTS: Final = {
    "Rollers, cage and gravity": ("bodies", "guidance", "gravity", "planar", "oil_fill", "drag_coefficient"),
    "Films and friction": ("lubrication", "traction", "thermal", "thermal_law", "mixed_law", "starvation_factor",
                           "replenishment", "oil_height", "flooded_gaps"),
    "Rolling resistance": ("rolling_resistance", "rolling_law", "rolling_pressure_force", "hysteresis"),
    "Ribs": ("back_rib", "front_rib", "rib_film", "rib_turning"),
    "Pockets": ("pocket_bars", "pocket_ends", "pocket_edges", "pocket_film"),
    "Damping": ("damping", "film_damping", "film_damping_depth", "damping_race", "damping_cage"),
    "Nodes of the contact lines": ("quadrature", "n_slices"),
}  # fmt: skip
"""Effects by the headings under which they are folded."""


def show_effects(page: Page) -> None:
    """Every effect with a word on it."""
    words = "Each effect is a switch or a choice of the simulation; those shown are the recommended ones."
    ui.label(words).classes("text-gray-600")
    listed = {one.path.removeprefix("effects."): one for one in of.fields_of(Effects(), "effects.")}
    for title, names in EFFECTS.items():
        show_folded(page, title, [listed.pop(name) for name in names if name in listed])
    friction = [one for name, one in listed.items() if name.startswith("friction.")]
    show_folded(page, "Constants of friction", friction)
    show_folded(page, "More", [one for one in listed.values() if one not in friction])


def open_case(content: bytes) -> dict[str, Any]:
    """The tables of a case file, checked: an `InputError` or a `ValueError` if it is none."""
    tables = tables_of(content.decode("utf-8"))
    subject_from_dict(tables)
    return tables


async def draw(built: Built) -> list[str]:
    """Drawings of the bearing and its pocket, as addresses of pictures; none where they cannot be drawn."""
    bearing = built.bearing
    shaft = cast(Assembly, built.subject) if built.subject is not None and len(built.subject.names) > 1 else None
    return [] if bearing is None else await run.io_bound(_drawn, bearing, shaft) or []


def _drawn(bearing: Bearing, shaft: Assembly | None) -> list[str]:
    import matplotlib

    matplotlib.use("Agg")

    from trbdyn.plot import bearing_drawing, pocket_drawing
    from trbdyn.plot.assembly import shaft_drawing

    found = []
    drawings: list[Callable[[], Any]] = [partial(bearing_drawing, bearing), partial(pocket_drawing, bearing)]
    if shaft is not None:
        drawings.append(partial(shaft_drawing, shaft))
    with _DRAWING:
        for draw in drawings:
            with contextlib.suppress(TrbError):
                found.append(image(draw, dpi=100))
    return found
