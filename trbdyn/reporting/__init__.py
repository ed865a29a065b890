"""A report of a run, or of two side by side: one HTML file to mail, and a PDF where a converter is there."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

from trbdyn.base.expected import expect
from trbdyn.errors import FileError, InputError, unknown_name
from trbdyn.results.assembly import AssemblyResult
from trbdyn.results.result import Result

__all__ = ["report", "save_pdf"]

CONVERTERS = ("chromium", "chromium-browser", "google-chrome", "chrome", "chromium-headless-shell")


def report(
    result: Result | AssemblyResult,
    path: str | os.PathLike[str],
    *,
    other: Result | None = None,
    names: Sequence[str] = ("first", "second"),
    title: str = "",
    pictures: Sequence[str] | None = None,
    pdf: bool = False,
) -> Path:
    """Write a report of a run as one HTML file that needs nothing else.

    It says what was simulated (drawing, inputs with the assumed and estimated ones marked), gives a verdict in
    sentences, pictures, and every number with its unit and what it means.

    Parameters
    ----------
    result : Result or AssemblyResult
        The run. Of an assembly the page has the shaft first, and then each bearing.
    path : path-like
        HTML file to write.
    other : Result, optional
        A second run to compare with.
    names : sequence of str
        What the two runs are called.
    title : str
        Title; by default the bearing's name.
    pictures : sequence of str, optional
        Names of the pictures, of those in `trbdyn.plot.PICTURES` or of an assembly; by default all that the recorded groups
        allow.
    pdf : bool
        Also write a PDF beside it; needs Chromium.

    Returns
    -------
    Path
        The HTML file.

    Raises
    ------
    InputError
        If a picture is unknown, or names are not two.
    FileError
        If a file cannot be written, or there is no converter for the PDF.

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
    from trbdyn.reporting.page import page, page_of_assembly

    expect("result", result, Result, AssemblyResult)
    known = {*PICTURES, *(() if isinstance(result, Result) else of_result(result))}
    for name in pictures or ():
        if name not in known:
            raise InputError.of("pictures", name, unknown_name(name, known))
    if len(names) != 2 or isinstance(names, str):
        raise InputError.of("names", names, "must be two names")
    if isinstance(result, Result):
        results = [result] if other is None else [result, other]
        heading = title or f"Report: {' and '.join(dict.fromkeys(run.scene.bearing.name for run in results))}"
        text = page(results, list(names[: len(results)]), heading, pictures)
    elif other is not None:
        raise InputError.of("other", other, "must not be given: assemblies are reported one by one")
    else:
        text = page_of_assembly(result, title or f"Report: {', '.join(result)} on one shaft", pictures)
    target = Path(path)
    try:
        target.write_text(text, encoding="utf-8")
    except OSError as error:
        raise FileError(f"{target}: the report cannot be written: {error.strerror}") from error
    if pdf:
        save_pdf(target, target.with_suffix(".pdf"))
    return target


def converter() -> str | None:
    """The program that can print an HTML file as PDF, if this machine has one."""
    return next((path for name in CONVERTERS if (path := shutil.which(name))), None)


def save_pdf(page: str | os.PathLike[str], path: str | os.PathLike[str]) -> Path:
    """Print an HTML file as PDF.

    Parameters
    ----------
    page : path-like
        HTML file.
    path : path-like
        PDF to write.

    Returns
    -------
    Path
        The PDF.

    Raises
    ------
    FileError
        If this machine has no converter, or it fails.
    """
    program = converter()
    if program is None:
        raise FileError("a PDF needs Chromium or Chrome on this machine; the HTML report prints from any browser")
    target = Path(path).resolve()
    with tempfile.TemporaryDirectory() as profile:
        command = [
            program,
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            f"--user-data-dir={profile}",
            "--no-pdf-header-footer",
            f"--print-to-pdf={target}",
            Path(page).resolve().as_uri(),
        ]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=180, check=False)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise FileError(f"{target}: the PDF cannot be written: {error}") from error
    if done.returncode != 0 or not target.exists():
        raise FileError(f"{target}: the PDF cannot be written: {done.stderr.strip()[-300:]}")
    return target
