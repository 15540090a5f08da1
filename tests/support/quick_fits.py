# SPDX-License-Identifier: MIT
"""Fits of few draws and steps, for claims that need no converged posterior."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import pytest

from model.bayes.calibrate import SamplerSettings
from zebro_lab.calibration import stage
from zebro_lab.calibration.priors import KnownPriors
from zebro_lab.calibration.request import CalibrationRequest

FEW = {"FIRST_LOOK": 40, "CHUNK": 10, "IMPORTANCE_DRAWS": 1000, "EFFECTIVE_DRAWS": 100.0}
"""Constants of `model.bayes.calibrate`: moves before the first look, steps at once, and draws."""


NO_PRIOR_STARTS = ("model.bayes.approximation.FEW_BLOCKS", 0)
"""Constant by which all searches for a mode start at the least-squares curve."""


@contextmanager
def few_starts() -> Iterator[None]:
    """Search from the least-squares curve alone, for data that leave no doubt which mode it is."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(*NO_PRIOR_STARTS)
        yield


def fit_quickly(patch: pytest.MonkeyPatch) -> None:
    """Let `calibrate-slip` take blocks of 30, two ensembles, and few steps and draws."""
    for name, value in FEW.items():
        patch.setattr(f"model.bayes.calibrate.{name}", value)
    sampler = stage._sampler

    def settings(request: CalibrationRequest, stated: KnownPriors) -> SamplerSettings:
        usual = sampler(request, stated)
        return replace(usual, ensembles=2, block_length=stated.block_length or 30)

    patch.setattr(stage, "_sampler", settings)
