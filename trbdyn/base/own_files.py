"""Files that a run makes, replaces and removes: only those that belong to it.

A file that is about to appear is written under a draft's name first. The draft is created exclusively: nothing that is
there already is opened, truncated or followed. It then takes its name in one step. A file that lies there is replaced
only where the caller says so.
"""

from __future__ import annotations

import errno
import hashlib
import os
import re
import shutil
import stat
import uuid
from collections.abc import Collection, Iterable
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, Final

from trbdyn.base.locks import OPEN_FILES_MOVE, LockedFile, flags, take_lock
from trbdyn.errors import FileError, InputError

LARGEST_HASHED: Final = 1 << 28
"""Largest file whose sum is taken (bytes)."""

LONGEST_NAME = 200
"""Most bytes of a file's name: file systems allow 255, and drafts and checkpoints have the name of the result in
theirs.
"""

LONGEST_PART, LONGEST_PATH = 255, 4000
"""Most bytes of a name and of a whole path that systems take."""

RESERVED = (".checkpoint", ".checkpoint.previous", ".new")
"""Endings of files that a run makes beside its result."""


def file_path(value: object, field: str) -> Path:
    """A path as users give it: a text or path-like that names a file; `field` is the argument's name in messages."""
    if not isinstance(value, str | os.PathLike):
        raise InputError.of(field, value, "must be the path of a file")
    text = os.fspath(value)
    if not isinstance(text, str):
        raise InputError.of(field, value, "must be the path of a file, as text")
    if not text or "\0" in text:
        raise InputError.of(field, value, "must name a file, without null characters")
    if not _is_encodable(text):
        raise InputError.of(field, value, "must name a file; it holds characters that no file name can have")
    path = Path(text)
    if any(len(os.fsencode(part)) > LONGEST_PART for part in path.parts) or len(os.fsencode(text)) > LONGEST_PATH:
        brief = text if len(text) <= 60 else f"{text[:30]}...{text[-27:]}"
        raise FileError(f"{brief}: the file name is too long: at most {LONGEST_NAME} bytes")
    if path.name in ("", "..") or text.endswith(os.sep):
        raise InputError.of(field, value, "must name a file, not a folder")
    return path


def folder_path(value: object, field: str) -> Path:
    """A path as users give it: a text or path-like that names a folder."""
    text = os.fspath(value) if isinstance(value, str | os.PathLike) else None
    if not isinstance(text, str) or not text or "\0" in text or not _is_encodable(text):
        raise InputError.of(field, value, "must be the path of a folder, without null characters")
    return Path(text)


def _is_encodable(text: str) -> bool:
    """Whether a file's name can have these characters."""
    try:
        os.fsencode(text)
    except UnicodeEncodeError:
        return False
    return True


def output_path(
    value: object,
    *,
    overwrite: bool,
    field: str = "output",
    endings: Collection[str] = (),
    reads: Iterable[str | os.PathLike[str]] = (),
) -> Path:
    """Where a file shall be written: with one of the `endings`, by default any, and none of the files that are read to make it
    (`reads`), which are never replaced. A symbolic link is followed: its target is written.

    An InputError if the path cannot be used, a FileError if there is no folder for it, or something lies there that must not be
    replaced.
    """
    path = file_path(value, field)
    if path.is_symlink():
        path = Path(os.path.realpath(path))
    if path.name.endswith(RESERVED):
        raise InputError.of(field, value, f"must not end in {', '.join(RESERVED)}: runs give such names themselves")
    if endings and path.suffix.lower() not in endings:
        to = f"; it is a link to {path}" if path != Path(os.fspath(value)) else ""  # type: ignore[call-overload]
        raise InputError.of(field, value, f"must end in {' or '.join(endings)}{to}")
    if len(os.fsencode(path.name)) > LONGEST_NAME:
        raise FileError(f"{path}: the file name is too long: at most {LONGEST_NAME} bytes")
    if any(_is_one_file(path, other) for other in reads):
        raise InputError.of(field, value, "must be another file than the one that is read")
    try:
        there = path.lstat()
    except FileNotFoundError:
        if not path.parent.is_dir():
            raise FileError(f"{path}: cannot be written: there is no folder {path.parent}") from None
        return path
    except OSError as error:
        raise FileError(f"{path}: cannot be written: {error.strerror or error}") from error
    if stat.S_ISDIR(there.st_mode):
        raise FileError(f"{path}: cannot be written: it is a folder")
    if not stat.S_ISREG(there.st_mode):
        raise FileError(f"{path}: cannot be written: it is not a regular file")
    if not overwrite:
        raise exists_already(path)
    return path


def _is_one_file(path: Path, other: str | os.PathLike[str]) -> bool:
    try:
        return os.path.samefile(path, other)
    except (OSError, ValueError):
        return os.path.abspath(path) == os.path.abspath(other)


def exists_already(path: Path) -> FileError:
    """The error for a file that is there and was not asked to be replaced."""
    return FileError(
        f"{path}: the file exists already; give another name, or overwrite=True (--overwrite on the command line) to replace it"
    )


def draft_of(path: Path, run_id: str) -> Path:
    """Name of the draft of a run's file."""
    return path.with_name(f".{path.name}.{run_id[:12]}.new")


def create(path: Path, mode: int = 0o666) -> BinaryIO:
    """A new file, open for reading and writing; nothing that has its name already is opened or followed (EEXIST). `mode` says who
    may do what with it, less what the user's mask takes away.
    """
    new = os.O_RDWR | os.O_CREAT | os.O_EXCL | flags("O_NOFOLLOW", "O_CLOEXEC")
    return os.fdopen(os.open(path, new, mode), "r+b")


def create_draft(path: Path, run_id: str) -> tuple[Path, LockedFile]:
    """The draft of a run's file, and its lock. Drafts of this file that killed processes have left are removed first."""
    remove_drafts(path)
    draft = draft_of(path, run_id)
    with suppress(FileNotFoundError):
        draft.unlink()
    return draft, LockedFile(create(draft))


def remove_drafts(path: Path) -> None:
    """Remove the drafts of a file whose writers live no longer: those without a lock."""
    names = re.compile(re.escape(f".{path.name}.") + "[0-9a-f]{12}" + re.escape(".new"))
    with suppress(OSError), os.scandir(path.parent) as entries:
        for entry in entries:
            if names.fullmatch(entry.name) and entry.is_file(follow_symlinks=False):
                with suppress(OSError), take_lock(Path(entry.path)):
                    os.unlink(entry.path)


def put_in_place(draft: Path, path: Path, *, replace: bool) -> None:
    """Give a draft its name, in one step; without `replace` not if something has the name already (EEXIST)."""
    if replace:
        os.replace(draft, path)
        return
    if not OPEN_FILES_MOVE:
        os.rename(draft, path)  # Windows replaces nothing by this call
        return
    try:
        os.link(draft, path, follow_symlinks=False)
    except OSError as error:
        if error.errno not in (errno.EPERM, errno.ENOSYS, errno.EOPNOTSUPP, errno.ENOTSUP, errno.EMLINK, errno.EXDEV):
            raise
        # a file system without hard links: the name is looked at, then taken
        if os.path.lexists(path):
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST), str(path)) from None
        os.replace(draft, path)
        return
    os.unlink(draft)


def write_whole(
    path: object,
    content: bytes | str,
    *,
    overwrite: bool,
    field: str = "path",
    endings: Collection[str] = (),
    reads: Iterable[str | os.PathLike[str]] = (),
) -> Path:
    """Write a file that is either the old one or the whole new one, and give its name back. Whatever trbdyn writes at once is
    written by this function; text as UTF-8. Arguments and errors are those of `output_path`; what was there is unchanged after an
    error.
    """
    target = output_path(path, overwrite=overwrite, field=field, endings=endings, reads=reads)
    try:
        draft, locked = create_draft(target, uuid.uuid4().hex)
        try:
            with locked:
                fill(draft, content.encode("utf-8", "replace") if isinstance(content, str) else content)
                put_in_place(draft, target, replace=overwrite)
        except BaseException:
            draft.unlink(missing_ok=True)
            raise
    except FileExistsError:
        raise exists_already(target) from None
    except OSError as error:
        raise FileError(f"{target}: cannot be written: {error.strerror or error}") from error
    return file_path(path, field)


def fill(draft: Path, content: bytes) -> None:
    """Write the content of a draft, and have the system put it on the disk."""
    with draft.open("r+b") as stream:
        stream.write(content)
        stream.flush()
        os.fsync(stream.fileno())


def read_whole(path: Path, largest: int) -> bytes:
    """The content of a file, however it is named: a pipe that nobody writes to is empty, a device without an end too long. A
    ValueError if it is longer than `largest` bytes.
    """
    with os.fdopen(os.open(path, os.O_RDONLY | flags("O_CLOEXEC", "O_NONBLOCK")), "rb") as stream:
        if flags("O_NONBLOCK"):
            os.set_blocking(stream.fileno(), True)
        data = stream.read(largest + 1)
    if len(data) > largest:
        raise ValueError(f"it is larger than {largest >> 20} MB")
    return data


def read_text(path: Path, largest: int = 16 << 20) -> str:
    """The text of a small file, UTF-8; a ValueError if it is longer than `largest` bytes, or no text."""
    return read_whole(path, largest).decode("utf-8")


def set_aside(path: Path) -> Path:
    """Move a file that belongs to nobody known to a name that is free: ``NAME.damaged``, ``NAME.damaged1`` and so on."""
    for number in range(1000):
        other = path.with_name(f"{path.name}.damaged{number or ''}")
        try:
            put_in_place(path, other, replace=False)
        except FileExistsError:
            continue
        return other
    raise OSError(errno.EEXIST, "too many damaged files lie beside it", str(path))


def copy_content(stream: BinaryIO, path: Path) -> None:
    """Write the content of an open file to a new file of another name."""
    with create(path) as target:
        stream.seek(0)
        shutil.copyfileobj(stream, target, 1 << 22)
        target.flush()
        os.fsync(target.fileno())


def digest_of(path: str) -> str:
    """SHA-256 of a file, as 64 hexadecimal digits."""
    try:
        return hashlib.sha256(read_whole(file_path(path, "file"), LARGEST_HASHED)).hexdigest()
    except ValueError as error:
        raise FileError(f"{path}: cannot be read: {error}") from error
    except OSError as error:
        raise FileError(f"{path}: cannot be read: {error.strerror or error}") from error
