# SPDX-License-Identifier: MIT
"""From samples to a posterior ready to sample: block means, priors, modes, cross-validation."""

from collections.abc import Iterator, Mapping
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np

from model.bayes.approximation import starting_points, straightened
from model.bayes.averaging.blocks import SlipBlocks, block_means
from model.bayes.averaging.run_noise import noise_sizes, with_true_loads
from model.bayes.checks.raw import opposed_runs
from model.bayes.cross_validation import CrossValidation, cross_validate
from model.bayes.drawing.batches import in_batches
from model.bayes.drawing.laplace import Laplace, find_modes
from model.bayes.plain.fit import PlainFit, plain_fit
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.bayes.preliminary import BlockChoice, choose_block_length
from model.bayes.priors import Prior
from model.bayes.stated_priors import UNSTATED, StatedPriors, with_stated
from model.errors import DomainError, FitError, InsufficientData
from model.slip.law import SlipLaw
from model.slip.rig_errors import USUAL, RigErrors
from model.slip.samples import SlipSamples

MOST_FORCE = 1e9  # above any rig, and far below the overflow of squared forces [N]
UNSTATED_GAIN_SD = 0.01  # of a load cell that nobody has weighed: cells, mounts and wiring differ
MOST_OPPOSED = 0.9  # share of the runs that slip, from which it is the data's sign that is wrong
SHORT_CALLS = 500  # blocks below which calls of the density are too short for threads to help
CLEAR_WIN = 2.0  # standard errors by which a later law must predict better to be preferred


@dataclass(frozen=True)
class PreparedFit:
    """Posterior of one law, ready to sample.

    Attributes:
        posterior: Posterior density, with blocks, law and priors.
        modes: Laplace approximations at the modes, the highest first.
        cross_validation: Prediction of left-out runs; None for one run or without validation.
        block_choice: The block length and the reason for it.
        load_cell: Prior knowledge of the load cell.
        rig_errors: Prior knowledge of the rig's geometry and rolling resistance.
        defaults: Default prior of each parameter by name, beside those of the posterior.
        plain: The plain fit of the same law.
        stated: Priors that were stated.
    """

    posterior: SlipPosterior
    modes: tuple[Laplace, ...]
    cross_validation: CrossValidation | None
    block_choice: BlockChoice
    load_cell: LoadCell
    rig_errors: RigErrors
    defaults: Mapping[str, Prior]
    plain: PlainFit
    stated: StatedPriors = UNSTATED

    @property
    def laplace(self) -> Laplace:
        """The Laplace approximation at the highest mode."""
        return self.modes[0]


def scaled_load_cell(samples: SlipSamples, known: Mapping[str, float]) -> LoadCell:
    """Build the prior knowledge of a load cell from known fields and defaults scaled to the forces.

    Zero stability is 0.15 N, but at least 0.5 % of the largest traction; the standard deviation of
    the bias is 0.05 N, but at least 0.2 % of the largest load: a tyre bench has a larger cell. That
    of the gains is `UNSTATED_GAIN_SD`, and the crosstalk's that of `LoadCell`.

    Args:
        samples: The samples.
        known: Fields of `LoadCell` that are known, by name; they replace the defaults. Any other
            name is a TypeError.
    """
    defaults = {
        "zero_stability": max(0.15, 0.005 * float(np.abs(samples.traction_force).max())),
        "bias_sd": max(0.05, 0.002 * float(samples.normal_force.max())),
        "gain_sd": UNSTATED_GAIN_SD,
    }
    return LoadCell(**{**defaults, **known})


def prepare_fit(
    samples: SlipSamples,
    law: SlipLaw,
    *,
    load_cell: LoadCell,
    rng: np.random.Generator,
    rig_errors: RigErrors = USUAL,
    block_choice: BlockChoice | int | None = None,
    validate: bool = True,
    executor: Executor | None = None,
    stated: StatedPriors = UNSTATED,
    threads: int = 1,
) -> PreparedFit:
    """Average the samples, build the posterior, find its modes and cross-validate it.

    Args:
        samples: The samples.
        law: The slip law.
        load_cell: Prior knowledge of the load cell.
        rng: Source of randomness of the starting points.
        rig_errors: Prior knowledge of the rig's geometry and rolling resistance.
        block_choice: How samples become blocks, or the number of samples in a block. That is found
            from the residuals when None, the noise of slip also for a number.
        validate: Whether to cross-validate, which a single run never is.
        executor: Where the folds of the cross-validation are fitted; None for here.
        stated: Priors that replace default ones; the block length is chosen without them.
        threads: Number of batches of points whose density is computed at once in the searches for
            modes, from `SHORT_CALLS` blocks on.

    Raises:
        InsufficientData: There are fewer samples than the law's parameters plus two, traction is
            constant, or no load exceeds the load cell's zero stability.
        DomainError: A force exceeds `MOST_FORCE` or is NaN, traction opposes the slip, or a stated
            prior cannot be used.
        FitError: The priors allow no valid curve, no curve comes near the forces, no start of a
            search for a mode lies inside the support, or a numerical routine failed.
    """
    _require_enough(samples, law)
    require_forces(samples, load_cell)
    with explain_numerical_errors(samples, law):
        return _prepared(
            samples, law, load_cell, rig_errors, rng, block_choice, validate, executor, stated,
            threads,
        )  # fmt: skip


@contextmanager
def explain_numerical_errors(samples: SlipSamples, law: SlipLaw) -> Iterator[None]:
    """Convert numerical failures within the context into a `FitError` that describes the data.

    Args:
        samples: The samples that are fitted.
        law: The slip law.

    Raises:
        FitError: A `LinAlgError` or `ArithmeticError` was raised (NumPy's overflows only warn).
    """
    try:
        yield
    except (np.linalg.LinAlgError, ArithmeticError) as error:
        ranges = (
            f"{name} from {values.min():.3g} to {values.max():.3g}{unit}"
            for name, values, unit in (
                ("slip", samples.slip, ""),
                ("normal force", samples.normal_force, " N"),
                ("traction force", samples.traction_force, " N"),
            )
        )
        raise FitError(
            f"the fit of '{law.name}' failed numerically ({error}) with {', '.join(ranges)}; check "
            "units and signs, or add other set-points"
        ) from error


def _prepared(
    samples: SlipSamples,
    law: SlipLaw,
    load_cell: LoadCell,
    rig_errors: RigErrors,
    rng: np.random.Generator,
    block_choice: BlockChoice | int | None,
    validate: bool,
    executor: Executor | None,
    stated: StatedPriors,
    threads: int,
) -> PreparedFit:
    """Compute the prepared fit; arguments are those of `prepare_fit`."""
    everything = block_means(samples, 1 if len(samples) < 1000 else len(samples) // 1000)
    defaults = default_priors(law, everything, load_cell, rig_errors)
    plain = plain_fit(samples, law, priors=defaults, zero_sd=rig_errors.radius_ratio, rng=rng)
    choice = block_choice
    if not isinstance(choice, BlockChoice):
        choice = choose_block_length(samples, plain, length=choice)
    blocks = block_means(samples, choice.length, wander_share=choice.wander_share)
    blocks = with_noise(blocks, choice.plain or plain)  # the same for all laws compared
    fixed = not_identified(blocks)
    priors, correlation = with_stated(defaults, stated, fixed=fixed)
    posterior = SlipPosterior(blocks, law, priors, fixed, correlation)
    starts = starting_points(posterior, plain, rng)
    density = posterior.log_density
    if len(blocks) >= SHORT_CALLS:
        density = in_batches(density, threads)
    posterior, modes = straightened(posterior, find_modes(density, starts), rng)
    fit = PreparedFit(
        posterior, modes, None, choice, load_cell, rig_errors, defaults, plain, stated
    )
    return validated(fit, executor=executor) if validate else fit


def with_noise(blocks: SlipBlocks, plain: PlainFit) -> SlipBlocks:
    """Return blocks with what is known of true loads and of the size of each run's noise.

    Args:
        blocks: The block means, with loads as measured.
        plain: The plain fit of the same data.
    """
    load, step = blocks.run_mean(blocks.normal_force)[blocks.run], 1e-3
    slip = plain.true_slip(blocks.slip)
    more, less = (plain.law.force(slip, load * (1 + side), plain.values) for side in (step, -step))
    residual = plain.residual(blocks.slip, load, blocks.traction_force)
    slope = (more - less) / (2 * step * load)
    blocks = with_true_loads(blocks, residual, slope)
    residual = plain.residual(blocks.slip, blocks.normal_force, blocks.traction_force)
    slip_slope = plain.law.slip_derivative(slip, load, plain.values)
    return replace(blocks, noise_size=noise_sizes(blocks, residual, slip_slope))


def validated(fit: PreparedFit, *, executor: Executor | None = None) -> PreparedFit:
    """Return a fit with its cross-validation; a single run is not cross-validated.

    Args:
        fit: The fit, with or without cross-validation.
        executor: Where the folds are fitted; None for here.

    Raises:
        FitError: Without a fold's runs the mode lies outside the posterior's support.
    """
    if fit.cross_validation is not None or fit.posterior.blocks.n_runs < 2:
        return fit
    validation = cross_validate(fit.posterior, fit.laplace, executor=executor)
    return replace(fit, cross_validation=validation)


def _require_enough(samples: SlipSamples, law: SlipLaw) -> None:
    """Raise `InsufficientData` for fewer samples than the law's parameters plus two."""
    needed = len(law.parameters) + 2
    if len(samples) < needed:
        raise InsufficientData(
            f"{len(samples)} samples cannot determine the {len(law.parameters)} parameters of "
            f"'{law.name}' and its noise; at least {needed} are needed"
        )


def require_forces(samples: SlipSamples, cell: LoadCell) -> None:
    """Check range and sign of forces, that traction varies and that loads exceed the zero error.

    Args:
        samples: The samples, at least one.
        cell: Prior knowledge of the load cell.

    Raises:
        InsufficientData: Traction is constant, or no load exceeds the cell's zero stability.
        DomainError: The absolute value of a force exceeds `MOST_FORCE`, or a force is NaN; or
            traction opposes the slip in nine of ten runs that slip.
    """
    loads, traction = samples.normal_force, samples.traction_force
    for name, force in (("normal", loads), ("traction", traction)):
        largest = float(np.abs(force).max())
        if not largest <= MOST_FORCE:
            raise DomainError(
                f"{name} force reaches {largest:.15g} N in absolute value; expected numbers up to "
                f"{MOST_FORCE:g} N: check its unit"
            )
    if np.ptp(traction) == 0:
        raise InsufficientData(
            f"traction force is {traction[0]:g} N in all {len(samples)} samples; a curve needs "
            "forces that follow the slip: check the column and the load cell"
        )
    _require_sign(samples)
    if loads.max() <= cell.zero_stability:
        raise InsufficientData(
            f"the largest normal force is {loads.max():.3g} N, no more than the load cell's own "
            f"zero stability of {cell.zero_stability:.3g} N; "
            f"{_implausible(float(loads.max()), float(np.abs(traction).max()))}"
        )


def _require_sign(samples: SlipSamples) -> None:
    """Raise `DomainError` if traction opposes the slip in `MOST_OPPOSED` of the runs that slip."""
    opposed, prompt = opposed_runs(samples), opposed_runs(replace(samples, slip=-samples.slip))
    told = int(opposed.sum()) + int(prompt.sum())
    if told and opposed.sum() >= MOST_OPPOSED * told:
        raise DomainError(
            f"traction opposes the slip in {opposed.sum()} of {told} runs that slip; expected both "
            "of one sign, positive where the leg drives: turn the sign of the traction or of the "
            "slip ratio, or exchange the two speeds if they were swapped"
        )


def _implausible(load: float, traction: float) -> str:
    """Return advice when the largest load is below the zero stability, by the largest forces [N].

    The advice is about the unit if both are below 1 N, about the columns if traction is more than
    ten times the load, and else about the zero stability.
    """
    if max(load, traction) < 1:
        return "are the forces in kN? State their unit, or the zero stability of the load cell"
    if traction > 10 * load:
        return (
            f"traction force reaches {traction:.3g} N, implausible under such a load: check both "
            "columns and their units"
        )
    return "such a cell measures no such load: correct the cell's zero stability, or the loads"


def not_identified(blocks: SlipBlocks) -> dict[str, float]:
    """Return fixed values by name, of parameters that these blocks have nothing to say of.

    Run offsets and noise correlation are zero if no run has two blocks, and the scale of slip
    errors is 1 if no slip has any.

    Args:
        blocks: The block means.
    """
    single = {"noise_correlation": 0.0, "offset_spread": 0.0}
    erring = bool(blocks.slip_error.any() or blocks.run_slip_error.any())
    return {
        **(single if len(blocks) == blocks.n_runs else {}),
        **({} if erring else {"slip_error_scale": 1.0}),
    }
