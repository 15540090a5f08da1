# SPDX-License-Identifier: MIT
"""Stage of `zebro-lab plot`: read a run and draw all its streams in one picture."""

from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

from zebro_lab.files.atomic import atomic_write_bytes
from zebro_lab.files.errors import SettingsError
from zebro_lab.files.own_file import picture, require_own
from zebro_lab.runs.folder import LOG_FILE
from zebro_lab.runs.manifest import MANIFEST_FILE
from zebro_lab.runs.signals import RunSignals, read_signals

SUFFIX = ".png"
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


def plot_run(folder: Path, *, out: Path | None = None) -> Drawn:
    """Draw every stream of a run and write the picture atomically as PNG.

    Args:
        folder: The run folder.
        out: Picture to write; when None, `RUN.png` beside the run folder RUN.

    Raises:
        SettingsError: `out` does not end in `.png`, or is a folder.
        AlreadyExists: `out` exists and is not a picture of this command, or is part of a result.
        NotFound: The folder is not a run folder, or the log or the picture's folder is missing.
        DataError: The run cannot be read, or holds no samples.
        OSError: The picture cannot be written.
    """
    place = folder.absolute()
    file = out or place.with_name(place.name + SUFFIX)
    if file.suffix.lower() != SUFFIX or file.is_dir():
        raise SettingsError(
            f"found '{file}'; expected a file, not a folder, ending in {SUFFIX}", key="--out"
        )
    target = require_own(file, PLOT, inputs=(folder / LOG_FILE, folder / MANIFEST_FILE))
    signals = read_signals(folder)
    from zebro_lab.plots.sheet import save
    from zebro_lab.runs.pictures import raw_streams  # matplotlib: only where all is read

    drawn = BytesIO()
    save(raw_streams(signals), drawn, command=PLOT.command)
    atomic_write_bytes(target, drawn.getvalue())
    return Drawn(file, signals)
