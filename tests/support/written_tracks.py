# SPDX-License-Identifier: MIT
"""Small tracks written into result folders."""

from pathlib import Path

from zebro_lab.track.folder import track_folder


class Track:
    """A track of two poses, told apart by where it begins."""

    def __init__(self, x: float) -> None:
        self.columns = {"t_s": [0.0, 1.0], "x_m": [x, x + 1.0], "y_m": [0.0, 0.0]}
        self.tum = (f"0 {x} 0 0 0 0 0 1", f"1 {x + 1} 0 0 0 0 0 1")


def write_track(out: Path, x: float) -> None:
    with track_folder(out, Track(x), source="real", settings={"x": x}, inputs={}, report={}):
        pass


def content(folder: Path) -> dict[str, bytes]:
    """Return every file below a folder by its name."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }
