"""How a command ends: exit codes, and what is said about an error."""

from __future__ import annotations

import argparse
import io
import os
import sys
import traceback
from collections.abc import Callable
from typing import NoReturn, TextIO

from trbdyn.base.printable import printable
from trbdyn.errors import FileError, InputError, LoadError, MissingExtra, TrbError

DONE, FAILED, BAD_INPUT, FAULT, INTERRUPTED = 0, 1, 2, 3, 130


def let_any_name_be_printed() -> None:
    """Let names of files that hold any bytes be printed: what the terminal cannot show is escaped."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def run_command(command: Callable[[argparse.Namespace], int], options: argparse.Namespace) -> int:
    """Run a command; what it raises becomes a line on stderr and an exit code."""
    try:
        return command(options)
    except (InputError, LoadError, FileError, MissingExtra) as error:
        return report_error(error, BAD_INPUT, options.debug)
    except TrbError as error:
        return report_error(error, FAILED, options.debug)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    except KeyboardInterrupt:
        say("trbdyn: stopped", file=sys.stderr)
        return INTERRUPTED
    except (OSError, MemoryError) as error:
        return report_error(error, BAD_INPUT, options.debug)
    except Exception as error:
        return report_error(error, FAULT, options.debug)


def report_error(error: Exception, code: int, debug: bool) -> int:
    """Say what went wrong, with one line for each problem."""
    if debug:
        traceback.print_exception(error)
    lines = [str(error)]
    if isinstance(error, InputError):
        lines = [problem.line(error.root) for problem in error.problems]
    elif isinstance(error, MemoryError):
        lines = [f"there is not enough memory {error}".strip()]
    elif code == FAULT:
        lines = [f"a fault of trbdyn itself, please report it: {type(error).__name__}: {error} (--debug shows where)"]
    for line in lines:
        say(f"trbdyn: {printable(line)}", file=sys.stderr)
    return code


def say(*values: object, sep: str = " ", end: str = "\n", file: TextIO | None = None) -> None:
    """Print texts, whose signs cannot move the cursor: names and messages come from users, and from files of others."""
    print(printable(sep.join(map(str, values)), lines=True), end=end, file=file)


class Parser(argparse.ArgumentParser):
    """A parser that says what is wrong in one line."""

    def error(self, message: str) -> NoReturn:
        self.exit(BAD_INPUT, f"{self.prog}: {printable(message)} (--help shows what is allowed)\n")
