# SPDX-License-Identifier: MIT
"""Slip laws that a request names, or leaves to be chosen by the data."""

from typing import Final

import numpy as np

from model.bayes.averaging.blocks import block_means
from model.bayes.averaging.load_levels import load_levels
from model.slip.law import SlipLaw
from model.slip.laws import APART, LAWS, TOGETHER, slip_law
from model.slip.magic_formula import MagicFormula
from model.slip.samples import SlipSamples
from model.slip.sided import SidedLaw
from zebro_lab.calibration.request import COMPARE, CalibrationRequest
from zebro_lab.files.errors import SettingsError

ONE_CURVATURE: Final = "one curvature E at every load"
FEWEST_BLOCKS: Final = 0.02
"""Least share of blocks that drive, and of blocks that brake, for a fit of both sides [-]."""
PEAK_WITH_LOAD: Final = "peak slip grows with load"


def candidates(request: CalibrationRequest, samples: SlipSamples) -> dict[str, SlipLaw]:
    """Return the laws to choose from, by reported name, the preferred first.

    They are the Magic Formulas, with `--law compare` the others too, else the law that is named.
    With `--sides apart`, driving and braking have a stiffness and friction each in every law; with
    `--sides auto`, such laws follow those with one curve for both.

    Args:
        request: Options: law, dependence on load, and sides.
        samples: The samples, whose loads and signs of slip decide what can be told apart.

    Raises:
        SettingsError: Sides are to be fitted apart, and slip has one sign.
    """
    laws = _together(request, samples)
    return _sided(laws, request, samples)


def _sided(
    laws: dict[str, SlipLaw], request: CalibrationRequest, samples: SlipSamples
) -> dict[str, SlipLaw]:
    """Return laws with driving and braking together or apart, as asked for; with "auto" both.

    If slip has one sign, sides cannot be told apart: "auto" gives the laws as they are, and "apart"
    raises `SettingsError`.
    """
    if request.sides == TOGETHER:
        return laws
    both_signs = _has_both_signs(samples)
    if request.sides == APART and not both_signs:
        raise SettingsError(
            "slip has one sign in these data, so there is one side to fit; leave out --sides",
            key="--sides",
        )
    if request.sides == APART:
        return {name: SidedLaw(law) for name, law in laws.items()}
    if not both_signs:
        return laws
    return {**laws, **{f"{name}, sides apart": SidedLaw(law) for name, law in laws.items()}}


def _has_both_signs(samples: SlipSamples) -> bool:
    """Return whether slip drives in some blocks and brakes in others, beyond its noise.

    Of blocks of 10 samples, each sign needs a share of `FEWEST_BLOCKS` in which slip is over three
    standard deviations from zero.
    """
    blocks = block_means(samples, 10)
    clear = np.abs(blocks.slip) > 3 * np.sqrt(blocks.slip_variance())
    shares = [np.mean(clear & (sign * blocks.slip > 0)) for sign in (1, -1)]
    return bool(min(shares) >= FEWEST_BLOCKS)


def _together(request: CalibrationRequest, samples: SlipSamples) -> dict[str, SlipLaw]:
    """Return the laws to choose from with driving and braking on one curve.

    Another law than the Magic Formula, if named, is the only one. Of the Magic Formula there are
    one or two by its curvature (`_formulas`); a single one has the law's own name. With `--law
    compare` the other laws are added, and at several loads load-sensitive Magic Formulas.
    """
    if request.law not in (MagicFormula.name, COMPARE):
        return {request.law: slip_law(request.law)}
    several = len(load_levels(block_means(samples, 10))) > 1
    formulas = _formulas(samples, sensitive=request.load_sensitivity, several=several)
    if request.law != COMPARE:
        return formulas if len(formulas) > 1 else {request.law: next(iter(formulas.values()))}
    found: dict[str, SlipLaw] = {_short(name): law for name, law in formulas.items()}
    found |= {name: slip_law(name) for name in LAWS if name != MagicFormula.name}
    if several:  # at one load its exponents are the priors'
        sensitive = _formulas(samples, sensitive=True, several=True)
        found |= {f"{_short(name)}, load-sensitive": law for name, law in sensitive.items()}
    return found


def _short(name: str) -> str:
    """Return the name of a Magic Formula in a comparison of laws, by the name of its curvature."""
    known = {ONE_CURVATURE: "one E", PEAK_WITH_LOAD: "peak by load"}
    return f"{MagicFormula.name}, {known[name]}"


def _formulas(samples: SlipSamples, *, sensitive: bool, several: bool) -> dict[str, SlipLaw]:
    """Return the Magic Formulas by a name of their curvature, the preferred first.

    With `several` loads there is a second one, whose peak slip grows with load; `sensitive` lets
    friction and stiffness vary with load.
    """
    middle_load = float(np.median(samples.normal_force))
    laws: dict[str, SlipLaw] = {ONE_CURVATURE: MagicFormula("constant", sensitive, middle_load)}
    if several:  # at one load the two are the same
        laws[PEAK_WITH_LOAD] = MagicFormula("peak", sensitive, middle_load)
    return laws
