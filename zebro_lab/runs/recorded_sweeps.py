# SPDX-License-Identifier: MIT
"""Segment a recording of a rig that sweeps slip continuously into its sweeps."""

import numpy as np
from numpy.typing import NDArray

from model.arrays import Array
from rig.slip_rig.sweeps import STANDING, sweeps
from zebro_lab.files.errors import DataError
from zebro_lab.runs.folder import LOG_FILE, SlipRigRun

SWEEP = "sweep"
"""Name of the column with the sweep number."""


def recorded_sweeps(run: SlipRigRun) -> tuple[NDArray[np.intp], tuple[str, ...]]:
    """Number the sweeps of a recorded run: stretches without jumps of slip, leg disc turning.

    Returns:
        Sweep number of each sample, from 1; 0 outside sweeps, shape (n,). Then a note with the
        share of samples outside sweeps, if there are any.

    Raises:
        DataError: No sample is in a sweep: the leg disc never turned, or slip jumped throughout.
    """
    table, constants = run.table, run.manifest.constants
    speed_leg = table.omega_leg * constants["radius_leg"]
    number = 1 + sweeps(table.t, speed_leg, table.omega_ground * constants["radius_ground"])
    left_out = float(np.mean(number == 0))
    if left_out == 1:
        raise DataError(_why_none(speed_leg), file=run.folder / LOG_FILE)
    if not left_out:
        return number, ()
    note = (
        f"{run.folder.name}: {left_out:.1%} of the samples are ignored, because slip jumped "
        "between two sweeps or the leg disc stood still"
    )
    return number, (note,)


def _why_none(speed_leg: Array) -> str:
    if np.abs(speed_leg).max() <= STANDING:
        return "the leg disc never turned, so that slip is undefined; record while the rig runs"
    return "slip jumped all the time, so that there is no sweep; change the slip ratio more slowly"
