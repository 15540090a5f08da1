# SPDX-License-Identifier: MIT
"""Posterior draws in a netCDF (HDF5) file: what a fit writes, and reading within limits."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Final

import h5py
import numpy as np

from model.arrays import Array
from zebro_lab.files.errors import DataError
from zebro_lab.files.opening import open_file, parsing

if TYPE_CHECKING:
    from xarray import DataTree

    from model.bayes.calibration import Calibration

MOST_DRAWS: Final = 4_000_000
"""Largest number of draws per parameter; a calibration writes some ten thousand."""

BLOCK_MOMENTS = (
    "slip_wander", "slip_error", "load_variance", "load_skewness", "slip_load_covariance",
    "load_error", "noise_size",
)  # fmt: skip
"""Moments of slip and load within a block, and sizes of errors, as `SlipBlocks` has them."""


def read_draws_of(
    path: Path, group: str, names: Iterable[str], *, advice: str
) -> tuple[Mapping[str, Array], tuple[str, ...]]:
    """Read posterior draws of parameters from one group of a netCDF (HDF5) file.

    External links and external storage of HDF5, which refer to other files, are rejected.

    Args:
        path: The file.
        group: Name of the group that holds the draws, e.g. "posterior".
        names: Parameters to read; those that the group lacks are omitted.
        advice: What to do if the file cannot be read; part of the error message.

    Returns:
        Draws by parameter, chains joined, each of shape (n,), NaN included; and the names of all
        members of the group.

    Raises:
        NotFound: There is no such file.
        DataError: The file is not regular, cannot be opened, is not HDF5, or lacks the group; the
            group or a parameter is a soft or external link; or draws of a parameter are not
            integers or floats, not 1 to `MOST_DRAWS`, not as many as of another parameter, or
            stored in another file.
    """
    with (
        open_file(path) as file,
        parsing(path, "cannot be read as posterior draws", advice=advice),
        h5py.File(file, "r") as data,
    ):
        found = _own(data, group, path)
        if not isinstance(found, h5py.Group):
            raise DataError(f"'{group}' is not a group of draws; {advice}", file=path)
        held = tuple(_text(name) for name in found)
        draws = {name: _draws(found, name, path) for name in names if name in held}
    if len({len(values) for values in draws.values()}) > 1:
        raise DataError(f"has more draws of one parameter than of another; {advice}", file=path)
    return draws, held


def _text(name: object) -> str:
    """Convert a name to a string; h5py returns names that are not UTF-8 as bytes."""
    return name.decode("utf-8", "backslashreplace") if isinstance(name, bytes) else str(name)


def _own(group: h5py.Group, name: str, path: Path) -> object:
    """Return a member of a group; raise DataError if it is missing or a soft or external link."""
    if not isinstance(group.get(name, getlink=True), h5py.HardLink):
        raise DataError(
            f"has no '{name}', or only a link to one elsewhere; calibrate again", file=path
        )
    return group[name]


def _draws(group: h5py.Group, name: str, path: Path) -> Array:
    """Read the draws of one parameter from a group, all chains joined, shape (n,).

    Raises `DataError` if they are no numbers, stored in another file, none, or over `MOST_DRAWS`.
    """
    found = _own(group, name, path)
    if not isinstance(found, h5py.Dataset) or found.dtype.kind not in "fiu":
        raise DataError(f"'{name}' does not hold numbers; calibrate again", file=path)
    if found.external or found.is_virtual:
        raise DataError(f"draws of '{name}' are stored elsewhere; calibrate again", file=path)
    size = found.size or 0  # None for a dataset declared empty
    if not 0 < size <= MOST_DRAWS:
        raise DataError(f"has {size} draws of '{name}'; expected 1 to {MOST_DRAWS}", file=path)
    return np.ravel(found[()]).astype(float)


def posterior_tree(calibration: "Calibration") -> "DataTree":
    """Convert a fit to a `DataTree` as ArviZ has it, with one chain for each ensemble of walkers.

    Groups: `posterior`, draws of the free parameters; `sample_stats`, log density `lp`;
    `observed_data`, traction by block; `constant_data`, slip ratio, load, run index, number of
    samples and `BLOCK_MOMENTS` by block, and the variance of the slip error that its run shares.
    Attributes: source, slip definition, law, headline of the verdict.
    """
    from xarray import Dataset, DataTree

    posterior, draws = calibration.posterior, calibration.draws
    blocks = posterior.blocks
    sampled = {
        p.name: draws.values[..., i]
        for i, p in enumerate(posterior.parameters)
        if p.name not in posterior.fixed
    }
    given = {
        "slip_ratio": blocks.slip,
        "normal_force": blocks.normal_force,
        "run": blocks.run,
        "samples": blocks.count,
        **{name: getattr(blocks, name) for name in BLOCK_MOMENTS},
        "run_slip_error": blocks.run_slip_error[blocks.run],
    }
    attributes = {
        "source": calibration.source,
        "slip_definition": str(blocks.definition),
        "law": posterior.law.name,
        "verdict": calibration.verdict.headline(),
    }

    def group(columns: Mapping[str, np.ndarray], *dimensions: str) -> Dataset:
        shape = next(iter(columns.values())).shape
        numbers = {name: np.arange(n) for name, n in zip(dimensions, shape, strict=True)}
        return Dataset({name: (dimensions, x) for name, x in columns.items()}, numbers)

    return DataTree.from_dict(
        {
            "/": Dataset(attrs=attributes),
            "posterior": group(sampled, "chain", "draw"),
            "sample_stats": group({"lp": draws.log_density}, "chain", "draw"),
            "observed_data": group({"traction_force": blocks.traction_force}, "block"),
            "constant_data": group(given, "block"),
        }
    )
