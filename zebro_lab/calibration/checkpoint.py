# SPDX-License-Identifier: MIT
"""Checkpoint of a stopped fit: arrays without pickle, with a hash of data and settings."""

import io
from pathlib import Path

import numpy as np

from model.bayes.drawing.sampler import Chains
from zebro_lab.files.arrays import read_arrays
from zebro_lab.files.atomic import atomic_write_bytes
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import parsing
from zebro_lab.files.result_folder import real_place, writing

FILE = "checkpoint.npz"
_ARRAYS = (
    "fingerprint", "z", "log_density", "accepted", "thin", "random_keys", "random_positions",
)  # fmt: skip
_MOST_BYTES = 1 << 30
_NONE, _ADVICE = "is not a checkpoint of zebro-lab", "delete it and run without --resume"


def save_checkpoint(folder: Path, chains: Chains, *, fingerprint: str) -> Path:
    """Write the sampler's chains so that a fit can be resumed; replaces a checkpoint atomically.

    Args:
        folder: Calibration folder to write `checkpoint.npz` into; created if missing.
        chains: Chains of all ensembles, with the state of their random number generators.
        fingerprint: Hash of the data and settings that the chains belong to.

    Returns:
        The checkpoint file.

    Raises:
        NotWritten: The file cannot be written.
    """
    buffer = io.BytesIO()
    np.savez(
        buffer,
        fingerprint=np.array(fingerprint),
        z=chains.z,
        log_density=chains.log_density,
        accepted=chains.accepted,
        thin=np.array(chains.thin),
        random_keys=chains.random_keys,
        random_positions=chains.random_positions,
    )
    place = real_place(folder)
    is_new = not place.exists()
    with writing(folder):
        place.mkdir(parents=True, exist_ok=True)
        try:
            atomic_write_bytes(place / FILE, buffer.getvalue())
        except OSError:
            if is_new:
                place.rmdir()
            raise
    return folder / FILE


def load_checkpoint(folder: Path, *, fingerprint: str) -> Chains:
    """Read the sampler's chains of a stopped fit from `checkpoint.npz`.

    Args:
        folder: Calibration folder that holds the checkpoint.
        fingerprint: Hash of the present data and settings, which must equal the stored one.

    Raises:
        DataError: The checkpoint is missing, damaged, too large, or of other data or settings.
    """
    path = folder / FILE
    if not path.is_file():
        raise DataError("no stopped fit to resume; run without --resume", file=path)
    try:
        stored = read_arrays(path, _ARRAYS, advice="start anew", most=_MOST_BYTES)
    except DataError as error:
        raise DataError(f"{_NONE} ({error.problem}); {_ADVICE}", file=path) from error
    with parsing(path, _NONE, advice=_ADVICE):
        arrays = {name: array.copy() for name, array in stored.items()}
        found = str(arrays.pop("fingerprint"))
        chains = Chains(**{**arrays, "thin": int(arrays["thin"])})
    if found != fingerprint:
        raise DataError(
            "is of a fit with other data or settings; give --resume with those, or run without it",
            file=path,
        )
    return chains
