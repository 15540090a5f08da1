# SPDX-License-Identifier: MIT
"""Checks of faults that no term in the model would mend: of samples, of runs, of priors."""

from dataclasses import replace

import numpy as np

from model.arrays import Array
from model.bayes.advice import Advice, CorrectData, ExcludeRuns, MeasureAlso
from model.bayes.checks.check import Check, decided, not_testable
from model.bayes.checks.fast_noise import fast_noise
from model.bayes.checks.linear import Linearised
from model.bayes.checks.periodic import block_times, find_swing
from model.bayes.checks.raw import (
    clipped,
    delay,
    opposed_runs,
    outliers,
    raw_residuals,
    reach_of_slip_noise,
)
from model.bayes.checks.scatter import friction_scatter
from model.bayes.posterior import SlipPosterior
from model.bayes.preliminary import BlockChoice
from model.slip.samples import SlipSamples

SCATTER_P = 1e-5
SWING_P = 1e-4
MEMORIES = 6.0  # correlation times of the noise that a run holds
FEWEST_SAMPLES = 8  # of a run, that a noise can show in
DELAY_SPANS = (1, 2, 4, 8, 16)  # samples over which slip is seen to change
DELAY_P = 2e-4  # of each of five spans: one sound set in 1,000 fails
FAR_PRIOR = 4.0  # standard deviations of a prior, beyond which a value is implausible
NOISE = {
    "slip_error_scale", "slip_scatter", "noise_floor", "noise_correlation",
    "offset_spread",
}  # fmt: skip


def faults(
    posterior: SlipPosterior,
    fit: Linearised,
    samples: SlipSamples,
    *,
    explained: Array,
    choice: BlockChoice,
) -> tuple[Check, ...]:
    """Make the checks of single samples, of runs and of the values against their priors.

    Those of friction, swing, length of runs and fast noise are left out where they do not apply.

    Args:
        posterior: The posterior of the fit.
        fit: The fit, linearised.
        samples: The samples that were fitted.
        explained: Force of a term that has been found already, at each block, shape (n,) [N].
        choice: How they became blocks, with the autocorrelation time of their residuals.
    """
    residual, slope = raw_residuals(samples, posterior.law, fit.values)
    return (
        _sign(samples),
        _outliers(samples, posterior, fit.values, residual),
        _clipped(samples),
        _delay(samples, residual, slope),
        *_friction(fit, explained),
        *_swing(fit, samples),
        *_long_enough(samples, choice.correlation),
        *fast_noise(posterior, fit, samples, choice, residual, slope),
        _priors(posterior, fit),
    )


def _failed(check: Check, cause: str) -> Check:
    """Return the check with `cause` if it failed, else as it is."""
    return replace(check, cause=cause) if check.failed else check


def _sign(samples: SlipSamples) -> Check:
    """Check that no run's traction opposes its slip, by `opposed_runs`."""
    opposed = np.flatnonzero(opposed_runs(samples))
    names = tuple(samples.run_names[i] for i in opposed)
    cause = f"traction opposes the slip in {_counted(names)} (wrong sign, or exchanged speeds)"
    check = decided(
        "traction has the sign of the slip",
        not names,
        f"runs whose traction opposes their slip: {len(names)}, expected none",
        ExcludeRuns(cause, names),
    )
    return _failed(check, cause)


def _counted(names: tuple[str, ...]) -> str:
    """Format the number of runs as text."""
    return f"{len(names)} run{'s' * (len(names) != 1)}"


def _outliers(
    samples: SlipSamples, posterior: SlipPosterior, values: Array, residual: Array
) -> Check:
    """Check that there are no more `outliers` than chance, or a single fault, makes."""
    found = outliers(samples, residual, reach_of_slip_noise(samples, posterior.law, values))
    cause = f"outliers: {found.count} samples leap by about {found.size:.3g} N"
    advice: Advice = CorrectData(
        cause,
        "look at the raw log about them (cable, plug, noise), skip such rows with [rows] keep in "
        "columns.toml, or leave the runs out, and fit again",
    )
    check = decided(
        "no samples leap from their neighbours",
        not found.matter,
        "samples that leap by more than 8 robust standard deviations and by more than noise of "
        f"slip explains: {found.count} of {len(samples)}"
        + (f", most in run '{samples.run_names[found.run]}'" if found.count else ""),
        advice,
    )
    return _failed(check, cause)


def _clipped(samples: SlipSamples) -> Check:
    """Check that neither traction nor normal force is `clipped` at a limit."""
    name = "no force stops at a limit"
    both = (clipped(samples.traction_force), clipped(samples.normal_force))
    for what, found in zip(("traction", "normal force"), both, strict=True):
        if found is not None:
            cause = f"{what} is clipped: {found.count} samples are exactly {found.limit:.4g} N"
            advice = CorrectData(
                cause, "raise the range of the load cell or of its amplifier, and measure again; "
                "or leave out the runs that reach the limit",
            )  # fmt: skip
            return _failed(decided(name, False, cause, advice), cause)
    return decided(name, True, "no extreme value is repeated as at the end of a range")


def _delay(samples: SlipSamples, residual: Array, slope: Array) -> Check:
    """Check that traction is neither late nor early.

    Of no span of `DELAY_SPANS` may the delay have a two-sided p-value of `DELAY_P` or less.
    `residual` and `slope` are those of the samples by `raw_residuals`, shape (n,) [N].
    """
    name = "traction follows slip at once"
    tries = (delay(samples, residual, slope, span=span) for span in DELAY_SPANS)
    found = max(tries, key=lambda each: -each.p)
    late = f"{found.steps:+.2g} samples"
    if samples.time is not None and len(samples) > 1:
        step = float(np.median(np.diff(samples.time)))
        late = f"{1e3 * step * found.steps:+.3g} ms"
    cause = (
        f"traction is late by {late} or more (delay between load cell and encoders, or hysteresis)"
    )
    advice = CorrectData(
        cause, "give all channels one clock, shift the time of the forces by that much, or hold "
        "each slip for longer than the delay, and fit again",
    )  # fmt: skip
    evidence = f"delay {late}, p = {found.p:.2g}, expected above {DELAY_P:g}"
    return _failed(decided(name, found.p > DELAY_P, evidence, advice), cause)


def _swing(fit: Linearised, samples: SlipSamples) -> list[Check]:
    """Check that no swing by `find_swing` has a p-value up to `SWING_P`; [] where it finds none."""
    found = find_swing(fit, block_times(fit, samples))
    if found is None:
        return []
    unit = "samples" if samples.time is None else "s"
    cause = (
        f"slip swings by about ±{found.slip:.2g} every {found.period:.3g} {unit} (run-out of a "
        "disc, if that is how long it turns)"
    )
    check = decided(
        "residuals do not swing as discs turn",
        found.p > SWING_P,
        f"largest swing every {found.period:.3g} {unit}, p = {found.p:.2g}, expected above "
        f"{SWING_P:g}",
        CorrectData(cause, "measure the run-out of both discs with a dial gauge, true or replace "
                    "the disc, or make runs of whole turns, and measure again"),
    )  # fmt: skip
    return [_failed(check, cause)]


def _long_enough(samples: SlipSamples, correlation: float | None) -> list[Check]:
    """Check that the median run holds `MEMORIES` correlation times of the noise.

    Not testable in shorter runs, or of under `FEWEST_SAMPLES`; [] where `correlation` is None.
    """
    if correlation is None:
        return []
    length = float(np.median([part.stop - part.start for part in samples.slices()]))
    name, memories = "runs outlast the memory of the noise", length / correlation
    evidence = (
        f"a run holds {memories:.0f} correlation times of the noise, at least {MEMORIES:g} needed"
    )
    if length < FEWEST_SAMPLES or memories < MEMORIES:
        why = f"{evidence}, and {FEWEST_SAMPLES} samples; found {length:.0f}"
        advice = MeasureAlso("runs are too short to show their noise", times=4.0)
        return [not_testable(name, why, untested="noise in time (too short)", advice=advice)]
    return [decided(name, True, evidence)]


def _friction(fit: Linearised, explained: Array) -> list[Check]:
    """Check that `friction_scatter` has a p-value above `SCATTER_P`; [] where it is None."""
    found = friction_scatter(fit, explained)
    if found is None:
        return []
    odd = np.argsort(-np.abs(found.runs - np.median(found.runs)))[:3]
    names = ", ".join(fit.blocks.run_names[i] for i in odd)
    cause = (
        f"friction differs by {found.sd:.1%} (standard deviation) between runs, most in {names} "
        "(two materials, or a surface that changes)"
    )
    check = decided(
        "runs have one friction",
        found.p > SCATTER_P,
        f"friction scatters by {found.sd:.1%} between runs, p = {found.p:.2g}, expected above "
        f"{SCATTER_P:g}",
        CorrectData(cause, "sort the runs by material and fit each alone, or clean the discs "
                    "before each run and measure again"),
    )  # fmt: skip
    return [_failed(check, cause)]


def _priors(posterior: SlipPosterior, fit: Linearised) -> Check:
    """Check that each free parameter lies within `FAR_PRIOR` standard deviations of its prior.

    The distance is its coordinate in `fit.z`. Parameters of `NOISE` are not checked.
    """
    free = [p.name for p in posterior.free]
    far = {
        name: float(z)
        for name, z in zip(free, fit.z, strict=True)
        if abs(z) > FAR_PRIOR and name not in NOISE
    }
    values = dict(zip((p.name for p in posterior.parameters), fit.values, strict=True))
    told = ", ".join(f"{name} {values[name]:.3g} ({z:+.1f} sd of its prior)"
                     for name, z in far.items())  # fmt: skip
    cause = f"implausible values: {told} (unit of a force, scale of slip, or a gain)"
    check = decided(
        "values lie within their priors",
        not far,
        told or f"all within {FAR_PRIOR:g} standard deviations",
        CorrectData(cause, "check the units of both forces and of the slip ratio, and weigh the "
                    "load cell; correct columns.toml and fit again"),
    )  # fmt: skip
    return _failed(check, cause)
