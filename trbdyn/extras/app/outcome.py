"""The second half of the page: what the user wants to know, run and stop, results, comparison, sweep."""

from __future__ import annotations

import copy
import json
from typing import TYPE_CHECKING, Any, Final, cast

from nicegui import events, ui

from trbdyn.extras.app.design import Built, all_fields, built, over_of, run_fields
from trbdyn.extras.app.forms import show_fields
from trbdyn.extras.app.jobs import Kept
from trbdyn.extras.app.load_cases import cases_of
from trbdyn.extras.app.program import script
from trbdyn.extras.app.tasks import Also
from trbdyn.reporting import converter
from trbdyn.run.case_text import case_text, tables_text

if TYPE_CHECKING:
    from trbdyn.extras.app.page import Page

MOST_VALUES: Final = 50
"""Most values of a sweep."""
SWEEP_AXES: Final = ("scene.", "bearing.", "lubricant.temperature_c", "page.", "pair.", "effects.")


def show_controls(page: Page) -> None:
    """Run and stop, on every tab."""
    with ui.row().classes("items-center w-full gap-2"):
        page.run_button = ui.button("Run", on_click=lambda: start(page)).props('no-caps data-path="run"')
        page.stop_button = ui.button("Stop", on_click=lambda: stop(page)).props('no-caps flat data-path="stop"')
        page.progress = ui.linear_progress(show_value=False).classes("w-48")
        page.said = ui.label().props('data-path="said"')


def show_run(page: Page) -> None:
    """Length and accuracy, and the program that does the same."""
    design = page.bench.design

    def plan(event: events.ValueChangeEventArguments[Any]) -> None:
        design.planned = bool(event.value)
        page.restructured()

    words = (
        "find effects, accuracy and length for what you want to know (trbdyn.plan): short runs of about 15 s come first"
    )
    ui.switch(words, value=design.planned, on_change=plan).props["data-path"] = "planned"
    if not design.planned:
        show_fields(page, run_fields())
    with ui.element("div").classes("trb-wide"):
        with ui.expansion("the same in Python", value=False).props('data-path="show.script"').classes("w-full"):
            page.script = ui.label().classes("trb-text").props('data-path="script"')
        with ui.expansion("the same as a case (TOML)").classes("w-full"):
            page.case = ui.label().classes("trb-text")
    tell_program(page)


def case_of(made: Built) -> str:
    """The case file of a design."""
    if made.subject is None:
        return ""
    if "assembly" in made.tables:
        return tables_text(made.tables)
    return case_text(cast(Any, made.subject), made.options)


def start(page: Page) -> None:
    """Run the design."""
    design, made = page.bench.design, page.built
    if made.problems or made.subject is None:
        ui.notify("there is something to correct first: see the fields in red", type="negative")
        return
    try:
        cases = cases_of(design)
    except ValueError as error:
        page.spectrum.error = str(error)
        ui.notify(f"spectrum of load cases: {error}", type="negative", multi_line=True)
        return
    also = Also(
        reliability=float(made.values.get("rating.reliability", 90.0)),
        spectrum=tuple(cases),
        fits=made.fits,
        unseated=made.unseated,
        over=tuple(over_of(made)),
    )
    arguments = {"tables": made.tables, "wants": list(design.wants), "planned": design.planned, "also": also}
    texts = {"case.toml": case_of(made), "script.py": script(design, made)}
    if page.bench.start("run", title(made), arguments, texts) is None:
        ui.notify("another task is under way", type="warning")


def title(made: Built) -> str:
    """Bearing, speed and loads in a line."""
    return "" if made.subject is None else made.subject.title


def stop(page: Page) -> None:
    """Stop what is under way."""
    if page.bench.job is not None:
        page.bench.job.stop()


def tell_run(page: Page) -> None:
    """Show how far the task is, and the program that does the same."""
    if not hasattr(page, "run_button"):
        return
    job = page.bench.job
    running = job is not None and job.running
    page.run_button.set_enabled(not running and not page.built.problems)
    page.stop_button.set_enabled(running)
    page.stop_button.text = "End at once" if job is not None and job.running and job.stopping else "Stop"
    page.progress.set_visibility(running)
    page.progress.props(f"indeterminate={str(job is not None and job.share is None).lower()}")
    page.progress.value = 0.0 if job is None or job.share is None else round(job.share, 3)
    page.said.text = (
        ""
        if job is None
        else f"{job.kind}{', stopping' if job.stopping else ''}: {job.text}"
        if running
        else f"{job.kind} {job.state}: {job.text}"
    )
    if job is not None and job.problems:
        page.said.text += " " + "; ".join(f"{path}: {text}" for path, text in job.problems.items())


def tell_program(page: Page) -> None:
    """Show the program and the case that do the same."""
    if hasattr(page, "script"):
        page.script.text = script(page.bench.design, page.built) if page.built.subject is not None else ""
        page.case.text = case_of(page.built)


def refresh(page: Page) -> None:
    """Show the lists of what was made again."""
    for part in (page.results, page.comparison, page.sweeps):
        part.refresh()


def show_results(page: Page) -> None:
    """One of the runs: pictures and 3-D view beside each other, numbers, files."""
    chosen = {"name": ""}

    @ui.refreshable
    def results() -> None:
        kept = page.bench.kept()
        if not kept:
            ui.label("Results stand here after the first run.").classes("text-gray-600")
            return
        names = {one.name: f"{one.about.get('when', '')}  {one.title}" for one in kept}
        if chosen["name"] not in names or chosen.get("first") != kept[0].name:
            chosen["name"] = chosen["first"] = kept[0].name

        def choose(event: events.ValueChangeEventArguments[Any]) -> None:
            chosen["name"] = event.value
            results.refresh()

        ui.select(names, value=chosen["name"], on_change=choose, label="run").classes("w-full")
        _show_kept(page, next(one for one in kept if one.name == chosen["name"]))

    results()
    page.results = results


def _show_kept(page: Page, one: Kept) -> None:
    address, about = f"files/{one.name}", one.about
    ui.label(f"{about.get('state', '')}: {about.get('text', '')}").props('data-path="result.state"')
    with ui.row():
        for name, words in (("report.html", "report"), ("view.html", "3-D view alone"), ("script.py", "Python"),
                            ("case.toml", "case (TOML)"), ("run.h5", "records (HDF5)"), ("report.pdf", "PDF")):  # fmt: skip
            if page.bench.file(one.name, name):
                ui.link(words, f"{address}/{name}", new_tab=name.endswith(".html")).props(f'data-path="file.{name}"')
        if page.bench.file(one.name, "report.html") and not page.bench.file(one.name, "report.pdf") and converter():
            again = {"page": "report.html"}
            made = ui.button("make a PDF", on_click=lambda: page.bench.again("pdf", one.name, again))
            made.props('no-caps flat dense data-path="make.pdf"')
    if one.kind == "sweep":
        _show_sweep(page, one, address)
        return
    _show_verdict(about.get("verdict"))
    folder = page.bench.root / "runs" / one.name
    numbers = _numbers(page, one)
    if wanted := [
        [name, *row] for name, rows in numbers.items() for row in rows if row[3:] and row[3] in about.get("wanted", ())
    ]:
        first = 0 if len(numbers) > 1 else 1
        _table(["bearing", "quantity", "value", "unit"][first:], [row[first:4] for row in wanted])
    if one.kind == "compare" and page.bench.file(one.name, "report.html"):
        ui.element("iframe").props(f'src="{address}/report.html" sandbox').classes("w-full").style("height: 60rem")
    with ui.element("div").classes("trb-wide"):
        if page.bench.file(one.name, "view.html"):
            frame = ui.element("iframe").props(f'src="{address}/view.html" sandbox="allow-scripts" data-path="view"')
            frame.classes("w-full border trb-view")
        with ui.column():
            for path in sorted((folder / "pictures").rglob("*.png")):
                ui.element("img").props["src"] = f"{address}/{path.relative_to(folder).as_posix()}"
    for name, text in about.get("tables", {}).items():
        with ui.expansion(name, value=True).classes("w-full"):
            ui.label(str(text)).classes("trb-text")
    if about.get("plan"):
        with ui.expansion("what the plan has found").classes("w-full"):
            ui.label(str(about["plan"])).classes("trb-text")
    for name, rows in numbers.items():
        with ui.expansion(f"all numbers {name}".strip()).classes("w-full").props('data-path="numbers"'):
            _table(["quantity", "value", "unit"], [row[:3] for row in rows])


COLOURS: Final = {
    "good": "border-green-700",
    "care": "border-amber-600",
    "bad": "border-red-700",
    "plain": "border-gray-400",
}


def _show_verdict(judged: Any) -> None:
    """What the run says, in sentences: life, cage, hits, torque, films."""
    if not isinstance(judged, dict):
        return
    for name, sentences in judged.items():
        if len(judged) > 1:
            ui.label(name).classes("font-medium")
        with ui.element("div").classes("trb-wide").props('data-path="verdict"'):
            for grade, head, text in sentences:
                with ui.card().classes(f"p-2 border-l-4 {COLOURS.get(grade, '')}").props("flat bordered"):
                    ui.label(f"{head}{GRADES.get(grade, '')}").classes("font-medium")
                    ui.label(text).classes("text-sm")


GRADES: Final = {"good": ": good", "care": ": take care", "bad": ": not good"}


def _numbers(page: Page, one: Kept) -> dict[str, list[list[str]]]:
    path = page.bench.file(one.name, "summary.json")
    return {} if path is None else json.loads(path.read_text(encoding="utf-8"))


def _table(head: list[str], rows: list[list[str]]) -> None:
    columns = [{"name": str(k), "label": text, "field": str(k), "align": "left"} for k, text in enumerate(head)]
    made = [{"id": k, **{str(j): cell for j, cell in enumerate(row)}} for k, row in enumerate(rows)]
    ui.table(columns=columns, rows=made, row_key="id").props("dense flat wrap-cells").classes("w-full")


def _show_sweep(page: Page, one: Kept, address: str) -> None:
    if one.about.get("rows"):
        _table(one.about["head"], one.about["rows"])
    if page.bench.file(one.name, "sweep.png"):
        ui.element("img").props["src"] = f"{address}/sweep.png"


def show_compare(page: Page) -> None:
    """Two runs beside each other."""

    @ui.refreshable
    def comparison() -> None:
        runs = {one.name: one for one in page.bench.kept() if one.kind == "run" and page.bench.file(one.name, "run.h5")}
        if len(runs) < 2:
            ui.label("Two runs are needed to compare: change the design and run it again.").classes("text-gray-600")
            return
        names = {name: f"{one.about.get('when', '')}  {one.title}" for name, one in runs.items()}
        newest = list(runs)
        first = ui.select(names, value=newest[1], label="first").classes("w-full")
        second = ui.select(names, value=newest[0], label="second").classes("w-full")

        def compare() -> None:
            both = [str(first.value), str(second.value)]
            files = [str(page.bench.root / "runs" / name / "run.h5") for name in both]
            titles = [f"{name[:4]} {runs[name].title}"[:60] for name in both]
            page.bench.start("compare", " and ".join(name[:4] for name in both), {"files": files, "names": titles}, {})

        ui.button("Compare", on_click=compare).props('no-caps data-path="compare"')
        ui.label("The comparison is under Results.").classes("text-gray-600")

    comparison()
    page.comparison = comparison


def show_sweep(page: Page) -> None:
    """One input, some values."""

    @ui.refreshable
    def sweeps() -> None:
        listed = all_fields(page.bench.design, page.built.base)
        names = {
            path: f"{path.split('.')[0]}: {one.words}"
            for path, one in listed.items()
            if path.startswith(SWEEP_AXES)
            and not one.text
            and (path.startswith("page.") <= (page.bench.design.source == "page"))
        }
        path = ui.select(names, value="scene.speed_rpm", label="input", with_input=True).classes("w-full")
        values = (
            ui.input("values, with commas between", placeholder="1000, 2000, 3000")
            .classes("w-full")
            .props("stack-label")
        )
        values.props["data-path"] = "sweep.values"

        def sweep() -> None:
            try:
                labels, cases = swept(page, str(path.value), str(values.value))
            except ValueError as error:
                values.error = str(error)
                return
            values.error = None
            unit = page.bench.design.unit_of(listed[str(path.value)])
            axis = f"{names[str(path.value)]}{f' ({unit})' if unit else ''}"
            arguments = {"path": axis, "labels": labels, "cases": cases}
            page.bench.start("sweep", f"sweep of {axis}, {title(page.built)}", arguments, {})

        ui.button("Run the sweep", on_click=sweep).props('no-caps data-path="sweep"')
        ui.label(
            "Each value is a run of the design as it is, as long as Run says. The table is under Results."
        ).classes("text-gray-600")

    sweeps()
    page.sweeps = sweeps


def swept(page: Page, path: str, text: str) -> tuple[list[str], list[dict[str, Any]]]:
    """The cases of a sweep: the design with each of some values. A `ValueError` says which of them cannot be used."""
    labels = [part.strip() for part in text.split(",") if part.strip()]
    if not labels or len(labels) > MOST_VALUES or len(set(labels)) != len(labels):
        raise ValueError(f"must be 1 to {MOST_VALUES} different values with commas between")
    cases = []
    for label in labels:
        design = copy.deepcopy(page.bench.design)
        design.typed[path] = label
        made = built(design)
        if made.problems or made.subject is None:
            where, why = next(iter(made.problems.items()), ("", "cannot be made"))
            raise ValueError(f"{label}: {why if where == path else f'{where}: {why}'}")
        cases.append(made.tables)
    return labels, cases
