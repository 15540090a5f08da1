# SPDX-License-Identifier: MIT
"""Read and write a walk folder: `path.csv`, `draws.npz`, `band.csv` and `manifest.json`.

Only this module depends on the format of these files.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

import numpy as np

from model.arrays import Array
from model.path_draws import LEVELS, STATES, quantiles
from model.poses import Poses
from model.robot import N_LEGS
from model.walk.path import WalkPath
from zebro_lab.files.arrays import read_arrays
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.files.folder_manifest import read_folder_manifest
from zebro_lab.files.names import PATH_CSV
from zebro_lab.files.opening import parsing
from zebro_lab.files.picture_format import in_every_format
from zebro_lab.files.replacement import recover
from zebro_lab.files.result_folder import MANIFEST, ResultKind, result_folder
from zebro_lab.tables.raw_table import RawTable
from zebro_lab.tables.table_files import read_table_file

SCHEMA = 1
PREDICTION = "prediction"  # of a run
KINDS = ("walk", "predict")
THESIS_CSV = "thesis.csv"
THESIS_PICTURES = (
    "coordinates", "lowest_angle", "hip_height", "contact_velocity", "static_load",
    "paired_traction",
)  # fmt: skip
"""Pictures of walks by the thesis's model alone."""
_NOT_MEASURED = ("assumed", "thesis")  # sources of slip laws without data
INFORMED_MODEL = "dynamics"  # the model with which legs and floor were fitted to walks
PICTURES = (
    "path", "motion", "orientation", "slip_ratio", "normal_force", "traction_force",
    "leg_angles", "gantt", "snapshots",
)  # fmt: skip
SOME_PICTURES = ("stances", "slip_law")
"""Pictures of walks by a gait, and with a slip curve."""
CONTACTS_CSV, TOUCHDOWNS_CSV, CONTACTS_PICTURE = "contacts.csv", "touchdowns.csv", "contacts"
CONTACTS = (CONTACTS_CSV, TOUCHDOWNS_CSV, *in_every_format(CONTACTS_PICTURE))
ANIMATIONS = ("animation.mp4", "animation.gif")
DRAWS, BAND_CSV, BAND_PICTURE = "draws.npz", "band.csv", "band"
_DRAWS_ADVICE = f"delete {DRAWS} if it is there, and run walk or predict again with --draws 500"
BAND = (DRAWS, BAND_CSV, *in_every_format(BAND_PICTURE))
FILES = (
    PATH_CSV,
    THESIS_CSV,
    *in_every_format(*PICTURES, *SOME_PICTURES, *THESIS_PICTURES),
    *ANIMATIONS,
    *BAND,
    *CONTACTS,
)
WALKED = {kind: ResultKind(kind, kind, FILES, SCHEMA) for kind in KINDS}
"""Kinds of folders that `walk` and `predict` write."""

_DIGITS = "%.10g"  # far finer than any model's accuracy, far coarser than rounding errors of floats

_BATCH = 10_000
"""Rows formatted at a time, each 2 kB as Python floats; this takes a third of pandas' time."""


def leg_columns(*names: str) -> tuple[str, ...]:
    """Return the column names of quantities for all legs: `theta` gives `theta1` to `theta6`."""
    return tuple(f"{name}{leg}" for name in names for leg in range(1, N_LEGS + 1))


_COLUMNS_OF: Final = {
    "t": ("t",),
    "position": ("x", "y", "z"),
    "orientation": ("roll", "pitch", "yaw"),
    "theta": leg_columns("theta"),
    "contact": leg_columns("contact"),
    "slip_velocity": leg_columns("slip_x", "slip_y"),
    "normal_force": leg_columns("normal"),
    "traction_force": leg_columns("force_x", "force_y"),
    "slip_ratio": leg_columns("slip_ratio"),
    "body_force": ("body_force",),
    "in_flight": ("flight",),
    "energy": ("work_done", "work_taken_back", "slip_energy", "contact_energy"),
}
"""Columns of `path.csv` by the attribute of a path that they hold, SI; vectors of legs by axis."""
_COMPUTED: Final = {"slip_velocity", "normal_force", "traction_force", "slip_ratio", "body_force",
                    "energy"}  # fmt: skip
"""Attributes that not every model computes: their cells may be empty."""
_DERIVED: Final = {"in_flight"}
"""Attributes that follow from the others, and are not read back."""
_LATER: Final = {"body_force", "energy"}
"""Attributes that folders of earlier versions lack."""
COLUMNS = tuple(name for columns in _COLUMNS_OF.values() for name in columns)
"""The columns of `path.csv`, in order."""


def write_path(file: Path, path: WalkPath) -> None:
    """Write a path as CSV in SI with the columns `COLUMNS`.

    Args:
        file: File to write; an existing one is overwritten.
        path: The path; NaN, for what its model does not compute, becomes an empty cell.
    """
    values = np.column_stack([by_axis(getattr(path, name)) for name in _COLUMNS_OF])
    whole = {*_COLUMNS_OF["contact"], *_COLUMNS_OF["in_flight"]}
    forms = ["%d" if name in whole else _DIGITS for name in COLUMNS]
    write_rows(file, COLUMNS, (values,), forms)


def by_axis(values: Array) -> Array:
    """Return values as columns, shape (n, m).

    Vectors of the legs, shape (n, 6, k), become the x of all legs, then their y, and so on.
    """
    values = np.asarray(values, dtype=float)
    return values if values.ndim < 3 else np.swapaxes(values, 1, 2).reshape(len(values), -1)


def write_rows(
    file: Path, columns: Sequence[str], parts: Iterable[Array], forms: Sequence[str]
) -> None:
    """Write a CSV of numbers; NaN becomes an empty cell.

    Args:
        file: File to write; an existing one is overwritten.
        columns: Names of the columns.
        parts: The numbers, a row a line, in arrays of shape (n, len(columns)) one after the other.
        forms: printf-style format of each column's numbers.
    """
    line = ",".join(forms) + "\n"
    with file.open("w", encoding="utf-8", newline="\n") as text:
        text.write(",".join(columns) + "\n")
        for values in parts:
            for first in range(0, len(values), _BATCH):
                rows = values[first : first + _BATCH].tolist()
                text.write("".join([line % tuple(row) for row in rows]).replace("nan", ""))


@contextmanager
def walk_folder(
    out: Path,
    path: WalkPath,
    *,
    kind: str,
    source: str,
    settings: Mapping[str, object],
    inputs: Mapping[str, str],
) -> Iterator[Path]:
    """Write a walk folder atomically: `path.csv`, what the body adds, and last the manifest.

    Args:
        out: Folder to create or replace.
        path: The path to write.
        kind: Command that writes the folder, one of `KINDS`.
        source: "sim:" and the name of the model.
        settings: Settings of the walk, JSON-serialisable.
        inputs: SHA-256 of each file that was read, by path.

    Yields:
        The draft folder, with `path.csv`, to add pictures and the files `BAND` to.

    Raises:
        AlreadyExists: `out` is a file or the result of another command, a file of the old result
            was changed, or a user's file has a name to be written; others are kept.
        NotWritten: The folder cannot be created or moved.
    """
    content = {"source": source, "settings": settings, "inputs": inputs}
    with result_folder(out, WALKED[kind], content=content) as draft:
        write_path(draft / PATH_CSV, path)
        yield draft


def read_walk(path: Path) -> WalkPath:
    """Read the path of a walk folder from `path.csv`.

    Args:
        path: A walk folder, or its `path.csv`.

    Raises:
        NotFound: There is no such file.
        DataError: The file is damaged or has no rows, a column is missing, a cell does not hold a
            finite number, or time does not increase; the message names file, row and column.
    """
    recover(path)
    file = path / PATH_CSV if path.is_dir() else path
    if not file.exists():
        raise NotFound(f"{file}: no such file; choose a folder that walk or predict wrote")
    table = read_table_file(file)
    read = {name: _read(table, name) for name in _COLUMNS_OF if name not in _DERIVED}
    table.require_increasing("t", read["t"])
    for name in ("slip_velocity", "traction_force"):
        read[name] = read[name].reshape(-1, 2, N_LEGS).swapaxes(1, 2)
    return WalkPath(**{**read, "contact": read["contact"] != 0})


def _read(table: RawTable, attribute: str) -> Array:
    """Read the columns of an attribute, shape (n, k), or (n,) of a single one; NaN without them."""
    columns = []
    for name in _COLUMNS_OF[attribute]:
        if attribute in _LATER and name not in table.columns:
            columns.append(np.full(len(table), np.nan))
            continue
        columns.append(values := table.numbers(name))
        table.require_finite(name, values, may_be_empty=attribute in _COMPUTED)
    return columns[0] if len(columns) == 1 else np.column_stack(columns)


def read_walk_manifest(folder: Path) -> Mapping[str, Any]:
    """Read the manifest of a walk folder, written by `walk` or `predict`.

    Raises:
        NotFound: There is no manifest.
        DataError: The manifest is damaged, of another schema, or of another command.
    """
    recover(folder)
    return read_folder_manifest(folder / MANIFEST, of="walk", kinds=KINDS, schema=SCHEMA)


def write_draws(folder: Path, paths: Poses) -> None:
    """Write the paths of a band, `draws.npz`, and their quantiles, `band.csv`, into a walk folder.

    Args:
        folder: Folder to write into.
        paths: The paths, in the time base of the walk folder.
    """
    np.savez_compressed(folder / DRAWS, t=paths.t, poses=paths.states.astype(np.float32))
    columns = ("t", *(f"{state}_q{1000 * level:03.0f}" for state in STATES for level in LEVELS))
    band = np.moveaxis(quantiles(paths), 1, 0).swapaxes(1, 2).reshape(len(paths.t), -1)
    rows = np.column_stack([paths.t, band])
    write_rows(folder / BAND_CSV, columns, (rows,), ["%.8g"] * len(columns))


def read_draws(folder: Path) -> Poses:
    """Read the paths of a walk folder's band from `draws.npz`.

    Raises:
        NotFound: The folder has no `draws.npz`.
        DataError: The file is damaged or too large, there are no poses, shapes do not match, or
            times do not increase.
    """
    file = folder / DRAWS
    arrays = read_arrays(file, ("t", "poses"), advice=_DRAWS_ADVICE)
    t, poses = arrays["t"], arrays["poses"]
    if t.ndim != 1 or poses.ndim != 3 or poses.shape[1:] != (len(t), 3) or 0 in poses.shape:
        raise DataError(
            f"holds poses of shape {poses.shape} at times of shape {t.shape}; {_DRAWS_ADVICE}",
            file=file,
        )
    with parsing(file, "cannot be read as poses", advice=_DRAWS_ADVICE):
        t, poses = t.astype(float), poses.astype(float)
    if not np.all(np.diff(t) > 0):
        raise DataError(f"holds times that do not increase; {_DRAWS_ADVICE}", file=file)
    return Poses.of_states(t, poses)


def measured_sources(manifest: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the sources of the data that a walk was computed from, not of the computed path.

    They are those of leg angles, slip law and fitted walks, each once, without slip laws that are
    "assumed" or the "thesis"'s. If the leg angles are those of a gait, it is the walk's own source;
    "unknown" if the manifest states none.

    Args:
        manifest: Content of the walk's manifest.

    >>> measured_sources({"source": "sim:dynamics", "settings": {"leg_angles": "real"}})
    ('real',)
    >>> measured_sources({"source": "sim:dynamics", "settings": {}})
    ('sim:dynamics',)
    """
    settings = manifest.get("settings") or {}
    if "leg_angles" not in settings:
        return (str(manifest.get("source", "unknown")),)
    others = (settings.get(name) or {} for name in ("slip", "walks"))
    found = [settings["leg_angles"], *(each["source"] for each in others if "source" in each)]
    named = (one.strip() for each in found for one in str(each).split(", "))
    return tuple(dict.fromkeys(one for one in named if one not in _NOT_MEASURED))


def doubts(manifest: Mapping[str, Any]) -> tuple[str, ...]:
    """Return why the slip law or fitted walks of a walk cannot be trusted, a warning for each.

    Empty if they can, or if the manifest does not say.
    """
    settings = manifest.get("settings") or {}
    return tuple(map(str, settings.get("doubts") or ()))
