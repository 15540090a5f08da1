# SPDX-License-Identifier: MIT
"""Arrays of an .npz archive come back bit for bit; what claims too much is refused unread."""

import io
import zipfile
from pathlib import Path

import numpy as np
import pytest

from support.bounded_reading import refusal
from zebro_lab.files.arrays import read_arrays
from zebro_lab.files.errors import DataError, NotFound

ADVICE = "predict again"


def read(file: Path) -> object:
    return read_arrays(file, ("t", "poses"), advice=ADVICE)


def archive(folder: Path, members: dict[str, bytes]) -> Path:
    with zipfile.ZipFile(folder / "draws.npz", "w", zipfile.ZIP_DEFLATED) as out:
        for name, data in members.items():
            out.writestr(f"{name}.npy", data)
    return folder / "draws.npz"


def npy(array: np.ndarray) -> bytes:
    out = io.BytesIO()
    np.save(out, array)
    return out.getvalue()


def npy_header(text: str) -> bytes:
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode()


GOOD = {"t": npy(np.arange(5.0)), "poses": npy(np.zeros((3, 5, 3), np.float32))}


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_arrays_of_any_number_type_and_order_come_back(save, tmp_path):
    arrays = {
        "t": np.linspace(0, 1, 7), "poses": np.asfortranarray(np.arange(6.0).reshape(2, 3)),
        "counts": np.array(7, np.uint8), "good": np.array([True, False]),
        "names": np.array(["a", "été"]), "none": np.empty((0, 3), np.float32),
    }  # fmt: skip
    save(tmp_path / "x.npz", **arrays)
    found = read_arrays(tmp_path / "x.npz", arrays, advice=ADVICE)
    assert list(found) == list(arrays)
    for name, array in arrays.items():
        assert found[name].dtype == array.dtype
        np.testing.assert_array_equal(found[name], array, strict=True)


def test_missing_file_and_member_are_named_with_what_to_do(tmp_path):
    with pytest.raises(NotFound, match=ADVICE):
        read(tmp_path / "draws.npz")
    with pytest.raises(DataError, match="has no array 'poses'"):
        read(archive(tmp_path, {"t": GOOD["t"]}))


@pytest.mark.parametrize("member", [b"hello", npy(np.array([1 + 2j])), npy(np.zeros(1, "V4"))])
def test_a_member_that_is_no_array_of_numbers_is_named(member, tmp_path):
    with pytest.raises(DataError, match=f"no array of numbers as 't'; {ADVICE}"):
        read(archive(tmp_path, {**GOOD, "t": member}))


def test_arrays_may_be_as_large_as_the_limit_and_no_larger(tmp_path):
    file = archive(tmp_path, {"t": GOOD["t"]})
    size = len(GOOD["t"])
    assert read_arrays(file, ("t",), advice=ADVICE, most=size)["t"][-1] == 4.0
    with pytest.raises(DataError, match="unpacks to"):
        read_arrays(file, ("t",), advice=ADVICE, most=size - 1)


@pytest.mark.parametrize(
    "header",
    [
        "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999,), }",
        "{'descr': '|O', 'fortran_order': False, 'shape': (5,), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (-5,), }",
        "[" * 5000,
    ],
)
def test_a_header_that_claims_the_impossible_is_refused(header, tmp_path):
    assert ADVICE in refusal(read, archive(tmp_path, {**GOOD, "t": npy_header(header)}))
