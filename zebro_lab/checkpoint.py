# SPDX-License-Identifier: MIT
"""A stopped fit on disk: plain arrays, no pickle, tied to its data and settings."""

import io
from pathlib import Path
from zipfile import BadZipFile

import numpy as np

from model.bayes.sampler import Chains
from zebro_lab.atomic import atomic_write_bytes
from zebro_lab.errors import DataError

FILE = "checkpoint.npz"
_DAMAGE = (OSError, EOFError, LookupError, RuntimeError, TypeError, ValueError, BadZipFile)
"""What numpy and zipfile raise on archives with a byte or their end changed."""


def save_checkpoint(folder: Path, chains: Chains, *, fingerprint: str) -> Path:
    """Write the chains so that a fit can go on, replacing an earlier checkpoint in one step.

    Args:
        folder: Folder of the calibration; made when missing.
        chains: Where the sampler stands.
        fingerprint: Hash of the data and settings the chains belong to.
    """
    folder.mkdir(parents=True, exist_ok=True)
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
    return atomic_write_bytes(folder / FILE, buffer.getvalue())


def load_checkpoint(folder: Path, *, fingerprint: str) -> Chains:
    """Read the chains of a stopped fit.

    Args:
        folder: Folder of the calibration.
        fingerprint: Hash of the data and settings at hand.

    Raises:
        DataError: There is none, it is damaged, or it belongs to other data or settings.
    """
    path = folder / FILE
    if not path.is_file():
        raise DataError("no stopped fit to resume; run without --resume", file=path)
    try:
        # A file of our own: numpy leaves the one it opens open when the archive is damaged.
        with path.open("rb") as file, np.load(file, allow_pickle=False) as stored:
            arrays = {name: stored[name] for name in stored.files}
        found = str(arrays.pop("fingerprint"))
        chains = Chains(**{**arrays, "thin": int(arrays["thin"])})
    except _DAMAGE as error:
        raise DataError(
            f"is no checkpoint of this program ({error}); remove it and start anew", file=path
        ) from error
    if found != fingerprint:
        raise DataError(
            "belongs to other data or settings; give the same ones, or run without --resume",
            file=path,
        )
    return chains
