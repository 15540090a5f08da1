# SPDX-License-Identifier: MIT
"""Posterior draws are read from the file itself, and only if they are numbers of equal count."""

from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pytest

from support.bounded_reading import refusal
from zebro_lab.calibration.draws import MOST_DRAWS, read_draws_of
from zebro_lab.files.errors import DataError, NotFound

NAMES = ("friction", "slip_stiffness")


def read(file: Path) -> object:
    return read_draws_of(file, "posterior", NAMES, advice="calibrate again")


def posterior(folder: Path, fill: Callable[[h5py.Group], object]) -> Path:
    with h5py.File(folder / "posterior.nc", "w") as file:
        fill(file.create_group("posterior"))
    return folder / "posterior.nc"


def test_draws_of_all_chains_come_in_a_row_and_other_members_are_named(tmp_path):
    chains = np.arange(6, dtype=np.int16).reshape(2, 3)

    def fill(group: h5py.Group) -> None:
        group["friction"] = chains
        group["chain"] = np.arange(2)

    draws, members = read_draws_of(posterior(tmp_path, fill), "posterior", NAMES, advice="")
    assert list(draws) == ["friction"]
    np.testing.assert_array_equal(draws["friction"], np.arange(6.0), strict=True)
    assert set(members) == {"friction", "chain"}


def test_a_missing_file_and_a_group_that_is_none_are_named(tmp_path):
    with pytest.raises(NotFound):
        read(tmp_path / "posterior.nc")
    with h5py.File(tmp_path / "posterior.nc", "w") as file:
        file["posterior"] = np.arange(3.0)
    with pytest.raises(DataError, match="'posterior' is not a group of draws; calibrate again"):
        read(tmp_path / "posterior.nc")


def test_a_member_whose_name_is_no_text_is_named_by_its_bytes(tmp_path):
    _, members = read_draws_of(
        posterior(tmp_path, lambda group: group.__setitem__(b"stiff\xff", np.arange(4.0))),
        "posterior", NAMES, advice="",
    )  # fmt: skip
    assert members == (r"stiff\xff",)


@pytest.mark.parametrize("size", [0, MOST_DRAWS + 1, 1 << 27])
def test_no_draws_and_more_than_a_file_can_hold_are_refused(size, tmp_path):
    file = posterior(
        tmp_path,
        lambda group: group.create_dataset("friction", (size,), "f8", chunks=(1 << 20,),
                                           maxshape=(None,)),
    )  # fmt: skip
    assert f"has {size} draws of 'friction'" in refusal(read, file)


@pytest.mark.parametrize("way", ["storage", "link"])
def test_other_files_are_not_read(way, tmp_path):
    secret = tmp_path / "secret.bin"
    secret.write_bytes(np.arange(10.0).tobytes())

    def fill(group: h5py.Group) -> None:
        if way == "storage":
            group.create_dataset("friction", (10,), "f8", external=[(str(secret), 0, 80)])
        else:
            group["friction"] = h5py.ExternalLink(str(secret), "friction")

    assert "file" in refusal(read, posterior(tmp_path, fill))


@pytest.mark.parametrize("what", ["text", "compound", "uneven"])
def test_values_that_are_no_draws_are_refused(what, tmp_path):
    def fill(group: h5py.Group) -> None:
        if what == "text":
            group.create_dataset("friction", data=np.array([b"a", b"b"]))
        elif what == "compound":
            group.create_dataset("friction", data=np.zeros(3, [("a", "f8")]))
        else:
            group.create_dataset("friction", data=np.zeros(3))
            group.create_dataset("slip_stiffness", data=np.zeros(4))

    refusal(read, posterior(tmp_path, fill))
