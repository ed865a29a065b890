"""A lock on a file that ends with the process that holds it, however that process ends."""

from __future__ import annotations

import errno
import fcntl
import os
import struct
from pathlib import Path
from typing import BinaryIO


def lock(stream: BinaryIO) -> BinaryIO:
    """An open file, locked: no other process, and no other part of this one, can lock it while it stays open.

    File systems without locks let it pass.

    Raises
    ------
    OSError
        If another one holds the lock (errno EBUSY); the file is closed then.
    """
    command = getattr(fcntl, "F_OFD_SETLK", None)
    if command is None:
        return stream
    try:
        fcntl.fcntl(stream, command, _request(fcntl.F_WRLCK))
    except OSError as error:
        if error.errno in (errno.EINVAL, errno.EOPNOTSUPP, errno.ENOLCK):
            return stream
        stream.close()
        if error.errno in (errno.EAGAIN, errno.EACCES):
            raise _busy() from None
        raise
    return stream


def take_lock(path: Path) -> BinaryIO:
    """A file that is there, opened and locked.

    Raises
    ------
    OSError
        If another one holds the lock (errno EBUSY), or it cannot be opened.
    """
    # links are not followed, and what is no file cannot make it wait
    flags = os.O_RDWR | os.O_CLOEXEC | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
    stream = lock(os.fdopen(os.open(path, flags), "r+b"))
    if not is_same(path, stream):
        stream.close()
        raise _busy()
    return stream


def is_locked(path: Path) -> bool:
    """Whether another one holds the lock of a file; False where that cannot be found out.

    Raises
    ------
    OSError
        If the file cannot be opened.
    """
    command = getattr(fcntl, "F_OFD_GETLK", None)
    if command is None:
        return False
    with path.open("rb") as stream:
        try:
            answer = fcntl.fcntl(stream, command, _request(fcntl.F_WRLCK))
        except OSError:
            return False
    return bool(struct.unpack_from("h", answer)[0] != fcntl.F_UNLCK)


def is_same(path: Path, stream: BinaryIO) -> bool:
    """Whether a name still belongs to an open file."""
    try:
        named = path.stat()
    except OSError:
        return False
    return os.path.samestat(named, os.fstat(stream.fileno()))


def _busy() -> OSError:
    return OSError(errno.EBUSY, "another run is writing it")


def _request(kind: int) -> bytes:
    return struct.pack("hhqqi4x", kind, os.SEEK_SET, 0, 1, 0)
