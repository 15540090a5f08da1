# SPDX-License-Identifier: MIT
"""A run in, one picture of all that it recorded out."""

from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

from zebro_lab.atomic import atomic_write_bytes
from zebro_lab.errors import NotFound, SettingsError
from zebro_lab.run_signals import RunSignals, read_signals

SUFFIX = ".png"


@dataclass(frozen=True)
class Drawn:
    """A picture of a run.

    Attributes:
        file: The picture.
        signals: What it shows.
    """

    file: Path
    signals: RunSignals


def plot_run(folder: Path, *, out: Path | None = None) -> Drawn:
    """Draw every stream of a run.

    Args:
        folder: The run folder.
        out: Picture to write, PNG; beside the run folder, under its name, when None.

    Raises:
        SettingsError: `out` is no name of a PNG file.
        NotFound: It is no run folder, its log is missing, or the picture's folder is.
        DataError: It cannot be read, or holds no samples.
    """
    place = folder.absolute()
    file = out or place.with_name(place.name + SUFFIX)
    if file.suffix.lower() != SUFFIX or file.is_dir():
        raise SettingsError(f"'{file}' is no name of a picture; expected FILE{SUFFIX}", key="--out")
    if not file.parent.is_dir():
        raise NotFound(f"{file.parent}: no such folder; make it, or name another --out")
    signals = read_signals(folder)
    from zebro_lab.plots.raw_streams import raw_streams  # matplotlib: only where all is read
    from zebro_lab.plots.sheet import save

    drawn = BytesIO()
    save(raw_streams(signals), drawn)
    return Drawn(atomic_write_bytes(file, drawn.getvalue()), signals)
