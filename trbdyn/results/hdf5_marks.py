"""Marks that a writer leaves in an HDF5 file, and how to read a file whose writer was killed.

A file that is being written in SWMR mode is marked so in its superblock. If the writer is killed the mark stays: HDF5 then opens
the file in SWMR mode only, where it waits for minutes on anything that is damaged. A lock that ends with the writer's process
tells the two apart; a file without a writer is read through a superblock that is put in order.
"""

from __future__ import annotations

import errno
import fcntl
import io
import os
import struct
from pathlib import Path
from typing import Any, BinaryIO

import h5py

from trbdyn.base.own_files import is_same

SIGNATURE = b"\x89HDF\r\n\x1a\n"
SIZE = 48
"""Bytes of a superblock of version 3 with addresses of 8 bytes."""
MARKS = 0b101
"""Open for writing, open for SWMR writing."""

_ALL_ONES = 0xFFFFFFFF


def take_lock(path: Path) -> BinaryIO:
    """A file that is there, opened so that no other process or writer can lock it while it stays open.

    Raises
    ------
    OSError
        If another one holds it (errno EBUSY), or it cannot be opened.
    """
    # links are not followed, and what is no file cannot make it wait
    flags = os.O_RDWR | os.O_CLOEXEC | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
    stream = lock(os.fdopen(os.open(path, flags), "r+b"))
    if not is_same(path, stream):
        stream.close()
        raise _busy()
    return stream


def lock(stream: BinaryIO) -> BinaryIO:
    """An open file, locked as by `take_lock`; closed if it cannot be.

    Raises
    ------
    OSError
        If another one holds it (errno EBUSY).
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


def _busy() -> OSError:
    return OSError(errno.EBUSY, "another run is writing it")


def is_locked(stream: BinaryIO) -> bool:
    """Whether a writer holds the lock of a file; True as well where that cannot be found out."""
    command = getattr(fcntl, "F_OFD_GETLK", None)
    if command is None:
        return True
    try:
        answer = fcntl.fcntl(stream, command, _request(fcntl.F_WRLCK))
    except OSError:
        return True
    return bool(struct.unpack_from("h", answer)[0] != fcntl.F_UNLCK)


def _request(kind: int) -> bytes:
    return struct.pack("hhqqi4x", kind, os.SEEK_SET, 0, 1, 0)


def open_to_read(path: Path) -> h5py.File:
    """An HDF5 file that is complete, is being written now, or whose writer was killed.

    Raises
    ------
    OSError
        If it cannot be read.
    """
    stream = path.open("rb")
    ordered = _in_order(stream)
    if ordered is None:
        stream.close()
        return h5py.File(path, "r")
    if is_locked(stream):
        stream.close()
        return h5py.File(path, "r", swmr=True)
    return h5py.File(_Patched(stream, ordered), "r")


def mend(path: Path) -> None:
    """Take the marks of a killed writer from a file, so that every HDF5 program can read it. Hold its lock."""
    with path.open("r+b") as stream:
        ordered = _in_order(stream)
        if ordered is not None:
            os.pwrite(stream.fileno(), ordered, 0)


def _in_order(stream: BinaryIO) -> bytes | None:
    """The superblock of a marked file without its marks, reaching to the file's end; None if the file is not marked."""
    block = bytearray(os.pread(stream.fileno(), SIZE, 0))
    if len(block) < SIZE or block[:8] != SIGNATURE or block[8] != 3 or block[9] != 8 or not block[11] & MARKS:
        return None
    if struct.unpack_from("<I", block, SIZE - 4)[0] != checksum(bytes(block[:-4])):
        return None
    block[11] = 0
    struct.pack_into("<Q", block, 28, os.fstat(stream.fileno()).st_size)
    struct.pack_into("<I", block, SIZE - 4, checksum(bytes(block[:-4])))
    return bytes(block)


class _Patched(io.RawIOBase):
    """A file read with other first bytes than it has."""

    def __init__(self, stream: BinaryIO, start: bytes) -> None:
        self._stream = stream
        self._start = start
        self._place = 0

    def readable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        base = {os.SEEK_SET: 0, os.SEEK_CUR: self._place}
        self._place = offset + (base[whence] if whence in base else os.fstat(self._stream.fileno()).st_size)
        return self._place

    def tell(self) -> int:
        return self._place

    def readinto(self, buffer: Any) -> int:
        count = os.preadv(self._stream.fileno(), [buffer], self._place)
        if self._place < len(self._start):
            part = self._start[self._place : self._place + count]
            memoryview(buffer).cast("B")[: len(part)] = part
        self._place += count
        return count

    def close(self) -> None:
        self._stream.close()
        super().close()


def checksum(data: bytes) -> int:
    """Checksum of HDF5's metadata (Bob Jenkins, lookup3)."""

    def turned(value: int, bits: int) -> int:
        return ((value << bits) | (value >> (32 - bits))) & _ALL_ONES

    a = b = c = (0xDEADBEEF + len(data)) & _ALL_ONES
    while len(data) > 12:
        x, y, z = struct.unpack_from("<III", data)
        a, b, c = (a + x) & _ALL_ONES, (b + y) & _ALL_ONES, (c + z) & _ALL_ONES
        for bits in (4, 6, 8, 16, 19, 4):
            a, b, c = (a - c) & _ALL_ONES ^ turned(c, bits), b, (c + b) & _ALL_ONES
            a, b, c = b, c, a
        data = data[12:]
    x, y, z = struct.unpack("<III", data.ljust(12, b"\0"))
    a, b, c = (a + x) & _ALL_ONES, (b + y) & _ALL_ONES, (c + z) & _ALL_ONES
    for bits in (14, 11, 25, 16, 4, 14, 24):
        c = ((c ^ b) - turned(b, bits)) & _ALL_ONES
        a, b, c = b, c, a
    return b
