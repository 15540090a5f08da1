# SPDX-License-Identifier: MIT
"""What single samples, signs and values of a fit tell of its data, as findings."""

from collections.abc import Iterator
from typing import Final

import numpy as np
from scipy.special import ndtr

from model.arrays import Array
from model.bayes.advice import CorrectData, ExcludeRuns
from model.bayes.checks.causes import Cause, Effect, Finding, Question
from model.bayes.checks.linear import Linearised
from model.bayes.checks.raw import (
    clipped,
    frozen,
    opposed_runs,
    oscillation,
    outliers,
    raw_residuals,
    reach_of_slip_noise,
)
from model.bayes.plain.fit import PlainFit
from model.bayes.posterior import SlipPosterior
from model.slip.samples import SlipSamples

PLAIN: Final = float("inf")
"""Gain of what is plain to see in single samples."""
COMMON: Final = 0.005
"""Share of outliers, from which they are plain to see; fewer hide no other cause [-]."""
OF_FEW: Final = 20.0
"""Gain of each of fewer outliers, whatever its size [-]."""
HARMFUL: Final = 0.2
"""Amplitude over traction, from which a curve of means says little of an oscillating force [-]."""
BROAD: Final = 1.0
"""Standard deviations by which priors of a law may be too narrow: they are guesses [-]."""
SMALL: Final = 0.2
"""Share of the largest slip, up to which a wrong zero of slip can turn its sign [-]."""
FAR_FROM: Final = {
    "slip_stiffness": Cause.FORCE_SCALE,
    "friction": Cause.FORCE_SCALE,
    "gain_traction": Cause.FORCE_SCALE,
    "gain_normal": Cause.LOAD,
    "bias_normal": Cause.LOAD,
    "crosstalk": Cause.CROSSTALK,
    "radius_error": Cause.SLIP_ZERO,
    "rolling_resistance": Cause.FORCE_ZERO,
}
"""What is likely wrong where a parameter lies far from its prior."""


def sample_findings(
    posterior: SlipPosterior, fit: Linearised, samples: SlipSamples, plain: PlainFit
) -> tuple[list[Finding], list[str]]:
    """Look at single samples, at signs, and at the values of the fit beside their priors.

    Args:
        posterior: The posterior of the fit.
        fit: The fit, linearised.
        samples: The samples that were fitted.
        plain: The plain fit, which is robust: of a table of means it tells which rows lie far out.

    Returns:
        Findings, and notes on what does not spoil the answer.
    """
    residual, slope = raw_residuals(samples, posterior.law, fit.values)
    reach = reach_of_slip_noise(samples, posterior.law, fit.values)
    peak = max(float(np.abs(fit.predicted.force).max()), 1e-300)
    if len(samples) <= 2 * samples.n_runs:
        residual = plain.residual(samples.slip, samples.normal_force, samples.traction_force)
    findings = [
        *_signs(samples), *_outliers(samples, residual, reach, peak), *_clipped(samples),
        *_frozen(samples), *_far_from_priors(posterior, fit),
    ]  # fmt: skip
    swings, notes = _oscillation(samples, residual, slope)
    return [*findings, *swings], notes


def _signs(samples: SlipSamples) -> Iterator[Finding]:
    """Yield runs whose traction opposes their slip; of small slips the zero is likelier wrong."""
    opposed = opposed_runs(samples)
    names = tuple(samples.run_names[i] for i in np.flatnonzero(opposed))
    if names:
        text = f"traction opposes the slip in {len(names)} of {samples.n_runs} runs"
        largest = np.abs(samples.slip)[opposed[samples.run]].max()
        small = largest < SMALL * np.abs(samples.slip).max()
        causes = (Cause.SLIP_ZERO, Cause.FORCE_SCALE) if small else (Cause.FORCE_SCALE,)
        yield Finding(
            Question.UNITS, causes, text, PLAIN, 0.0, Effect(0.0, 1.0),
            ExcludeRuns(f"{text} (wrong sign, exchanged speeds, or a wrong zero of slip)", names),
        )  # fmt: skip


def _outliers(
    samples: SlipSamples, residual: Array, reach: Array, peak: float
) -> Iterator[Finding]:
    """Yield samples that leap; their effect is their root mean square over the peak force."""
    found = outliers(samples, residual, reach)
    if not found.count:
        return
    names = tuple(samples.run_names[i] for i in found.runs)
    text = (
        f"{found.count} of {len(samples)} samples are off by about {found.size:.3g} N, most in "
        f"'{names[0]}'"
    )
    means = len(samples) <= 2 * samples.n_runs
    yield Finding(
        Question.RAW, (Cause.OUTLIERS,), text,
        PLAIN if means or found.share >= COMMON else OF_FEW * found.count, 0.0,
        Effect(0.0, np.sqrt(found.share) * found.size / peak),
        ExcludeRuns(text, names) if means else CorrectData(
            text, "look at the raw log about them (cable, plug, noise), skip such rows with [rows] "
            "keep in columns.toml, or leave the runs out, and fit again",
        ),
    )  # fmt: skip


def _clipped(samples: SlipSamples) -> Iterator[Finding]:
    """Yield that traction or normal force stops at a limit."""
    both = ("traction", samples.traction_force), ("normal force", samples.normal_force)
    for what, force in both:
        found = clipped(force)
        if found is not None:
            text = (
                f"{found.count} of {len(force)} samples of {what} are exactly {found.limit:.4g} N"
            )
            yield Finding(
                Question.RAW, (Cause.SATURATION,), text, PLAIN, 0.0, Effect(0.0, 1.0),
                CorrectData(text, "raise the range of the load cell or of its amplifier and "
                            "measure again, or leave out the runs that reach the limit"),
            )  # fmt: skip


def _frozen(samples: SlipSamples) -> Iterator[Finding]:
    """Yield that traction keeps its value over stretches of samples."""
    share = frozen(samples.traction_force, samples.run)
    if share:
        text = f"{share:.1%} of the samples of traction repeat the value before, in long stretches"
        yield Finding(
            Question.RAW, (Cause.FROZEN, Cause.TIMING), text, PLAIN, 0.0, Effect(0.0, share / 2),
            CorrectData(text, "look for lost samples that a logger filled with the last value, and "
                        "measure again"),
        )  # fmt: skip


def _far_from_priors(posterior: SlipPosterior, fit: Linearised) -> Iterator[Finding]:
    """Yield parameters whose value is improbable before the data, by their coordinates."""
    own = posterior.own_coordinates(fit.z[None])[0]
    values = dict(zip((p.name for p in posterior.parameters), fit.values, strict=True))
    for parameter, z in zip(posterior.free, own, strict=True):
        cause = FAR_FROM.get(parameter.name)
        if cause is None:
            continue
        beyond = abs(z) - BROAD * (parameter in posterior.law.parameters)
        p = min(1.0, 2 * len(FAR_FROM) * float(ndtr(-beyond)))
        question = Question.SLIP if cause in (Cause.SLIP_ZERO, Cause.FORCE_ZERO) else Question.UNITS
        text = f"{parameter.name} is {values[parameter.name]:.3g}, {z:+.1f} sd of its prior"
        yield Finding(
            question, (cause,), text, float(z**2), p, Effect(0.0, 1.0),
            CorrectData(text, "check the units of both forces and of the slip ratio, the radii and "
                        "the load cell; correct columns.toml and fit again"),
        )  # fmt: skip


def _oscillation(
    samples: SlipSamples, residual: Array, slope: Array
) -> tuple[list[Finding], list[str]]:
    """Return an oscillation of traction as a finding where it is large, else as a note."""
    found = oscillation(samples, residual, slope)
    if found is None:
        return [], []
    unit = "periods a sample" if samples.time is None else "Hz"
    what = (
        "slip swings with it: run-out of a disc, or a speed that hunts"
        if found.in_slip
        else "stick-slip, in the force and not in the slip"
    )
    text = (
        f"traction oscillates by ±{found.amplitude:.1%} at {found.frequency:.2g} {unit} in "
        f"{found.runs} of {samples.n_runs} runs ({what})"
    )
    if found.amplitude < HARMFUL:
        return [], [f"{text}; the curve is that of its mean"]
    cause = Cause.RUN_OUT if found.in_slip else Cause.STICK_SLIP
    advice = CorrectData(text, "stiffen the mount or damp it, true the discs, and measure again; "
                         "a curve of means says little of such a force")  # fmt: skip
    finding = Finding(
        Question.RAW, (cause,), text, PLAIN, 0.0, Effect(0.0, found.amplitude), advice
    )
    return [finding], []
