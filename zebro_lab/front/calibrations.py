# SPDX-License-Identifier: MIT
"""Read rig data and fit slip laws, for notebooks."""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from model.bayes.calibration import Calibration
from model.bayes.verdict import Verdict
from model.slip.curve import SlipCurve
from model.tasks import Watcher
from zebro_lab.calibration import folder as calibration_folder
from zebro_lab.calibration import stage as calibration_stage
from zebro_lab.calibration.draws import posterior_tree
from zebro_lab.calibration.request import (
    CalibrationRequest,
    DefinitionName,
    EngineName,
    LawName,
    SidesName,
)
from zebro_lab.calibration.rig_data import RigData
from zebro_lab.calibration.rig_data import read_rig_data as read_rig_files
from zebro_lab.front.defaults import PathLike, Silent, kept_or_temporary, optional
from zebro_lab.workers import open_executor

if TYPE_CHECKING:
    from xarray import DataTree


@dataclass(frozen=True)
class CalibrationResult:
    """A finished calibration.

    Attributes:
        calibration: The finished fit: posterior, draws, diagnostics, residuals and verdict.
        data: The rig data that were fitted.
        curve: The slip curve, as in `slip.toml`: law, posterior means, covariance, tested ranges.
    """

    calibration: Calibration
    data: RigData
    curve: SlipCurve

    @property
    def verdict(self) -> Verdict:
        """Whether the fit converged and can be trusted, and what to do next."""
        return self.calibration.verdict

    @property
    def summary(self) -> pd.DataFrame:
        """Posterior, prior and diagnostics as in `summary.csv`, SI; its index is the parameter.

        A fixed parameter has the prior "fixed" and NaN for the diagnostics.
        """
        table = calibration_folder.summary_csv(self.calibration)
        return pd.read_csv(io.StringIO(table), index_col="parameter")

    @property
    def posterior(self) -> "DataTree":
        """Posterior draws, log density and block means; a chain is an ensemble of walkers."""
        return posterior_tree(self.calibration)


def read_rig_data(
    *data: PathLike, columns: PathLike | None = None, slip_definition: str | None = None
) -> RigData:
    """Read rig experiments from tables, run folders or folders of either.

    Excluded runs, and copies of other data, are left out.

    Args:
        data: Files and folders of rig data.
        columns: A `columns.toml` for all data, instead of those beside the tables.
        slip_definition: Definition to convert slip ratios to; None keeps that of the data.

    Returns:
        Samples in SI with their source, the files read, and notes.

    Raises:
        ZebroLabError: A file is missing or cannot be used, slip definitions or load cells differ,
            or the samples are too few or of one slip ratio; names file, row and column if known.
    """
    return read_rig_files(
        [Path(each) for each in data], columns=optional(columns), slip_definition=slip_definition
    )


def calibrate(
    *data: PathLike,
    out: PathLike | None = None,
    columns: PathLike | None = None,
    slip_definition: DefinitionName | None = None,
    law: LawName = "magic-formula",
    sides: SidesName = "together",
    prior: Sequence[str] = (),
    prior_from: PathLike | None = None,
    engine: EngineName = "auto",
    max_steps: int = 30_000,
    seed: int = 1,
    watcher: Watcher | None = None,
) -> CalibrationResult:
    """Fit a slip law to rig data by Bayesian inference, as `calibrate-slip` does.

    Args:
        data: Files and folders of rig data.
        out: Calibration folder to write; None to keep no files.
        columns: A `columns.toml` for all data, instead of those beside the tables.
        slip_definition: Definition of the slip ratio to fit in; None for that of the data.
        law: A key of `model.slip.LAWS`, such as "magic-formula"; "compare" fits the
            simplest that predicts left-out runs and loads no worse than the others.
        sides: Whether driving and braking follow one curve; "auto" lets left-out runs decide.
        prior: What is known of parameters beforehand, such as "friction = 0.40 ± 0.05".
        prior_from: Calibration whose posterior is the prior; its law is fitted.
        engine: "auto" to sample the posterior; "laplace" for weighted draws of the
            Laplace approximation in seconds, which nothing confirms.
        max_steps: Largest number of sampler moves; a fit that has not converged ends then.
        seed: Seed of all random numbers.
        watcher: Receives progress and may request a stop; None for neither.

    Raises:
        ZebroLabError: The data cannot be used, the folder cannot be replaced or written, or a stop
            was requested.
        ModelError: The law is unknown or the fit failed.
    """
    with kept_or_temporary(out) as folder:
        request = CalibrationRequest(
            data=tuple(Path(each) for each in data),
            out=folder,
            columns=optional(columns),
            slip_definition=slip_definition,
            law=law,
            sides=sides,
            prior=tuple(prior),
            prior_from=optional(prior_from),
            engine=engine,
            max_steps=max_steps,
            seed=seed,
        )
        with open_executor(request.workers) as executor:
            found, rig_data = calibration_stage.calibrate(
                request, watcher or Silent(), executor=executor
            )
        return CalibrationResult(found, rig_data, calibration_folder.read_slip(folder))


def read_slip_curve(path: PathLike) -> SlipCurve:
    """Read the slip curve of a calibration.

    Args:
        path: A `slip.toml`, or the folder that holds it.

    Raises:
        DataError: The file is missing, damaged, of another schema, or has an unknown law or
            invalid values.
    """
    return calibration_folder.read_slip(Path(path))
