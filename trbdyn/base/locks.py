"""A lock on a file that ends with the process that holds it, however that process ends.

Linux has locks that belong to an open file and may be set on the file itself: HDF5, which locks the file in another way, is not
disturbed, and the lock goes along when the file gets another name or is used over a network. On other systems the lock is that
of a second, empty file in the folder for temporary files, named after the identity of the first one (device and number): it goes
along, too, but holds for the processes of one user only.
"""

from __future__ import annotations

import errno
import os
import stat
import struct
import tempfile
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Self

try:
    import fcntl
except ImportError:
    fcntl = None  # type: ignore[assignment]

_FCNTL: Any = fcntl if hasattr(fcntl, "F_OFD_SETLK") else None

OPEN_FILES_MOVE = not hasattr(os, "O_BINARY")
"""Whether a file that is open can be renamed and removed: not on Windows."""


class LockedFile:
    """A file that is locked: no other process, and no other part of this one, can lock it before `close`. An OSError (EBUSY) if
    another one holds the lock; the open file is closed then, as it is with the lock.

    It also stays open, for `stream`, where an open file can be renamed; elsewhere `stream` is None.
    """

    def __init__(self, stream: BinaryIO) -> None:
        self.stream: BinaryIO | None = stream
        found = os.fstat(stream.fileno())
        self._identity = found.st_dev, found.st_ino
        self._guard: Any = None
        try:
            if _FCNTL is not None:
                _lock_itself(stream)
            else:
                self._guard = _guard(found)
                self._guard.acquire(timeout=0)
        except BaseException as error:
            stream.close()
            if isinstance(error, TimeoutError):
                raise _busy() from None
            raise
        if not OPEN_FILES_MOVE:
            stream.close()
            self.stream = None

    def is_at(self, path: Path) -> bool:
        """Whether a name belongs to this file."""
        try:
            named = path.stat()
        except OSError:
            return False
        return (named.st_dev, named.st_ino) == self._identity

    def close(self) -> None:
        """Let go of the file and of its lock."""
        if self.stream is not None:
            self.stream.close()
        if self._guard is not None:
            self._guard.release()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def take_lock(path: Path) -> LockedFile:
    """Lock a file that is there; an OSError (EBUSY) if another one holds the lock."""
    # links are not followed, and what is no file cannot make it wait
    locked = LockedFile(os.fdopen(os.open(path, os.O_RDWR | flags("O_CLOEXEC", "O_NOFOLLOW", "O_NONBLOCK")), "r+b"))
    if not locked.is_at(path):
        locked.close()
        raise _busy()
    return locked


def is_locked(path: Path) -> bool:
    """Whether another one holds the lock of a file; False where that cannot be found out."""
    with path.open("rb") as stream:
        try:
            if _FCNTL is not None:
                answer = _FCNTL.fcntl(stream, _FCNTL.F_OFD_GETLK, _request(_FCNTL.F_WRLCK))
                return bool(struct.unpack_from("h", answer)[0] != _FCNTL.F_UNLCK)
            with _guard(os.fstat(stream.fileno())).acquire(timeout=0):
                return False
        except TimeoutError:
            return True
        except OSError:
            return False


def flags(*names: str) -> int:
    """Flags of `os.open`, those that this system has."""
    value = 0
    for name in names:
        value |= getattr(os, name, 0)
    return value


def _lock_itself(stream: BinaryIO) -> None:
    try:
        _FCNTL.fcntl(stream, _FCNTL.F_OFD_SETLK, _request(_FCNTL.F_WRLCK))
    except OSError as error:
        if error.errno in (errno.EAGAIN, errno.EACCES):
            raise _busy() from None
        if error.errno not in (errno.EINVAL, errno.EOPNOTSUPP, errno.ENOLCK):
            raise


def _guard(found: os.stat_result) -> Any:
    """The lock of filelock for a file of this identity; Linux needs no filelock."""
    from filelock import FileLock

    folder = Path(tempfile.gettempdir()) / f"trbdyn-locks-{os.getuid() if hasattr(os, 'getuid') else 'user'}"
    folder.mkdir(mode=0o700, exist_ok=True)
    owner = folder.lstat()
    if not stat.S_ISDIR(owner.st_mode) or (hasattr(os, "getuid") and owner.st_uid != os.getuid()):
        raise PermissionError(errno.EPERM, "the folder of locks belongs to somebody else", str(folder))
    return FileLock(folder / f"{found.st_dev:x}-{found.st_ino:x}.lock", thread_local=False)


def _busy() -> OSError:
    return OSError(errno.EBUSY, "another run is writing it")


def _request(kind: int) -> bytes:
    return struct.pack("hhqqi4x", kind, os.SEEK_SET, 0, 1, 0)
