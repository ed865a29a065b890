"""Chunks that we pack are what HDF5 would have packed: it reads them, and refuses one that is damaged."""

from __future__ import annotations

import zlib
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from trbdyn.results import chunks, hdf5_file
from trbdyn.results.fields import Field
from trbdyn.results.file_format import DIGITS, as_kept


@pytest.mark.parametrize("packer", ["isal", "zlib"])
@pytest.mark.parametrize("kind", ["f8", "f4", "u1"])
def test_rows_in_parts_of_every_length_come_back(
    tmp_path: Path, kind: str, packer: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if packer == "zlib":
        monkeypatch.setattr(chunks, "packer", zlib)
    else:
        pytest.importorskip("isal")
    rng = np.random.default_rng(5)
    pieces = [(100 * rng.normal(size=(n, 5, 3))).astype(kind) for n in (7, 1, 12, 40, 20, 0, 33, 1)]
    with h5py.File(tmp_path / "a.h5", "w", libver=("v110", "v110")) as file:
        hdf5_file._dataset(file, "a", (5, 3), np.dtype(kind), rows=20)
        for piece in pieces:
            hdf5_file.append(file, "a", piece)
    with h5py.File(tmp_path / "a.h5") as file:
        np.testing.assert_array_equal(file["a"], np.concatenate(pieces))
        skipped = {file["a"].id.get_chunk_info(n).filter_mask for n in range(file["a"].id.get_num_chunks())}
        assert skipped == {0}, "chunks without a checksum"


@pytest.mark.parametrize("data", [b"", b"\0\0\0", b"\xff\xff", b"\xff\xff\0\0", b"odd", bytes(range(256)) * 99])
def test_the_checksum_is_that_of_hdf5(tmp_path: Path, data: bytes) -> None:
    """HDF5 writes the checksum behind the bytes of a chunk that has no other filter."""
    if data:
        with h5py.File(tmp_path / "sum.h5", "w") as file:
            made = file.create_dataset("a", data=np.frombuffer(data, "u1"), chunks=(len(data),), fletcher32=True)
            _, stored = made.id.read_direct_chunk((0,))
        assert chunks.fletcher32(data).to_bytes(4, "little") == stored[-4:]
    else:
        assert chunks.fletcher32(data) == 0


def field(group: str, unit: str) -> Field:
    return Field("a", group, "scalar", unit, "a number")


@pytest.mark.parametrize(("group", "unit"), [("rollers", "m"), ("cage", "rad"), ("peaks", "s")])
def test_the_digits_of_a_group_are_kept_and_the_others_are_zero(group: str, unit: str) -> None:
    values = np.random.default_rng(3).normal(size=1000) * 10.0 ** np.linspace(-300.0, 300.0, 1000)
    special = np.array([0.0, -0.0, np.inf, -np.inf, np.nan, 1.0, -3.0])
    kept = as_kept(field(group, unit), values)
    assert np.max(np.abs(kept / values - 1.0)) < 0.5 * 10.0 ** -DIGITS[group]
    assert not np.any(kept.view("i8") % (1 << 12)), "digits that are not wanted"
    np.testing.assert_array_equal(as_kept(field(group, unit), kept), kept)
    np.testing.assert_array_equal(as_kept(field(group, unit), special), special)


def test_energies_keep_all_digits() -> None:
    values: Any = np.random.default_rng(3).normal(size=100)
    np.testing.assert_array_equal(as_kept(field("energy", "J"), values), values)
    assert as_kept(field("contacts", "N"), values).dtype == np.float32
