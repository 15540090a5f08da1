# SPDX-License-Identifier: MIT
"""Read an earlier calibration whose posterior is the prior of a new fit."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from model.arrays import Array
from model.bayes.likelihood import NUISANCE
from model.slip.curve import SlipCurve
from zebro_lab.calibration.draws import read_draws_of
from zebro_lab.calibration.folder import POSTERIOR, read_slip_file
from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.files.source_names import is_simulated

NOISE: Final = (
    "slip_error_scale", "slip_scatter", "noise_floor", "noise_slope", "noise_correlation",
)  # fmt: skip
"""Parameters of the errors of block means, which hold for one block length."""


@dataclass(frozen=True)
class EarlierCalibration:
    """An earlier calibration with the draws of its posterior.

    Attributes:
        title: Name of its folder.
        curve: Its slip curve, with law and slip definition.
        draws: Draws of each parameter of law and measurement by name, shape (n,).
        block_length: Samples in a block mean; None if the file does not say.
        source: Source of its data.
        files: Files that were read.
        notes: Warnings about it, one line each.
        data: SHA-256 of the files that it was fitted to.
    """

    title: str
    curve: SlipCurve
    draws: Mapping[str, Array]
    block_length: int | None
    source: str
    files: tuple[Path, ...]
    notes: tuple[str, ...]
    data: frozenset[str] = frozenset()


def read_earlier(path: Path) -> EarlierCalibration:
    """Read an earlier calibration.

    Args:
        path: A calibration folder, or its `slip.toml`.

    Raises:
        NotFound: There is no `posterior.nc` beside the `slip.toml`.
        DataError: A file is missing or damaged.
    """
    found = read_slip_file(path)
    posterior = found.file.with_name(POSTERIOR)
    if not posterior.is_file():
        raise NotFound(
            f"{posterior}: no such file; the posterior of a calibration is in its draws: name a "
            "folder that calibrate-slip wrote"
        )
    names = [p.name for p in (*found.curve.law.parameters, *NUISANCE)]
    draws, _ = read_draws_of(posterior, "posterior", names, advice="calibrate again")
    missing = [p.name for p in found.curve.law.parameters if p.name not in draws]
    if missing:
        raise DataError(f"has no draws of {', '.join(missing)}; calibrate again", file=posterior)
    content = read_toml_document(found.file)
    length = content.get("tested", {}).get("block_length")
    title = found.file.absolute().parent.name
    notes = []
    if found.doubt is not None:
        notes.append(f"WARNING: the prior is a calibration that is not trustworthy: {found.doubt}")
    if is_simulated(found.source):
        notes.append(f"the prior is a calibration of SIMULATED data, source '{found.source}'")
    return EarlierCalibration(
        title=title,
        curve=found.curve,
        draws=draws,
        block_length=length if isinstance(length, int) else None,
        source=found.source,
        files=(found.file, posterior),
        notes=tuple(notes),
        data=frozenset(map(str, content.get("data", {}).values())),
    )
