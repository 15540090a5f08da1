# SPDX-License-Identifier: MIT
"""A file is locked by one handle at a time, until that is closed."""

import os

from model.file_lock import fcntl, is_locked, try_lock


def opened(path) -> int:
    return os.open(path, os.O_RDWR | os.O_CREAT)


def test_a_second_handle_is_refused_until_the_first_is_closed(tmp_path):
    first, second = opened(tmp_path / "lock"), opened(tmp_path / "lock")
    assert try_lock(first)
    assert not try_lock(second)
    assert is_locked(second)
    os.close(first)
    assert try_lock(second)
    os.close(second)


def test_programs_that_ask_for_a_lock_do_not_see_one_another(tmp_path):
    handles = [opened(tmp_path / "lock") for _ in range(3)]
    assert [is_locked(handle) for handle in handles] == [False] * 3
    for handle in handles:
        os.close(handle)


def test_a_file_system_without_locks_refuses_nobody(tmp_path, monkeypatch):
    def without_locks(*_):
        raise OSError("no locks available")

    monkeypatch.setattr(fcntl, "flock", without_locks)
    handle = opened(tmp_path / "lock")
    assert try_lock(handle)
    assert is_locked(handle) is None
    os.close(handle)
