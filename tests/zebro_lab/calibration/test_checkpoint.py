# SPDX-License-Identifier: MIT
"""A stopped fit on disk: the same arrays back, or one line that says why not."""

import errno
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from model.bayes.drawing.sampler import Chains
from zebro_lab.calibration.checkpoint import FILE, load_checkpoint, save_checkpoint
from zebro_lab.files.errors import DataError, NotWritten

MARK = "f" * 64


def chains(steps: int = 3, seed: int = 1) -> Chains:
    rng = np.random.default_rng(seed)
    return Chains(
        z=rng.normal(size=(4, steps, 6, 2)),
        log_density=rng.normal(size=(4, steps, 6)),
        accepted=rng.random(4),
        thin=5,
        random_keys=rng.integers(0, 2**32, (4, 624), dtype=np.uint32),
        random_positions=rng.integers(0, 624, 4),
    )


def assert_same(first: Chains, second: Chains) -> None:
    assert vars(first).keys() == vars(second).keys()
    for name, values in vars(first).items():
        assert np.asarray(values).dtype == np.asarray(getattr(second, name)).dtype
        np.testing.assert_array_equal(values, getattr(second, name), err_msg=name)


def test_chains_come_back_bit_for_bit(tmp_path):
    path = save_checkpoint(tmp_path / "new" / "folder", chains(), fingerprint=MARK)
    assert path == tmp_path / "new" / "folder" / FILE
    assert_same(load_checkpoint(path.parent, fingerprint=MARK), chains())


def test_later_checkpoint_replaces_the_earlier_and_is_alone(tmp_path):
    for steps in (3, 7):
        save_checkpoint(tmp_path, chains(steps), fingerprint=MARK)
    assert load_checkpoint(tmp_path, fingerprint=MARK).n_steps == 7
    assert [path.name for path in tmp_path.iterdir()] == [FILE]


def test_a_checkpoint_is_written_behind_a_link(tmp_path):
    (tmp_path / "link").symlink_to("folder")
    path = save_checkpoint(tmp_path / "link", chains(), fingerprint=MARK)
    assert path == tmp_path / "link" / FILE
    assert (tmp_path / "folder" / FILE).is_file()


def test_a_full_disk_leaves_no_folder(tmp_path, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("zebro_lab.calibration.checkpoint.atomic_write_bytes", full)
    with pytest.raises(NotWritten, match="No space left"):
        save_checkpoint(tmp_path / "new", chains(), fingerprint=MARK)
    assert not (tmp_path / "new").exists()
    (tmp_path / "old").mkdir()
    with pytest.raises(NotWritten, match="No space left"):
        save_checkpoint(tmp_path / "old", chains(), fingerprint=MARK)
    assert (tmp_path / "old").is_dir()


def test_a_checkpoint_that_cannot_be_written_is_told_in_one_line(tmp_path):
    (tmp_path / "file").write_text("mine")
    with pytest.raises(NotWritten, match=r"file/result cannot be written \(Not a directory\); "):
        save_checkpoint(tmp_path / "file" / "result", chains(), fingerprint=MARK)


def test_file_holds_no_pickle(tmp_path):
    with np.load(save_checkpoint(tmp_path, chains(), fingerprint=MARK), allow_pickle=False) as file:
        assert all(file[name].dtype != object for name in file.files)


def test_pickle_in_its_place_is_refused_unread(tmp_path):
    np.savez(tmp_path / FILE, fingerprint=np.array([object()], dtype=object))
    with pytest.raises(DataError, match="is not a checkpoint of zebro-lab"):
        load_checkpoint(tmp_path, fingerprint=MARK)


def test_absent_checkpoint_names_the_file_and_what_to_do(tmp_path):
    with pytest.raises(DataError, match="no stopped fit to resume; run without --resume") as caught:
        load_checkpoint(tmp_path, fingerprint=MARK)
    assert caught.value.file == tmp_path / FILE


def test_checkpoint_of_another_fit_is_refused(tmp_path):
    save_checkpoint(tmp_path, chains(), fingerprint=MARK)
    with pytest.raises(DataError, match="is of a fit with other data or settings"):
        load_checkpoint(tmp_path, fingerprint="0" * 64)


def test_checkpoint_without_a_part_is_refused(tmp_path):
    path = save_checkpoint(tmp_path, chains(), fingerprint=MARK)
    with np.load(path) as stored:
        arrays = {name: stored[name] for name in stored.files if name != "random_keys"}
    np.savez(path, **arrays)
    with pytest.raises(DataError, match="is not a checkpoint of zebro-lab"):
        load_checkpoint(tmp_path, fingerprint=MARK)


@pytest.fixture(scope="module")
def intact(tmp_path_factory) -> bytes:
    return save_checkpoint(
        tmp_path_factory.mktemp("intact"), chains(), fingerprint=MARK
    ).read_bytes()


def load_or_message(folder: Path) -> Chains | str:
    try:
        return load_checkpoint(folder, fingerprint=MARK)
    except DataError as error:
        return str(error)


@settings(max_examples=200)
@given(data=st.data())
def test_damage_anywhere_is_one_line_or_harmless(intact, tmp_path_factory, data):
    """A byte that no reader looks at may change; the chains may not."""
    anywhere, in_the_directory = st.integers(0, len(intact) - 1), st.integers(1, 600)
    place = data.draw(anywhere | in_the_directory.map(lambda back: len(intact) - back))
    damaged = bytearray(intact)
    if data.draw(st.booleans()):
        del damaged[place:]
    else:
        damaged[place] ^= data.draw(st.integers(1, 255))
    folder = tmp_path_factory.mktemp("damaged")
    (folder / FILE).write_bytes(damaged)
    answer = load_or_message(folder)
    if isinstance(answer, str):
        assert answer.startswith(str(folder / FILE))
        assert "\n" not in answer
    else:
        assert_same(answer, chains())
