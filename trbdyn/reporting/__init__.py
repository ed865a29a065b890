"""A report of a run, or of two side by side: one HTML file to mail, and a PDF where a converter is there."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from trbdyn.base.expected import expect
from trbdyn.base.own_files import output_path, write_whole
from trbdyn.base.shown import Displayed
from trbdyn.errors import FileError, InputError, unknown_name
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.result import Result
from trbdyn.results.sources import files_of
from trbdyn.run.check import check

__all__ = ["judgement", "report", "save_pdf"]

HTML: Final = (".html", ".htm")
PDF: Final = (".pdf",)
CONVERTERS: Final = ("chromium", "chromium-browser", "google-chrome", "chrome", "chromium-headless-shell")


def report(
    result: Result | AssemblyResult,
    path: str | os.PathLike[str],
    *,
    other: Result | AssemblyResult | None = None,
    names: Sequence[str] = ("first", "second"),
    title: str = "",
    pictures: Sequence[str] | None = None,
    tables: Sequence[Displayed] = (),
    check_budget_s: float | None = None,
    reliability: float = 90.0,
    pdf: bool = False,
    overwrite: bool = False,
) -> Path:
    """Write a report of a run as one HTML file that needs nothing else.

    It begins with a sheet to sign: inputs, given, estimated and assumed, verdicts and margins, file, date and version. Then it
    says what was simulated (drawing, inputs with the assumed and estimated ones marked), gives a verdict in sentences, pictures,
    and every number with its unit and what it means.

    Parameters
    ----------
    result : Result or AssemblyResult
        The run. Of an assembly the page has the shaft first, and then each bearing.
    path : path-like
        HTML file to write, ``NAME.html``.
    other : Result or AssemblyResult, optional
        A second run to compare with: of one bearing, or of bearings with the same names.
    names : sequence of str
        What the two runs are called.
    title : str
        Title; by default the bearing's name.
    pictures : sequence of str, optional
        Names of the pictures, of those in `trbdyn.plot.PICTURES` or of an assembly; by default all that the recorded groups
        allow.
    tables : sequence
        Further tables to show below, as those of `trbdyn.fit`, `trbdyn.preload_over` and `trbdyn.least_load`.
    check_budget_s : float, optional
        Processor time for the check of each run (`trbdyn.check`), which says what tolerances do to its numbers (s); by default
        2 s or a tenth of that of the run. 0: no check.
    reliability : float
        Of the rating lives: 90, 95, 96, 97, 98 or 99 (%).
    pdf : bool
        Also write a PDF beside it; needs Chromium.
    overwrite : bool
        Replace files that are there; never the file of a result that is reported.

    Returns
    -------
    Path
        The HTML file.

    Raises
    ------
    InputError
        If a picture is unknown, names are not two, or the file's name does not end in .html.
    FileError
        If a file is there and shall not be replaced, or cannot be written, or there is no converter for the PDF.

    Examples
    --------
    >>> import tempfile, trbdyn as trb
    >>> result = trb.Simulation(trb.cases.scene_30310(3000.0, 4930.0)).run(revolutions=0.5)
    >>> path = trb.report(result, tempfile.mkdtemp() + "/report.html", pictures=["cage_locus"])
    >>> "The energy adds up" in path.read_text()
    True
    """
    from trbdyn.plot import PICTURES
    from trbdyn.plot.assembly import of_result
    from trbdyn.reporting.page import page

    expect("result", result, Result, AssemblyResult)
    known = {*PICTURES, *of_result(result)}
    for name in pictures or ():
        if name not in known:
            raise InputError.of("pictures", name, unknown_name(name, known))
    if len(names) != 2 or isinstance(names, str):
        raise InputError.of("names", names, "must be two names")
    for index, one in enumerate(tables):
        expect(f"tables[{index}]", one, Displayed)
    shown = [one._shown() for one in tables]
    how: dict[str, Any] = {"overwrite": overwrite, "reads": [*files_of(result), *files_of(other)]}
    target = output_path(path, endings=HTML, field="path", **how)  # before the pictures are drawn, which takes a while
    if pdf:
        output_path(target.with_suffix(".pdf"), field="path", **how)
    results: list[Result | AssemblyResult] = [result] if other is None else [result, other]
    bearings = [list(one.by_name) for one in results]
    if bearings[0] != bearings[-1]:
        limit = (
            f"must be a run of the same bearings, {', '.join(bearings[0])}, to be compared with"
            if len(bearings[0]) > 1
            else "must be a run of one bearing, as the first is"
        )
        raise InputError.of("other", ", ".join(bearings[-1]) or "one bearing", limit)
    checked = check_budget_s != 0.0 and all(one.time.size > 1 for one in results)
    checks = [check(one, budget_s=check_budget_s) for one in results] if checked else ()
    text = page(results, list(names[: len(results)]), title, pictures, shown, checks, reliability)
    written = write_whole(path, text, endings=HTML, **how)
    if pdf:
        save_pdf(written, written.with_suffix(".pdf"), overwrite=overwrite)
    return written


def judgement(result: Result) -> list[tuple[str, str, str]]:
    """What a run says of life, cage, hits, torque, films and pressures: grade ('good', 'care', 'bad' or 'plain'), headline,
    sentence.
    """
    from trbdyn.reporting.page import judgement

    return judgement(result)


def converter() -> str | None:
    """The program that can print an HTML file as PDF, if this machine has one."""
    return next((path for name in CONVERTERS if (path := shutil.which(name))), None)


def save_pdf(page: str | os.PathLike[str], path: str | os.PathLike[str], *, overwrite: bool = False) -> Path:
    """Print an HTML file as PDF.

    Parameters
    ----------
    page : path-like
        HTML file.
    path : path-like
        PDF to write.
    overwrite : bool
        Replace a file that is there.

    Returns
    -------
    Path
        The PDF.

    Raises
    ------
    FileError
        If this machine has no converter, or it fails; if the file is there and shall not be replaced, or cannot be written.
    """
    program = converter()
    if program is None:
        raise FileError("a PDF needs Chromium or Chrome on this machine; the HTML report prints from any browser")
    output_path(path, overwrite=overwrite, field="path", endings=PDF, reads=[page])
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / "page.pdf"
        command = [
            program,
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            f"--user-data-dir={folder}",
            "--no-pdf-header-footer",
            f"--print-to-pdf={made}",
            Path(page).resolve().as_uri(),
        ]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=180, check=False)
            if done.returncode == 0:
                return write_whole(path, made.read_bytes(), overwrite=overwrite, endings=PDF, reads=[page])
        except FileNotFoundError:
            pass
        except subprocess.TimeoutExpired as error:
            raise FileError(f"{path}: the PDF cannot be written: {error}") from error
    raise FileError(f"{path}: the PDF cannot be written: {done.stderr.strip()[-300:]}")
