# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab plot`: read a run and draw all its streams in one picture."""

from collections.abc import Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

from zebro_lab.files.atomic import atomic_write_bytes
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.picture_format import PictureFormat, format_of
from zebro_lab.files.single_file import picture, require_overwritable
from zebro_lab.runs.folder import LOG_FILE
from zebro_lab.runs.manifest import MANIFEST_FILE
from zebro_lab.runs.signals import RunSignals, read_signals
from zebro_lab.terminal.picture_options import Window

PLOT = picture("plot")


@dataclass(frozen=True)
class Drawn:
    """Written picture of a run.

    Attributes:
        file: Path of the picture, as named.
        signals: Signals drawn in the picture.
    """

    file: Path
    signals: RunSignals


def plot_run(
    folder: Path,
    *,
    out: Path | None = None,
    form: PictureFormat | None = None,
    at: Sequence[float] = (),
    window: Window | None = None,
) -> Drawn:
    """Draw every stream of a run and write the picture atomically.

    Args:
        folder: The run folder.
        out: Picture to write; when None, `RUN.png` (or of the format) beside the run folder RUN.
        form: Format of the picture; when None, as `out` ends.
        at: Times of the run to mark [s].
        window: Time of the run to draw; None for all.

    Raises:
        SettingsError: `out` has the suffix of no format or of another one than `form`, or is a
            folder; or no sample lies in the window, or a time to mark is not in what is drawn.
        AlreadyExists: `out` exists and is not a picture of this command, or is part of a result.
        NotFound: The folder is not a run folder, or the log or the picture's folder is missing.
        DataError: The run cannot be read, or holds no samples.
        OSError: The picture cannot be written.
    """
    place = folder.absolute()
    file = out or place.with_name(f"{place.name}.{form or 'png'}")
    own = _format_of(file, form)
    target = require_overwritable(file, PLOT, inputs=(folder / LOG_FILE, folder / MANIFEST_FILE))
    signals = read_signals(folder)
    if window is not None:
        signals = signals.within(*window)
    signals.require_within(at, key="--at")
    from zebro_lab.plots.sheet import save
    from zebro_lab.runs.pictures import raw_streams  # matplotlib: only where all is read

    drawn = BytesIO()
    save(raw_streams(signals, at), drawn, command=PLOT.command, form=own)
    atomic_write_bytes(target, drawn.getvalue())
    return Drawn(file, signals)


def _format_of(file: Path, form: PictureFormat | None) -> PictureFormat:
    """Return the format that a file's suffix names.

    Raises `SettingsError` if the file is a folder, or its suffix names no format or not `form`.
    """
    if file.is_dir():
        raise SettingsError(f"found the folder '{file}'; expected a file", key="--out")
    own = format_of(file)
    if form not in (None, own):
        raise SettingsError(
            f"found '{file}' with --format {form}; expected the same format in both", key="--out"
        )
    return own
