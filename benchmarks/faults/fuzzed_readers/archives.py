# SPDX-License-Identifier: MIT
"""Readers of arrays in npz and netCDF."""

import io
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from benchmarks.faults.fuzzed_readers.reader import Reader, hdf_check, zip_check
from benchmarks.faults.fuzzed_readers.settings import walks_document, write_beside_walks
from benchmarks.faults.hostile_inputs import (
    archives,
    as_toml,
    pick,
    pool,
)
from model.bayes.walks.prior import WRONG
from model.slip.curve import SlipCurve
from model.slip.definition import SlipDefinition
from model.slip.laws import slip_law
from zebro_lab.calibration.checkpoint import load_checkpoint
from zebro_lab.calibration.folder import POSTERIOR
from zebro_lab.calibration.slip_argument import NamedSlip
from zebro_lab.calibration.slip_draws import law_draws
from zebro_lab.calibration.walks_folder import read_stored_walks
from zebro_lab.walk.path_band import DRAWS, read_draws


def of_archives() -> Mapping[str, Reader]:
    """Return readers of arrays."""
    band = {"t": np.arange(5.0), "poses": np.zeros((3, 5, 3), np.float32)}
    chains = {
        "fingerprint": np.array("x"), "z": np.zeros((2, 4, 3)), "log_density": np.zeros((2, 4)),
        "accepted": np.zeros(2), "thin": np.array(1), "random_keys": np.zeros((1, 624), np.uint32),
        "random_positions": np.zeros(1, int),
    }  # fmt: skip
    walks = {"values": np.zeros((10, WRONG + 1)), "case": np.zeros(10, int),
             "weight": np.full(10, 0.1), "best": np.zeros(WRONG + 1)}  # fmt: skip

    def beside(folder: Path) -> None:
        write_beside_walks(folder)
        (folder / "walks/walks.toml").write_bytes(as_toml(walks_document()))

    return {
        "draws.npz": Reader(DRAWS, lambda f: read_draws(f.parent), archives(band), zip_check,
                            special=lambda: (_zeros(), b"", b"PK\x03\x04")),
        "checkpoint.npz": Reader("checkpoint.npz",
                                 lambda f: load_checkpoint(f.parent, fingerprint="x"),
                                 archives(chains), zip_check, special=lambda: (_zeros(),)),
        "draws.npz of walks": Reader("walks/draws.npz",
                                     lambda f: read_stored_walks(f.parents[1] / "slip.toml"),
                                     archives(walks), zip_check, prepare=beside),
        "posterior.nc": Reader(POSTERIOR, _posterior, pool(_posteriors(), 0.8), hdf_check),
    }  # fmt: skip


def _zeros() -> bytes:
    out = io.BytesIO()
    np.savez_compressed(out, t=np.zeros(600_000), poses=np.zeros((20, 600_000, 3)))
    return out.getvalue()


def _posterior(file: Path) -> object:
    curve = SlipCurve(
        law=slip_law("brush"), values=np.array([5.0, 0.4]), covariance=np.eye(2) * 1e-3,
        definition=SlipDefinition.MATERIAL, load_range=(1.0, 2.0), slip_range=(0.0, 1.0),
    )  # fmt: skip
    slip = NamedSlip(curve, "real", "x", (file.parent / "slip.toml",))
    return law_draws(slip, curve, 10, rng=np.random.default_rng(1))


def _posteriors() -> list[bytes]:
    rng = np.random.default_rng(3)
    values: list[Callable[[], Any]] = [
        lambda: {"data": np.zeros((2, 9))}, lambda: {"data": np.zeros(int(rng.integers(0, 9)))},
        lambda: {"data": np.array([b"a"])}, lambda: {"data": np.zeros(3, [("a", "f8")])},
        lambda: {"shape": (1 << 40,), "dtype": "f8", "chunks": (1 << 10,)},
        lambda: {"data": 3.0}, lambda: {"data": h5py.Empty("f8")},
        lambda: {"shape": (9,), "dtype": "f8", "external": [("/etc/passwd", 0, 72)]},
        lambda: {"data": np.zeros((2, 9)), "compression": "gzip"},
    ]  # fmt: skip
    made = []
    for _ in range(200):
        out = io.BytesIO()
        with h5py.File(out, "w") as file:
            group = file.create_group(pick(rng, ("posterior",) * 9 + ("other",)))
            group.create_dataset("friction", **pick(rng, values)())
            group.create_dataset("slip_stiffness", **pick(rng, values[:2])())
            if rng.random() < 0.1:
                file["x"] = h5py.ExternalLink("/etc/passwd", "/")
        made.append(out.getvalue())
    return made
