# SPDX-License-Identifier: MIT
"""Files and folders that appear whole or not at all; signals come after."""

import signal
import threading
from pathlib import Path

import pytest

from zebro_lab.files.atomic import (
    atomic_folder,
    atomic_write_bytes,
    uninterrupted,
)
from zebro_lab.files.errors import AlreadyExists


class Interrupted(Exception):
    """Stands for whatever stops a stage."""


def names(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


def test_failed_write_keeps_the_old_file_and_no_draft(tmp_path, monkeypatch):
    path = atomic_write_bytes(tmp_path / "a", b"old")

    def fail(_):
        raise Interrupted

    monkeypatch.setattr("os.fsync", fail)
    with pytest.raises(Interrupted):
        atomic_write_bytes(path, b"new")
    assert path.read_bytes() == b"old"
    assert names(tmp_path) == ["a"]


def test_new_folder_appears_with_all_its_files(tmp_path):
    with atomic_folder(tmp_path / "deep" / "out") as draft:
        (draft / "pictures").mkdir()
        (draft / "pictures" / "fit.png").write_text("1")
        (draft / "slip.toml").write_text("2")
        assert not (tmp_path / "deep").exists()
    assert names(tmp_path) == ["deep/out/pictures/fit.png", "deep/out/slip.toml"]


def write_half(folder: Path, stop: type[BaseException]) -> None:
    """Begin to fill a folder, then stop."""
    with atomic_folder(folder) as draft:
        (draft / "slip.toml").write_text("second")
        raise stop


@pytest.mark.parametrize("stop", [Interrupted, KeyboardInterrupt])
def test_exception_leaves_nothing_behind(tmp_path, stop):
    with pytest.raises(stop):
        write_half(tmp_path / "deep" / "out", stop)
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_holds_something_is_refused(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "notes.txt").write_text("mine")
    with pytest.raises(AlreadyExists, match="is not empty"), atomic_folder(tmp_path / "out"):
        pass
    assert names(tmp_path) == ["out/notes.txt"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_is_handled_after_the_body_once(number):
    order: list[str] = []
    earlier = signal.signal(number, lambda *_: order.append("handled"))
    try:
        with uninterrupted():
            signal.raise_signal(number)
            signal.raise_signal(number)
            order.append("done")
    finally:
        signal.signal(number, earlier)
    assert order == ["done", "handled"]


def test_handlers_are_as_before_also_after_an_error():
    before = signal.getsignal(signal.SIGTERM)
    with pytest.raises(ZeroDivisionError), uninterrupted():
        raise ZeroDivisionError
    assert signal.getsignal(signal.SIGTERM) is before


def test_another_thread_is_not_refused():
    ran: list[int] = []

    def act() -> None:
        with uninterrupted():
            ran.append(1)

    thread = threading.Thread(target=act)
    thread.start()
    thread.join()
    assert ran == [1]


def test_what_a_killed_process_left_beside_is_removed(tmp_path):
    (tmp_path / ".earlier run.0123abcd.part").mkdir()
    (tmp_path / ".mine.part").mkdir()
    with atomic_folder(tmp_path / "second run"), atomic_folder(tmp_path / "third run"):
        pass  # a living one keeps its draft
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        ".mine.part", "second run", "third run",
    ]  # fmt: skip


def test_an_error_without_a_name_gets_that_of_the_file(tmp_path, monkeypatch):
    def full(_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(OSError, match=r"No space left on device: '.*report\.html'"):
        atomic_write_bytes(tmp_path / "report.html", b"new")
