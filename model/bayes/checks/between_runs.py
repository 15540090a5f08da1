# SPDX-License-Identifier: MIT
r"""What differs from run to run: the zero of traction, friction, the zero of slip, the definition.

Each is a random multiple x of a force t, one for each run, of variance v. With the whitened
residuals r of a run, the whitened t, :math:`s = t \cdot r` and :math:`I = |t|^2`, twice the log
likelihood that v explains is

.. math::
    \sum_i \Bigl[\frac{s_i^2 v}{1 + I_i v} - \log(1 + I_i v)\Bigr].
"""

from collections.abc import Iterator
from typing import Final

import numpy as np
from scipy.special import chdtrc

from model.arrays import Array
from model.bayes.advice import Advice, CorrectData, ExcludeRuns, TryDefinition, ZeroBeforeEach
from model.bayes.checks.causes import Cause, Effect, Finding, Question
from model.bayes.checks.linear import Linearised, whiten
from model.slip.definition import slip_per_radius_error

FEWEST_RUNS: Final = 6
"""Least number of runs that tell a scatter."""
ODD: Final = 4.0
"""Times the scatter of the other runs, from which a run is told by name."""
MOST_ODD: Final = 0.25
"""Largest share of the runs that are left out; more are no exception [-]."""
GRID: Final = np.geomspace(1e-4, 3.0, 60)
"""Standard deviations that are tried, over the force of the peak."""


def scatter_between_runs(fit: Linearised, zero_stability: float) -> Iterator[Finding]:
    """Yield how far runs differ in each way; nothing for fewer than `FEWEST_RUNS`.

    The effect is what twice the error of the mean over as many runs does to a force.

    Args:
        fit: The linearised fit, with zeros that scatter by no more than `zero_stability`.
        zero_stability: Scatter of the zeros between runs that the load cell has [N].
    """
    blocks = fit.blocks
    if blocks.n_runs < FEWEST_RUNS:
        return
    peak = float(np.abs(fit.predicted.force).max())
    lever = slip_per_radius_error(blocks.slip, blocks.definition)
    bend = fit.per_slip * blocks.slip**2
    ways = (
        ("zeros of traction", Cause.FORCE_ZERO, np.ones(len(blocks)), "N"),
        ("frictions", Cause.MATERIALS, fit.predicted.force, ""),
        ("zeros of slip", Cause.SLIP_ZERO, fit.per_slip * lever, ""),
        ("slip definitions", Cause.DEFINITION, bend, ""),
    )
    for name, cause, force, unit in ways:
        typical = float(np.sqrt(np.mean(force**2)))
        if typical == 0:
            continue
        sd, gain, odd = _scatter(fit, force / typical * peak)
        size = sd * peak / typical
        text = (
            f"{name} differ by {size:.2g}{' ' * bool(unit)}{unit} (standard deviation) between runs"
        )
        effect = Effect(0.0, 2 * sd / np.sqrt(blocks.n_runs))
        if cause is Cause.FORCE_ZERO and size < 3 * zero_stability:
            effect = Effect(0.0, 0.0)  # the load cell's own
        p = 0.5 * float(chdtrc(1, gain)) * len(ways) if gain > 0 else 1.0
        names = tuple(blocks.run_names[i] for i in odd)
        yield Finding(
            Question.REPEAT,
            (cause,),
            text,
            gain,
            min(p, 1.0),
            effect,
            _advice(cause, text, names),
            generic=True,
        )


def _scatter(fit: Linearised, force: Array) -> tuple[float, float, list[int]]:
    """Return the standard deviation of a force's multiple between runs, its gain, and odd runs.

    Args:
        fit: The linearised fit.
        force: Force of a unit, shape (n,) [N].
    """
    starts = fit.blocks.run_starts()[:-1]
    unit = whiten(fit.blocks, force[:, None], fit.factors)[:, 0]
    told = np.add.reduceat(unit * fit.rest[: len(unit)], starts)
    information = np.add.reduceat(unit**2, starts)
    v = GRID[:, None] ** 2
    gains = np.sum(told**2 * v / (1 + information * v) - np.log1p(information * v), axis=1)
    best = int(np.argmax(gains))
    # Of each run its own multiple, and how far that is beyond the scatter of the middle runs.
    own = told / np.maximum(information, 1e-300)
    error = 1 / np.sqrt(np.maximum(information, 1e-300))
    usual = 1.4826 * float(np.median(np.abs(own[error < np.median(error) * 3])))
    far = np.abs(own) > ODD * np.hypot(usual, error)
    odd = np.flatnonzero(far) if far.mean() <= MOST_ODD else np.array([], dtype=int)
    return (
        (float(GRID[best]), float(gains[best]), odd.tolist()) if gains[best] > 0 else (0.0, 0.0, [])
    )


def _advice(cause: Cause, text: str, odd: tuple[str, ...]) -> Advice:
    """Return what to do: leave out odd runs, if these are few, or mend the cause."""
    if odd:
        return ExcludeRuns(f"{text}, most in {', '.join(odd[:3])}", odd)
    if cause is Cause.FORCE_ZERO:
        return ZeroBeforeEach(text)
    if cause is Cause.DEFINITION:
        return TryDefinition(text)
    if cause is Cause.SLIP_ZERO:
        return CorrectData(text, "measure the radii of both discs before each run, and note which "
                                 "disc was mounted")  # fmt: skip
    return CorrectData(text, "sort the runs by material and fit each alone, or clean the discs "
                             "before each run and measure again")  # fmt: skip
