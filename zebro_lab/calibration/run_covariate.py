# SPDX-License-Identifier: MIT
"""The covariate of the runs of several tables, such as the pressure of a tyre."""

from collections.abc import Sequence

import numpy as np

from model.arrays import Array
from model.slip.covariate import Covariate
from zebro_lab.calibration.rig_part import RigPart
from zebro_lab.files.errors import SettingsError
from zebro_lab.tables.covariate import StatedCovariate

ONE_LEVEL = 0.03
"""Relative difference of neighbouring values from which they are two levels of a covariate [-]."""


def joined_covariate(parts: Sequence[RigPart]) -> tuple[Covariate, Array] | None:
    """Return the covariate of all parts with its value in each run; None where it tells nothing.

    Its reference is the stated one, else the geometric mean over runs; its scale the largest
    difference of logarithms from that. It tells nothing where none is stated or all runs are at
    one level.

    Args:
        parts: The parts, whose runs are in the order of the samples.

    Raises:
        SettingsError: Some parts state a covariate and others none, or another one.
    """
    stated = _stated(parts)
    if stated is None:
        return None
    values = _values(parts)
    if len(levels(values)) < 2:
        return None
    reference = stated.reference or float(np.exp(np.mean(np.log(values))))
    scale = float(np.abs(np.log(values / reference)).max())
    return Covariate(stated.name, stated.unit, reference, scale), values


def covariate_note(parts: Sequence[RigPart]) -> list[str]:
    """Return a note that says at which levels runs were made, and what cannot be told of it."""
    stated = _stated(parts)
    if stated is None:
        return []
    values = _values(parts)
    found = levels(values)
    named = ", ".join(f"{level:.4g}" for level in found) + f" {stated.unit}".rstrip()
    if len(found) < 2:
        return [f"{stated.name} is {named} in all runs: its effect is not testable"]
    return [f"{stated.name} of runs: {named}" if len(found) < 8 else
            f"{stated.name} of runs: {len(found)} levels from {found[0]:.4g} to {found[-1]:.4g} "
            f"{stated.unit}".rstrip()]  # fmt: skip


def levels(values: Array) -> Array:
    """Return the levels of a covariate: means of values that are no further apart than 3 %.

    Args:
        values: Value in each run, above 0, shape (n_runs,).

    >>> levels(np.array([83.1, 69.3, 83.2, 69.3])).tolist()
    [69.3, 83.15]
    """
    ordered = np.sort(values)
    parts = np.split(ordered, 1 + np.flatnonzero(np.diff(np.log(ordered)) > ONE_LEVEL))
    return np.array([float(np.mean(part)) for part in parts])


def _values(parts: Sequence[RigPart]) -> Array:
    return np.concatenate([part.covariate for part in parts if part.covariate is not None])


def _stated(parts: Sequence[RigPart]) -> StatedCovariate | None:
    """Return what all parts state, the column apart; None if none does; raise where they differ."""
    each = [part.columns.covariate for part in parts]
    first = next((stated for stated in each if stated is not None), None)
    if first is None:
        return None
    for part, stated in zip(parts, each, strict=True):
        if stated is None:
            raise SettingsError(
                f"{part.path.name} states no {first.name}, which the law of the others follows; "
                "state its value there",
                file=part.columns.file, key="covariates",
            )  # fmt: skip
        alike = (stated.name, stated.unit, stated.reference)
        if alike != (first.name, first.unit, first.reference):
            raise SettingsError(
                f"states {stated.name} in '{stated.unit}' (reference {stated.reference}), other "
                f"data {first.name} in '{first.unit}' (reference {first.reference}); expected one "
                "covariate for all",
                file=part.columns.file, key="covariates",
            )  # fmt: skip
    return first
