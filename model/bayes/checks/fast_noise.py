# SPDX-License-Identifier: MIT
"""Check whether fast fluctuation of slip is known to be noise of the speeds or wander of slip."""

import numpy as np

from model.arrays import Array
from model.bayes.advice import CorrectData
from model.bayes.averaging.blocks import block_means
from model.bayes.averaging.fast_wander import FastWander, fast_wander
from model.bayes.averaging.slip_noise import slip_noise_variance
from model.bayes.checks.check import Check, decided, not_testable
from model.bayes.checks.linear import Linearised
from model.bayes.likelihood import predict_blocks
from model.bayes.posterior import SlipPosterior
from model.bayes.preliminary import BlockChoice
from model.slip.samples import SlipSamples

NAME = "noise of slip is told from fast wander"
HARMLESS = 0.5  # posterior standard deviations between both extremes
TOLERATED = 1.0  # of them, by which the error of the share may move a parameter: of noise or wander
MIXED = 0.3  # the same, where the share is that of a mixture and its error is in no interval
OTHER_SHARE = 4.0  # standard deviations, from which the share that blocks have is wrong


def fast_noise(
    posterior: SlipPosterior,
    fit: Linearised,
    samples: SlipSamples,
    choice: BlockChoice,
    residual: Array,
    slope: Array,
) -> list[Check]:
    """Check that the white part of measured slip is known to be noise or wander, if it matters.

    Both extremes are computed: how far the law's parameters would move if all of it were noise of
    the speeds, or all of it wander of the slip faster than two samples. Where that is more than
    `HARMLESS` posterior standard deviations, the force has to tell the share of wander so well
    that its error moves no parameter by more than `TOLERATED`. A share between noise alone and
    wander alone is used by the fit, but its error is not part of the posterior: it has to be known
    so well that the parameters move by `MIXED` at most. Otherwise the check is not testable.

    Args:
        posterior: The posterior of the fit.
        fit: The fit, linearised.
        samples: The samples that were fitted.
        choice: How they became blocks.
        residual: Residual of each sample, shape (n,) [N].
        slope: Slope of force in slip, shape (n,) [N].

    Returns:
        A list of the check; empty where measured slip has no white part.
    """
    if not slip_noise_variance(samples).any():
        return []
    noise, wander = (_moved(posterior, fit, samples, choice, share) for share in (0.0, 1.0))
    k = len(posterior.law.parameters)
    free = [p.name for p in posterior.free]
    own = [i for i, name in enumerate(free) if name in {p.name for p in posterior.law.parameters}]
    apart = np.abs((wander - noise) / fit.spread())[own]
    largest = float(apart.max(initial=0.0))
    both = posterior.values(np.stack([fit.z + noise, fit.z + wander]))[:, :k]
    told = ", ".join(
        f"{p.symbol} {one:.4g} or {other:.4g}"
        for p, one, other in zip(posterior.law.parameters, *both, strict=True)
    )
    extremes = (
        f"if the fast part of slip were noise alone, or wander alone: {told} (at most "
        f"{largest:.1f} posterior standard deviations apart)"
    )
    if largest <= HARMLESS:
        return [decided(NAME, True, f"{extremes}; it does not matter")]
    found = fast_wander(samples, residual, slope)
    if found is None or found.sd * largest > (MIXED if found.mixed else TOLERATED):
        return [_untested(found, choice.wander_share, extremes)]
    return [_told(found, choice.wander_share, extremes)]


def _moved(
    posterior: SlipPosterior,
    fit: Linearised,
    samples: SlipSamples,
    choice: BlockChoice,
    share: float,
) -> Array:
    """Compute how far the fit's coordinates move if another share of wander is taken, (d,).

    To first order: by the change of the predicted forces of blocks that are made with it.
    """
    if share == choice.wander_share:
        return np.zeros(len(fit.z))
    blocks = block_means(samples, choice.length, wander_share=share)
    force = predict_blocks(blocks, posterior.law, fit.values[None]).force[0]
    return -fit.absorbed(force - fit.predicted.force)


def _untested(found: FastWander | None, used: float, extremes: str) -> Check:
    """Return the check where the force does not tell the share of wander well enough."""
    seen = "nothing" if found is None else f"{found.share:.0%} ± {found.sd:.0%}"
    why = (
        f"slip fluctuates from sample to sample, by noise of the speeds or by wander faster than "
        f"two samples; traction follows {seen} of it, and the fit takes {used:.0%} for wander; "
        f"{extremes}"
    )
    advice = CorrectData(
        "noise of slip is not told from wander faster than two samples",
        "record speeds and forces four times as often, or with better speed sensors, and fit "
        "again; until then use both extremes of the check",
    )
    return not_testable(NAME, why, untested="noise or fast wander of slip", advice=advice)


def _told(found: FastWander, used: float, extremes: str) -> Check:
    """Check that the share of wander used is within `OTHER_SHARE` standard deviations of that told.

    The estimate is clipped to 0 to 1; its standard deviation counts as 0.02 at least.
    """
    seen = f"{found.share:.0%} ± {found.sd:.0%}"
    evidence = (
        f"by its correlation in time the fast part of slip is noise; traction follows {seen} of "
        f"it, and {used:.0%} is taken for wander; {extremes}"
    )
    close = abs(np.clip(found.share, 0.0, 1.0) - used) <= OTHER_SHARE * max(found.sd, 0.02)
    advice = CorrectData(
        f"traction follows {seen} of the fast part of slip, which the fit takes otherwise",
        "record speeds and forces more often, and fit again",
    )
    return decided(NAME, bool(close), evidence, advice)
