"""The page: one for each tab of the browser, all of them show the same bench."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from nicegui import events, run, ui

from trbdyn.errors import TrbError
from trbdyn.extras.app import forms, outcome, units
from trbdyn.extras.app.design import Built, all_fields, built
from trbdyn.extras.app.fields import SHAPE, Field
from trbdyn.extras.app.jobs import Bench
from trbdyn.extras.app.load_cases import checked

TICK: Final = 0.4
"""Time between two looks at the task and at what other tabs have changed (s)."""
STYLE: Final = """
.trb-grid { grid-template-columns: repeat(auto-fill, minmax(15rem, 1fr)); }
.trb-wide { display: grid; gap: 1rem; grid-template-columns: repeat(auto-fit, minmax(min(100%, 30rem), 1fr)); width: 100%; }
.q-field--with-bottom { padding-bottom: 0; }
.q-field__bottom--animated { position: static; transform: none; padding-top: 2px; }
.q-field__messages { line-height: 1.25; }
.trb-text { white-space: pre-wrap; font-family: monospace; font-size: 0.8rem; overflow-wrap: anywhere; }
.nicegui-content { padding: 0.75rem; }
.trb-upload .q-uploader__list, .trb-upload .q-uploader__subtitle { display: none; }
.q-tab-panel { padding: 0.5rem 0; }
img, iframe { max-width: 100%; }
.trb-view { height: 34rem; }
@media (max-width: 640px) { .trb-view { height: 46rem; } }
"""
TABS: Final = {
    "start": "Start",
    "bearing": "Bearing",
    "operation": "Operation",
    "effects": "Effects",
    "run": "Run",
    "results": "Results",
    "compare": "Compare",
    "sweep": "Sweep",
}


KINDS: Final = {"m": "lengths", "N": "forces", "deg": "angles"}
"""What units are chosen for."""
BACK: Final = """
function trbTab() {
  try { emitEvent('tab', location.hash.slice(1) || 'start'); window.trbReady = true; }
  catch { setTimeout(trbTab, 200); }  // the page is still being made
}
addEventListener('popstate', trbTab);
"""
"""Goes to the tab that the address names: after a reload, and by the buttons that go back and forth."""


def _note_tab(event: events.ValueChangeEventArguments[Any]) -> None:
    """Write the tab into the address."""
    name = f"#{event.value}"
    ui.run_javascript(f"if ((location.hash || '#start') !== '{name}') history.pushState(null, '', '{name}')")


class Page:
    """One tab of the browser."""

    run_button: Any
    stop_button: Any
    progress: Any
    said: Any
    script: Any
    case: Any
    results: Any
    comparison: Any
    sweeps: Any
    spectrum: Any

    def __init__(self, bench: Bench) -> None:
        self.bench = bench
        self.built: Built = built(bench.design)
        self.widgets: dict[str, Any] = {}
        self._fields: dict[str, Field] = {}
        self.folds: dict[str, Any] = {}  # what a field is folded away in
        self._seen = bench.version
        self._drawn_of: object = None
        self._shown_job: object = None
        self._parts: list[Callable[[], Any]] = []

    def show(self) -> None:
        """Lay the page out."""
        ui.add_css(STYLE)
        self._fields = all_fields(self.bench.design, self.built.base)
        with ui.header().classes("items-center gap-3 py-2"):
            ui.label("trbdyn").classes("text-xl font-bold")
            for si, choices in units.CHOSEN.items():
                self._unit_choice(si, choices)
            self._status = ui.label().classes("text-sm")
        self._part(outcome.show_controls)
        with ui.tabs().props("dense no-caps outside-arrows mobile-arrows align=left").classes("w-full") as tabs:
            for name, words in TABS.items():
                ui.tab(name, words).props(f'data-path="tab.{name}"')
        self._general = ui.label().classes("text-red-700 trb-text")
        ui.on("tab", lambda event: tabs.set_value(event.args) if event.args in TABS else None)
        ui.add_body_html(f"<script>{BACK}</script>")
        with ui.tab_panels(tabs, value="start", animated=False).props("keep-alive").classes("w-full"):
            with ui.tab_panel("start"):
                self._part(forms.show_start)
                self._shaft = ui.element("img")
            with ui.tab_panel("bearing"):
                with ui.element("div").classes("trb-wide"):
                    self._drawings = [*(ui.element("img") for _ in range(2)), self._shaft]
                self._inside = self._part(forms.show_bearing)
            for name, show in (
                ("operation", forms.show_operation),
                ("effects", forms.show_effects),
                ("run", outcome.show_run),
            ):
                with ui.tab_panel(name):
                    self._part(show)
            for name, show in (
                ("results", outcome.show_results),
                ("compare", outcome.show_compare),
                ("sweep", outcome.show_sweep),
            ):
                with ui.tab_panel(name):
                    self._part(show)
        tabs.on_value_change(_note_tab)
        self._tell()
        ui.timer(TICK, self._tick)
        ui.timer(0.2, lambda: ui.run_javascript("trbTab()"), once=True)

    def _part(self, show: Callable[[Page], None]) -> Callable[[], Any]:
        """A part of the page that can be shown again."""
        part = ui.refreshable(lambda: show(self))
        part()
        self._parts.append(part.refresh)
        return part.refresh

    def _unit_choice(self, si: str, choices: tuple[str, ...]) -> None:
        design = self.bench.design

        def choose(event: events.ValueChangeEventArguments[Any]) -> None:
            if event.value != design.unit(si):
                design.change_unit(si, event.value, all_fields(design, self.built.base).values())
                self.restructured()

        select = ui.select(list(choices), value=design.unit(si), on_change=choose)
        select.props("dense dark borderless options-dense").props(
            f'data-path="unit.{si}" aria-label="unit of {KINDS[si]}"'
        )

    def place(self, one: Field, widget: Any) -> None:
        """Show unit and value that a field has where nothing is typed; only what has changed goes to the browser, which would
        lose what is being typed there.
        """
        unit = self.bench.design.unit_of(one)
        default = one.default
        number = isinstance(default, int | float) and not isinstance(default, bool)
        shown = units.show(default, one.unit or "1", unit or "1") if number else str(default or "")
        for name, text in (("suffix", unit), ("placeholder", shown)):
            if widget.props.get(name) != text:
                widget.props[name] = text

    def typed(self, path: str, text: str) -> None:
        """Take in what was typed into a field."""
        typed = self.bench.design.typed
        if typed.get(path, "") == text:
            return
        if text.strip():
            typed[path] = text
        else:
            typed.pop(path, None)
        if path == SHAPE:
            for name in [name for name in typed if ".cage.pocket." in name and name != path]:
                del typed[name]
        self._take_in()
        if path == SHAPE:
            self._inside()
            self._tell()

    def _take_in(self) -> None:
        """Find out what the design means now, and show it at the fields."""
        before = self.built
        self.built = built(self.bench.design)
        now, old = self.built.base, before.base
        self._fields = all_fields(self.bench.design, now)
        if (now is None) != (old is None) or (now is not None and old is not None and _frame(now) != _frame(old)):
            self._inside()
        self._seen = self.bench.changed()
        self._tell()

    def restructured(self) -> None:
        """Show all again, as another source, unit or number of bearings was chosen."""
        self.built = built(self.bench.design)
        self._fields = all_fields(self.bench.design, self.built.base)
        self._seen = self.bench.changed()
        self._again()

    def _again(self) -> None:
        self.widgets.clear()
        self.folds.clear()
        for refresh in self._parts:
            refresh()
        self._tell()

    def _tell(self) -> None:
        """Put what is wrong at its fields, and values where nothing is typed."""
        problems = self.built.problems
        for path, widget in self.widgets.items():
            if path in self._fields and not self._fields[path].choices:
                self.place(self._fields[path], widget)
            if hasattr(widget, "error"):
                widget.error = problems.get(path)
            if path in problems and path in self.folds:
                self.folds[path].open()
        words = {path: one.words for path, one in self._fields.items()}
        shown = {path for path, widget in self.widgets.items() if hasattr(widget, "error")}
        rest = [f"{words.get(path, path)}: {text}".lstrip(": ") for path, text in problems.items() if path not in shown]
        self._general.text = "\n".join(rest)
        names = {path.split(".")[0] for path in problems if path in self.widgets}
        where = {"page": "Start", "named": "Start", "bearing": "Bearing", "effects": "Effects", "run": "Run"}
        asked = set(forms.ASKED[forms.machine_of(self)]) | {"pair.other"}
        said = {where.get(name, "Operation") for name in names - {one.split(".")[0] for one in asked & problems.keys()}}
        places = ", ".join(sorted(said | ({"Start"} if asked & problems.keys() else set())))
        self._status.text = (
            f"{len(problems)} to correct{f': {places}' if places else ''}" if problems else "inputs complete"
        )
        outcome.tell_run(self)
        outcome.tell_program(self)

    def spectrum_changed(self) -> None:
        """Take in the table of load cases."""
        self.spectrum.error = checked(self.bench.design)
        self._seen = self.bench.changed()

    async def open_case(self, event: events.UploadEventArguments) -> None:
        """Take a case file in the place of the bearing."""
        try:
            tables = await run.io_bound(forms.open_case, await event.file.read())
        except (TrbError, ValueError) as error:
            ui.notify(
                f"this is no case that can be used: {str(error)[:2000]}",
                type="negative",
                multi_line=True,
                timeout=20000,
            )
            return
        design = self.bench.design
        design.case, design.source, design.typed, design.pair = tables, "case", {}, False
        self.restructured()

    async def _tick(self) -> None:
        self.bench.look()
        if self._seen != self.bench.version:
            changed = self.bench.job is self._shown_job and (self.bench.job is None or self.bench.job.running)
            self._seen, self._shown_job = self.bench.version, self.bench.job
            self.built = built(self.bench.design)
            self._fields = all_fields(self.bench.design, self.built.base)
            if changed:
                self._again()
            else:
                outcome.refresh(self)
        outcome.tell_run(self)
        bearing = self.built.bearing
        shown = (bearing, self.built.subject if self.bench.design.pair else None)
        if bearing is not None and shown != self._drawn_of:
            self._drawn_of = shown
            self._shaft.set_visibility(self.bench.design.pair)
            for element, source in zip(self._drawings, await forms.draw(self.built), strict=False):
                element.props["src"] = source
                element.update()


def _frame(bearing: Any) -> tuple[Any, ...]:
    """What the form of a bearing is made of: the bands of its estimates, and its kind."""
    return bearing.is_cylindrical, tuple((one.path, one.low, one.high) for one in bearing.estimated)


def show_page(bench: Bench) -> None:
    """Show the page in a tab."""
    Page(bench).show()
