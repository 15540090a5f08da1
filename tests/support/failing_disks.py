# SPDX-License-Identifier: MIT
"""A disk of which one call fails: the n-th write, flush, rename or closing in a folder."""

import errno
import io
import os
from pathlib import Path

KINDS = ("fsync", "write", "replace", "close")
ERRORS = (errno.EIO, errno.ENOSPC, errno.EDQUOT)


class FailingDisk:
    """Counts the calls of one kind on what lies in a folder, and lets one of them fail.

    Args:
        monkeypatch: Of the test; undoing it repairs the disk.
        folder: Folder of the files that count.
        kind: One of `KINDS`.
        number: Number of the call that fails, from 1; 0 for none.
        error: Number of the error that it raises.
        name: Name of the files that count; all for None.

    Attributes:
        calls: Number of calls so far.
    """

    def __init__(self, monkeypatch, folder, kind, number, error=errno.EIO, *, name=None):
        self.calls = 0
        self._folder, self._kind = str(folder), kind
        self._number, self._error, self._name = number, error, name
        for call in ("fsync", "write", "close"):
            monkeypatch.setattr(os, call, self._on_handle(call, getattr(os, call)))
        monkeypatch.setattr(os, "replace", self._on_paths(os.replace))
        monkeypatch.setattr(io, "open", self._opener(io.open))

    @property
    def failed(self):
        """Whether the call came, and failed."""
        return 0 < self._number <= self.calls

    def check(self, kind, file):
        """Count a call on a file, and raise where it is the one that fails."""
        file = Path(str(file))
        if kind != self._kind or Path(self._folder) not in file.parents:
            return
        if self._name not in (None, file.name):
            return
        self.calls += 1
        if self.calls == self._number:
            raise OSError(self._error, os.strerror(self._error), str(file))

    def _on_handle(self, name, call):
        def counted(handle, *rest):
            try:
                file = Path(f"/proc/self/fd/{handle}").readlink()
            except OSError:
                return call(handle, *rest)
            if name == "close":  # a file is closed although closing it tells of a failure
                call(handle)
                return self.check(name, file)
            self.check(name, file)
            return call(handle, *rest)

        return counted

    def _on_paths(self, call):
        def counted(source, target, **more):
            self.check("replace", target)
            return call(source, target, **more)

        return counted

    def _opener(self, real):
        disk = self

        class Raw(io.FileIO):
            def write(self, data):
                disk.check("write", self.name)
                return super().write(data)

            def close(self):
                opened = not self.closed
                super().close()
                if opened:
                    disk.check("close", self.name)

        def opened(file, mode="r", buffering=-1, encoding=None, errors=None, newline=None, **more):
            ours = not isinstance(file, int) and str(file).startswith(disk._folder)
            if not ours or not set(mode) & set("wxa+"):
                return real(file, mode, buffering, encoding, errors, newline, **more)
            raw = Raw(str(file), mode.replace("b", "").replace("t", ""))
            if buffering == 0:
                return raw
            file = io.BufferedRandom(raw) if "+" in mode else io.BufferedWriter(raw)
            return file if "b" in mode else io.TextIOWrapper(file, encoding, errors, newline)

        return opened
