# SPDX-License-Identifier: MIT
"""Small tracks written into result folders."""

from pathlib import Path

from zebro_lab.track.folder import track_folder


def path_from(x: float) -> dict[str, object]:
    """Return the table and the TUM lines of a path that begins at x [m]."""
    columns = {"t_s": [0.0, 1.0], "x_m": [x, x + 1.0], "y_m": [0.0, 0.0]}
    return {"columns": columns, "tum": (f"0 {x} 0 0 0 0 0 1", f"1 {x + 1} 0 0 0 0 0 1")}


def write_track(out: Path, x: float) -> None:
    with track_folder(out, **path_from(x), source="real", settings={"x": x}, inputs={}, report={}):
        pass


def content(folder: Path) -> dict[str, bytes]:
    """Return every file below a folder by its name."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }
