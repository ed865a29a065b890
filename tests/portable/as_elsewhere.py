"""Takes away from this Python what Windows lacks, as far as that can be done on another system.

Imported as ``sitecustomize``, so that the processes of a study start in that state, too. Modules that only Unix has cannot be
imported by trbdyn or by what it uses; the standard library, and psutil, which is another one on each system, keep theirs.
Functions and flags of `os` that only Unix has are away from trbdyn. A file that is open can be neither renamed nor removed,
nothing is replaced by `os.rename`, and a folder cannot be opened.
"""

import builtins
import errno
import os
import sys

MODULES = {"fcntl", "resource", "pwd", "grp", "termios", "pty", "tty", "posix", "syslog", "crypt", "readline", "curses"}
FLAGS = {"O_CLOEXEC", "O_NOFOLLOW", "O_NONBLOCK", "O_DIRECTORY", "O_SYNC", "O_DSYNC"}
FILES = {"pread", "pwrite", "preadv", "posix_fallocate", "statvfs", "mkfifo", "chown", "fchmod", "set_blocking", "sync"}
PROCESSES = {
    "fork",
    "forkpty",
    "wait",
    "nice",
    "register_at_fork",
    "sched_getaffinity",
    "killpg",
    "setsid",
    "getpriority",
}
USERS = {"getuid", "geteuid", "getgid", "getpgid", "uname", "sysconf", "getloadavg"}
SIGNALS = {"SIGKILL", "SIGHUP", "SIGALRM", "SIGUSR1", "SIGUSR2", "SIGCHLD", "SIGPIPE", "SIGQUIT", "setitimer", "alarm"}
real_import = builtins.__import__


class Lacking:
    """A module without some of its names."""

    def __init__(self, module, names, more=()):
        self.__dict__.update({name: value for name, value in vars(module).items() if name not in names})
        self.__dict__.update(more)


def without_posix(name, globals=None, locals=None, fromlist=(), level=0):
    caller = (globals or {}).get("__name__") or ""
    top = caller.partition(".")[0]
    if (
        level == 0
        and name in MODULES
        and top not in sys.stdlib_module_names
        and top not in ("psutil", "_pytest", "__mp_main__")
    ):
        raise ModuleNotFoundError(f"No module named {name!r}", name=name)
    module = real_import(name, globals, locals, fromlist, level)
    if top == "trbdyn" and level == 0 and name in ("os", "signal"):
        return LACKING_OS if name == "os" else Lacking(module, SIGNALS)
    return module


def is_open(path):
    """Whether this process has a file open."""
    try:
        there = os.stat(path, follow_symlinks=False)
    except OSError:
        return False
    for number in os.listdir("/proc/self/fd"):
        try:
            found = os.fstat(int(number))
        except OSError:
            continue
        if (found.st_dev, found.st_ino) == (there.st_dev, there.st_ino):
            return True
    return False


def refuse_open(*paths):
    for path in paths:
        if is_open(path):
            raise PermissionError(errno.EACCES, "the file is used by a process (as on Windows)", str(path))


def replace(source, target):
    refuse_open(source, target)
    real["replace"](source, target)


def rename(source, target):
    if os.path.lexists(target):
        raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(target))
    refuse_open(source)
    real["rename"](source, target)


def unlink(path, *, dir_fd=None):
    refuse_open(path)
    real["unlink"](path, dir_fd=dir_fd)


def link(source, target, *, follow_symlinks=True):
    if not follow_symlinks:
        raise NotImplementedError("link: follow_symlinks unavailable on this platform")
    real["link"](source, target)


def open_file(path, flags, mode=0o777, *, dir_fd=None):
    if os.path.isdir(path):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
    return real["open"](path, flags, mode, dir_fd=dir_fd)


real = {name: getattr(os, name) for name in ("replace", "rename", "unlink", "link", "open")}
CHANGED = {
    "replace": replace,
    "rename": rename,
    "unlink": unlink,
    "remove": unlink,
    "link": link,
    "open": open_file,
    "O_BINARY": 0,
}
LACKING_OS = Lacking(os, FLAGS | FILES | PROCESSES | USERS, CHANGED)
builtins.__import__ = without_posix
for changed in CHANGED:
    setattr(os, changed, CHANGED[changed])  # pathlib calls them
