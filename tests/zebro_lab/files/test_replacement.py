# SPDX-License-Identifier: MIT
"""A result is replaced whole or not at all, whenever its writer is killed."""

import fcntl
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from support.written_tracks import content, write_track
from zebro_lab.files import replacement
from zebro_lab.files.errors import ZebroLabError
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.track.folder import TRACKED, read_track_manifest


class Killed(BaseException):
    """Stands for a process that is killed: none of its later writes reaches the disk."""


class Killer:
    """Ends every change of a file from the n-th on, as SIGKILL between two calls does."""

    CHANGES = ("os.rename", "os.mkdir", "os.link", "os.remove", "os.rmdir", "os.chmod",
               "os.truncate", "os.symlink")  # fmt: skip

    def __init__(self) -> None:
        self.left: int | None = None
        sys.addaudithook(self._hear)

    def _hear(self, event: str, arguments: tuple[object, ...]) -> None:
        if self.left is None or not self._changes(event, arguments):
            return
        self.left -= 1
        if self.left < 0:
            raise Killed

    def _changes(self, event: str, arguments: tuple[object, ...]) -> bool:
        if event != "open":
            return event in self.CHANGES
        flags = arguments[2]
        return isinstance(flags, int) and bool(flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT))

    @contextmanager
    def after(self, changes: int) -> Iterator[None]:
        """Let the body make so many changes, then kill it."""
        self.left = changes
        try:
            yield
        finally:
            self.left = None


@pytest.fixture(scope="module")
def killer() -> Killer:
    return Killer()  # a hook cannot be taken away again: one for all tests


def survives(write: Callable[[], None], killer: Killer, changes: int) -> bool:
    """Kill a writer after so many changes; tell whether it came to its end before."""
    try:
        with killer.after(changes):
            write()
    except Killed:
        return False
    return True


def test_a_kill_at_any_change_leaves_the_old_or_the_new_result_whole(tmp_path, killer):
    old, new = tmp_path / "old", tmp_path / "new"
    write_track(old, 0.0)
    write_track(new, 5.0)
    for changes in range(200):
        out = tmp_path / f"killed-{changes}" / "track"
        write_track(out, 0.0)
        (out / "notes.txt").write_text("mine")
        finished = survives(lambda out=out: write_track(out, 5.0), killer, changes)
        previous = out.with_name(".track.previous")
        found = content(out if out.exists() else previous)
        assert found.pop("notes.txt") == b"mine"
        assert found in (content(old), content(new)), f"killed after {changes} changes"
        read_track_manifest(out)
        assert not previous.exists()
        if finished:
            break
    assert finished
    assert found == content(new)
    assert changes > 5


def test_a_reader_restores_what_an_interrupted_replacement_left_and_says_so(tmp_path, caplog):
    write_track(tmp_path / "track", 0.0)
    (tmp_path / "track").rename(tmp_path / ".track.previous")
    assert read_track_manifest(tmp_path / "track")["settings"] == {"x": 0.0}
    assert not (tmp_path / ".track.previous").exists()
    assert "restored from .track.previous" in caplog.text


def test_a_folder_that_somebody_keeps_as_previous_is_never_removed(tmp_path):
    out = tmp_path / "track"
    write_track(tmp_path / "track.previous", 7.0)
    write_track(out, 0.0)
    assert read_track_manifest(tmp_path / "track.previous")["settings"] == {"x": 7.0}
    write_track(out, 1.0)
    assert read_track_manifest(tmp_path / "track.previous")["settings"] == {"x": 7.0}
    assert read_track_manifest(out)["settings"] == {"x": 1.0}


def test_a_linked_folder_is_replaced_behind_its_link(tmp_path):
    write_track(tmp_path / "track-3", 0.0)
    (tmp_path / "track").symlink_to("track-3")
    write_track(tmp_path / "track", 1.0)
    assert (tmp_path / "track").is_symlink()
    assert read_track_manifest(tmp_path / "track-3")["settings"] == {"x": 1.0}


def test_foreign_folders_links_and_rights_are_carried_over(tmp_path):
    out = tmp_path / "track"
    write_track(out, 0.0)
    (out / "mine" / "deep").mkdir(parents=True)
    (out / "mine" / "deep" / "a.txt").write_text("a")
    (out / "mine" / "empty").mkdir(mode=0o700)
    (out / "link").symlink_to("nowhere")
    inode = (out / "mine" / "deep" / "a.txt").stat().st_ino
    out.chmod(0o775)
    write_track(out, 1.0)
    assert (out / "mine" / "deep" / "a.txt").stat().st_ino == inode
    assert (out / "mine" / "empty").stat().st_mode & 0o777 == 0o700
    assert (out / "link").readlink() == Path("nowhere")
    assert out.stat().st_mode & 0o777 == 0o775
    assert sorted(path.name for path in tmp_path.iterdir()) == ["track"]


def test_foreign_files_are_kept_where_no_hard_links_are(tmp_path, monkeypatch):
    def refuse(*_, **__) -> None:
        raise PermissionError(1, "Operation not permitted")

    out = tmp_path / "track"
    write_track(out, 0.0)
    (out / "mine").mkdir()
    for name in ("notes.txt", "mine/a.txt"):
        (out / name).write_text("mine")
    flushed, fsync = [], os.fsync
    monkeypatch.setattr(os, "link", refuse)
    monkeypatch.setattr(os, "fsync", lambda fd: (flushed.append(os.fstat(fd).st_ino), fsync(fd)))
    write_track(out, 1.0)
    for file in (out / "notes.txt", out / "mine" / "a.txt"):
        assert file.read_text() == "mine"
        assert file.stat().st_ino in flushed
    assert not (tmp_path / ".track.previous").exists()


def test_what_the_user_saves_during_a_replacement_is_kept(tmp_path, monkeypatch):
    def save_and_swap(folder: Path, *arguments: object) -> None:
        (folder / "late.txt").write_text("late")
        (folder / "draft").write_text("edited")
        (folder / "draft").replace(folder / "notes.txt")
        swap(folder, *arguments)

    out, swap = tmp_path / "track", replacement._swap
    write_track(out, 0.0)
    (out / "notes.txt").write_text("mine")
    monkeypatch.setattr(replacement, "_swap", save_and_swap)
    write_track(out, 1.0)
    assert (out / "late.txt").read_text() == "late"
    assert (out / "notes.txt").read_text() == "edited"
    assert read_track_manifest(out)["settings"] == {"x": 1.0}


def test_an_old_folder_that_cannot_be_removed_is_named_before_anything_is_computed(
    tmp_path, monkeypatch
):
    out, previous = tmp_path / "track", tmp_path / ".track.previous"
    write_track(out, 0.0)
    write_track(previous, 1.0)
    monkeypatch.setattr(replacement.shutil, "rmtree", lambda *_, **__: None)
    assert read_track_manifest(out)["settings"] == {"x": 0.0}
    with pytest.raises(ZebroLabError, match=r"\.track\.previous, .* cannot be removed"):
        require_replaceable(out, TRACKED)
    assert read_track_manifest(out)["settings"] == {"x": 0.0}


def test_a_waiting_writer_gives_up_with_one_line(tmp_path, monkeypatch):
    monkeypatch.setattr(replacement, "PATIENCE", 0.1)
    write_track(tmp_path / "track", 0.0)
    with (tmp_path / ".track.replacing").open("w") as note:
        fcntl.flock(note, fcntl.LOCK_EX)
        with pytest.raises(ZebroLabError, match="by another process"):
            write_track(tmp_path / "track", 1.0)
    write_track(tmp_path / "track", 2.0)
    assert read_track_manifest(tmp_path / "track")["settings"] == {"x": 2.0}
