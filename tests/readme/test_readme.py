"""The README and the pages that it sends its readers to are true: every command and sample runs as written, from the checkout's
root, without environment variables. In the pages of the documentation `python` is that of the environment.

The root is a copy of the checkout's files whose `.venv` is the environment that runs these tests, so that nothing is written
into the checkout. Commands that run the tests, the checks of style, sanitizers, fuzzing or all benchmarks would run this file
again or take hours: of those `make` is asked whether it knows them. Commands that take minutes are marked slow.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = ("README.md", *(f"docs/{name}.md" for name in ("install", "validation", "promises", "design", "command_line")))
SECTIONS = {
    "README.md": (
        "In Python",
        "Your own bearing",
        "What it can do, and what not",
        "How fast, how accurate",
        "Where to read on",
    ),
    "docs/install.md": ("From the checkout", "From a wheel", "Into another environment", "Which systems"),
    "docs/validation.md": ("What accuracy costs", "Friction torque beside measured values"),
    "docs/promises.md": ("To the last bit", "No silent wrong answer"),
    "docs/design.md": ("The folders",),
    "docs/tutorials/reading_a_result.md": ("Words that are easily mixed up",),
}
FENCE = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)
CELL = re.compile(r"^```\{.*?^```$", re.MULTILINE | re.DOTALL)  # code cells are run by tests/docs
COMMAND = re.compile(r"`((?:\.venv/bin/|\.ci/|make |pip |python3? )[^`]*)`")
LINK = re.compile(r"\]\(([^)#]+)[^)]*\)")

WHOLE = {
    "make docs",
    "make figures",
    "make wheels",
    "make test",
    "make lint",
    "make format",
    "make bench",
    "make stability",
    "make fuzz",
    "make adversary",
    "make mutate",
    "make sanitize",
    "make walk",
    "make cross",
    ".ci/run",
    ".venv/bin/pytest",
}
INSTALLS = {"pip install .", "pip install -e .", 'pip install ".[app]"'}
RELEASED = {"pip install trbdyn", 'pip install "trbdyn[notebooks]"', 'pip install "trbdyn[app]"'}
WHEEL = re.compile(r"pip install trbdyn-([\d.]+)-cp311-abi3-(manylinux_\d+_\d+)_x86_64\.whl")
MINUTES = {
    ".venv/bin/python benchmarks/work_precision.py",
    ".venv/bin/python benchmarks/validation",
    "python benchmarks/paper",
}
SHORTER = {  # options that the page or the command itself names
    ".venv/bin/python benchmarks/work_precision.py": " --quick",
    ".venv/bin/python benchmarks/validation": " --quick",
    "python benchmarks/paper": " --help",
}
SLOWER = (
    "make demo",
    "python -m trbdyn plot ",
    "python -m trbdyn run pair_30310 ",
    "python -m trbdyn ensemble ",
    "python -m trbdyn plan ",
    "python -m trbdyn torque ",
    "python -m trbdyn sweep cage_mass -o study",
    "python tests/adversary/adversary.py ",
    "python benchmarks/ordinary.py",
    "python docs/recorded.py demo",
)
TIME_GIVEN = re.compile(
    r"(?<=--minutes )[\d.]+"
)  # commands that work for as long as they are told to: here for some seconds
HELPFUL = ("PYTHON", "MPL", "VIRTUAL_ENV", "MAKE", "MFLAGS", "PYTEST", "SLOW", "QUICK", "BENCH")
PARTS = "tests/api/test_promises.py tests/geometry/test_derived.py"

pytestmark = pytest.mark.skipif(
    not (ROOT / "Makefile").is_file(), reason="the Makefile is not part of a source distribution"
)


def text_of(page: str) -> str:
    path = ROOT / page
    return CELL.sub("", path.read_text(encoding="utf-8")) if path.is_file() else ""


def blocks(language: str, pages: tuple[str, ...] = PAGES) -> list[str]:
    return [body for page in pages for name, body in FENCE.findall(text_of(page)) if name == language]


def commands(pages: tuple[str, ...] = PAGES) -> list[str]:
    """Commands of the shell blocks and of the text, each once, in the order of the pages; not those with a place to fill in."""
    lines = [line.partition("#")[0].strip() for body in blocks("sh", pages) for line in body.splitlines()]
    outside = [command for page in pages for command in COMMAND.findall(FENCE.sub("", text_of(page)))]
    return [
        command for command in dict.fromkeys([line for line in lines if line] + outside) if "COMMAND" not in command
    ]


def is_wheel(command: str) -> bool:
    return WHEEL.fullmatch(command) is not None


def environment() -> dict[str, str]:
    """The environment without what would help Python to find the package, and without what a make around the tests sets."""
    return {name: value for name, value in os.environ.items() if not name.startswith(HELPFUL)}


def run(command: str, root: Path, timeout: float = 300.0) -> str:
    env = environment()
    if command.startswith("python "):
        env["PATH"] = f"{root / '.venv' / 'bin'}{os.pathsep}{env['PATH']}"
    with subprocess.Popen(
        command,
        shell=True,
        cwd=root,
        env=env,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as started:
        try:
            out, err = started.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            os.killpg(started.pid, signal.SIGKILL)  # with the processes that it has started itself
            raise
    assert started.returncode == 0, f"{command}\n{out[-2000:]}\n{err[-4000:]}"
    return out


def copy_of_checkout(folder: Path) -> Path:
    """The files of the checkout (not what was built), with the times that they have there."""
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    names = listed.stdout.splitlines()
    if listed.returncode or not names:
        pytest.skip("the files of the checkout are not known without git")
    for name in names:
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, folder / name)
    return folder


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    folder = copy_of_checkout(tmp_path_factory.mktemp("readme"))
    (folder / ".venv").symlink_to(sys.prefix, target_is_directory=True)
    (folder / "build").mkdir()
    if (ROOT / "build" / ".package").is_file():
        shutil.copy2(ROOT / "build" / ".package", folder / "build" / ".package")
    yield folder
    (folder / ".venv").unlink()


def test_the_readme_has_commands_and_samples() -> None:
    assert len(commands()) > 20
    assert len(blocks("python", ("README.md",))) == 2
    assert set(commands()) >= MINUTES | INSTALLS
    assert commands(("README.md",))[:2] == ["make demo", "make test"]


def test_the_readme_is_short() -> None:
    assert len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()) <= 120
    own = next(body for body in blocks("python", ("README.md",)) if "from_catalogue" in body)
    assert all(len(body.splitlines()) <= 10 for body in (own, *blocks("python", ("README.md",))))


@pytest.mark.parametrize("page", SECTIONS)
def test_what_the_readme_had_is_found(page: str) -> None:
    headings = re.findall(r"^## (.*)$", text_of(page), re.MULTILINE)
    assert set(SECTIONS[page]) <= set(headings)


def test_links_of_the_readme_lead_somewhere() -> None:
    targets = [target for target in LINK.findall(text_of("README.md")) if "://" not in target]
    assert {"docs/install.md", "docs/promises.md", "docs/validation.md", "docs/theory/index.md"} <= set(targets)
    for target in targets:
        assert (ROOT / target).exists(), target


def test_the_wheel_is_the_one_that_is_made() -> None:
    named = [found.groups() for command in commands() if (found := WHEEL.fullmatch(command))]
    made = re.search(r"manylinux_\d+_\d+", (ROOT / ".ci" / "wheels").read_text(encoding="utf-8"))
    version = re.search(r'^version = "(.*)"', (ROOT / "pyproject.toml").read_text(encoding="utf-8"), re.MULTILINE)
    assert made is not None
    assert version is not None
    assert named == [(version.group(1), made.group())]


def different() -> list[str]:
    """Commands that take seconds; one that runs the same program with the same words under another name of Python only once."""
    found = [
        command for command in commands() if command not in MINUTES | INSTALLS | RELEASED and not is_wheel(command)
    ]
    first: dict[str, str] = {}
    for command in found:
        first.setdefault(command.removeprefix(".venv/bin/"), command)
    return list(first.values())


def with_marks(command: str) -> Any:
    """The command, among the slow tests if it takes many seconds and has tests of its own."""
    return pytest.param(
        command, marks=[pytest.mark.slow] if command.removeprefix(".venv/bin/").startswith(SLOWER) else []
    )


@pytest.mark.parametrize("command", [with_marks(command) for command in different()])
def test_commands(command: str, root: Path) -> None:
    if command in WHOLE:
        if command.startswith("make "):
            run(command.replace("make ", "make -n "), root)
        elif command == ".venv/bin/pytest":
            assert "skipped" not in run(f"{command} -q {PARTS}", root)
        else:
            assert os.access(root / command, os.X_OK), command
        return
    if command.startswith("make "):
        # where make would install first, it would put the copy in place of the checkout
        assert "pip" not in run(command.replace("make ", "make -n "), root), "run make install first"
    if " run " in command:
        forget(root)
    elif file := re.search(r" (\w+\.h5)", command):
        write_run(root / file[1])
    run(TIME_GIVEN.sub("0.01", command), root)


def forget(root: Path) -> None:
    """Results of commands before: a new run does not replace them."""
    for place in (
        place for kind in ("*.h5", "*.checkpoint*", "*.png", "*.html", "*.json") for place in root.glob(kind)
    ):
        place.unlink()


def write_run(path: Path) -> None:
    """A run for the commands that read one, whichever test comes first."""
    if not path.exists():
        words = f"-o {path.name} --revolutions 1 --checkpoint-every 0.01 --quiet"
        run(f".venv/bin/python -m trbdyn run rig_30310 {words}", path.parent)


def with_mark(sample: str) -> Any:
    """Fifty turns are among the slow tests: the same sample runs for one turn in tests/api/test_without_extras.py."""
    return pytest.param(sample, marks=[pytest.mark.slow] if "revolutions=50" in sample else [])


@pytest.mark.parametrize("sample", [with_mark(sample) for sample in blocks("python")])
def test_samples(sample: str, root: Path) -> None:
    forget(root)
    (root / "sample.py").write_text(sample, encoding="utf-8")
    run(".venv/bin/python sample.py", root)


@pytest.mark.slow
@pytest.mark.parametrize("command", sorted(MINUTES))
def test_commands_that_take_minutes(command: str, root: Path) -> None:
    assert command in commands()
    run(command + SHORTER.get(command, ""), root, timeout=1800.0)


def test_missing_core_is_explained(tmp_path: Path) -> None:
    """Sources that nobody built say what to do."""
    shutil.copytree(ROOT / "trbdyn", tmp_path / "trbdyn", ignore=shutil.ignore_patterns("*.so", "__pycache__"))
    packages = [entry for entry in sys.path if entry.endswith("site-packages")]
    code = f"import sys; sys.path += {packages!r}; from trbdyn import _core"
    done = subprocess.run(
        [sys.executable, "-S", "-c", code], cwd=tmp_path, env=environment(), capture_output=True, text=True
    )
    assert done.returncode == 1
    assert "make install" in done.stderr.splitlines()[-1]


@pytest.mark.slow
def test_a_fresh_clone(tmp_path: Path) -> None:
    """Everything from nothing: environment, build, demo, run, sample, plain pytest; and the package in another environment."""
    clone = copy_of_checkout(tmp_path)
    run("make demo", clone, timeout=1800.0)
    assert (clone / "demo" / "cage_locus.png").is_file()
    installed = run(".venv/bin/python -m pip list --exclude-editable", clone)
    assert "pytest" not in installed
    assert "distributed" not in installed
    for sample in blocks("python"):
        run(f".venv/bin/python - <<'END'\n{sample}\nEND", clone)
    for command in commands():
        if "-m trbdyn run" in command:
            run(command, clone)
    for number, command in enumerate(sorted(INSTALLS)):
        run(f"{sys.base_prefix}/bin/python3 -m venv other{number}", clone)
        run(f"other{number}/bin/python -m {command} -q", clone, timeout=1800.0)
        run(f"cd / && {clone}/other{number}/bin/python -m trbdyn cases", clone)
    assert "installing" not in run("make install", clone)
    run("make test PYTEST='-k test_laws_api'", clone, timeout=1800.0)
    assert "skipped" not in run(f".venv/bin/pytest -q {PARTS}", clone)


@pytest.mark.parametrize("path", sorted((ROOT / "notebooks").glob("*.ipynb")), ids=lambda path: path.stem)
def test_notebooks_show_their_outputs(path: Path) -> None:
    """Read on a web page they show numbers and pictures; `make notebooks` writes them."""
    cells = [cell for cell in json.loads(path.read_text(encoding="utf-8"))["cells"] if cell["cell_type"] == "code"]
    outputs = [output for cell in cells for output in cell["outputs"]]
    assert all(cell["execution_count"] for cell in cells)
    assert any("image/png" in output.get("data", {}) for output in outputs)
    assert any(output["output_type"] == "stream" for output in outputs)
    assert not any(output["output_type"] == "error" or output.get("name") == "stderr" for output in outputs)
