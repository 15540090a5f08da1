# SPDX-License-Identifier: MIT
"""Calibrate a slip law from rig samples: choose the law, sample its posterior, check the result."""

from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from model.bayes.calibration import Calibration, conclude
from model.bayes.drawing.convergence import Convergence, assess
from model.bayes.drawing.importance import Effort, draws_at_modes
from model.bayes.drawing.mixture import StudentMixture
from model.bayes.drawing.sampler import Chains, advance, start_chains
from model.bayes.estimate import thin_draws
from model.bayes.fit import (
    SHORT_CALLS,
    PreparedFit,
    explain_numerical_errors,
    prepare_fit,
    require_forces,
    validated,
)
from model.bayes.law_scores import (
    LawScores,
    choose_by_runs,
    choose_law,
    load_groups,
    score_laws,
    weigh_law,
)
from model.bayes.posterior import LoadCell
from model.bayes.preliminary import BlockChoice
from model.bayes.preview import Preview, preview, weighted_posterior
from model.bayes.run_out import RunOut, find_run_out, without_run_out
from model.bayes.stated_priors import UNSTATED, StatedPriors
from model.errors import FitError
from model.slip.law import SlipLaw
from model.slip.rig_errors import USUAL, RigErrors
from model.slip.samples import SlipSamples
from model.tasks import Watcher

CHUNK = 20  # kept steps between checks for a request to stop
MOST_KEPT = 2000  # steps; of longer chains every second is kept, and of these again
FIRST_LOOK = 100  # moves before convergence is computed for the first time
DRAWS_PER_ENSEMBLE = 1000  # at most
IMPORTANCE_DRAWS = 5_000  # in a round
EFFECTIVE_DRAWS = 2_000.0  # that are wanted of the weighted ones before sampling
ALONE = 5_000.0  # where nothing is sampled: the tails need more than the middle


class FitStopped(FitError):
    """The fit was stopped on request of the watcher.

    Attributes:
        chains: The sampler's chains so far; None when sampling had not begun.
    """

    def __init__(self, chains: Chains | None) -> None:
        super().__init__("stopped on request")
        self.chains = chains


@dataclass(frozen=True)
class SamplerSettings:
    """Settings of the sampler.

    Attributes:
        ensembles: Number of independent ensembles of walkers.
        max_steps: Number of sampler moves after which a fit ends without convergence, at the next
            end of a chunk; `FIRST_LOOK` moves are made at least.
        block_length: Samples in a block; chosen by `choose_block_length` when None.
        threads: Number of ensembles sampled at once; below `SHORT_CALLS` blocks one at a time.
        seed: Seed of the random generators.
        sampled: Whether the posterior is sampled by emcee; else its draws are weighted ones of the
            Laplace approximation.
    """

    ensembles: int = 4
    max_steps: int = 30_000
    block_length: int | None = None
    threads: int = 2
    seed: int = 1
    sampled: bool = True


def calibrate(
    samples: SlipSamples,
    laws: Mapping[str, SlipLaw],
    *,
    load_cell: LoadCell,
    settings: SamplerSettings,
    source: str,
    watcher: Watcher,
    clock: Callable[[], float],
    rig_errors: RigErrors = USUAL,
    earlier: Chains | None = None,
    keep: Callable[[Chains], object] = lambda _: None,
    stated: StatedPriors = UNSTATED,
    scored: bool = False,
    first: Callable[[Preview], object] = lambda _: None,
    executor: Executor | None = None,
) -> tuple[Calibration, Chains | None]:
    """Choose a slip law for rig samples, sample its posterior and check the result.

    Weighted draws of the Laplace approximation come first, and sampling confirms them.

    Args:
        samples: The samples, at least one.
        laws: The laws to choose from, one or more, simplest first, by the name they are reported
            under.
        load_cell: Prior knowledge of the load cell.
        settings: Settings of the sampler.
        source: Source of the samples, stored in the result.
        watcher: Receives progress, and can stop the fit.
        clock: Function that returns the time, to measure how long sampling takes [s].
        rig_errors: Prior knowledge of the rig's geometry and rolling resistance.
        earlier: Chains of a stopped fit of the same samples and settings, to resume from.
        keep: Called with all chains so far after every `CHUNK` kept steps, to save a checkpoint.
        stated: Priors that replace default ones.
        scored: Whether to choose the law by `choose_law`, from predictions of left-out runs and
            loads by the whole posterior, instead of by `compare`.
        first: Called with the parameters by weighted draws, before sampling.
        executor: Where fits without left-out runs and loads are computed; None for here.

    Returns:
        The calibration, converged or not (see its verdict), and the chains it was computed from;
        None without sampling.

    Raises:
        InsufficientData: There are fewer samples than a law's parameters plus two, traction is
            constant, no load exceeds the load cell's zero stability, or with `scored` there is one
            run.
        DomainError: A force exceeds `MOST_FORCE` or is NaN, traction opposes the slip, or a stated
            prior cannot be used.
        FitError: A law has no valid curve or no mode, too few of the sampler's starting points lie
            inside the support, `earlier` has another density, or a numerical routine failed.
        FitStopped: The watcher requested a stop.
    """
    rng = np.random.default_rng(settings.seed)
    require_forces(samples, load_cell)
    samples, rig_errors, run_out = _true_radii(
        samples, next(iter(laws.values())), load_cell, rig_errors, settings, watcher
    )
    known = load_cell, rig_errors, stated
    prepare = partial(_prepare, samples, laws, known, settings, rng, watcher, executor)
    fits = prepare(validate=not scored)
    fit, comparison = (
        _by_scores(samples, fits, rng, watcher, executor) if scored else choose_by_runs(fits)
    )
    began = clock()
    posterior, judging = fit.posterior, rng.spawn(1)[0]  # the same draws where a fit was resumed
    with explain_numerical_errors(samples, posterior.law):
        watcher.step("weighting", None)
        wanted = EFFECTIVE_DRAWS if settings.sampled else ALONE
        weighted = draws_at_modes(
            fit.modes, posterior.log_density, effort=Effort(IMPORTANCE_DRAWS, wanted),
            rng=judging, threads=_threads(fit, settings),
        )  # fmt: skip
        first(preview(posterior, weighted, rng=judging))
        chains = None
        if settings.sampled:
            jumps = weighted.mixture
            chains, convergence = _sample(fit, earlier, settings, rng, watcher, keep, jumps)
            draws = thin_draws(posterior, chains, convergence, n=DRAWS_PER_ENSEMBLE)
        else:
            draws, convergence = weighted_posterior(
                posterior, weighted, parts=settings.ensembles, n=DRAWS_PER_ENSEMBLE, rng=judging
            )
        seconds = clock() - began
        watcher.step("judging", None)
        calibration = conclude(
            fit, comparison, draws, convergence, samples,
            weighted=weighted if settings.sampled else None, source=source, seconds=seconds,
        )  # fmt: skip
    return replace(calibration, run_out=run_out), chains


def _true_radii(
    samples: SlipSamples,
    law: SlipLaw,
    load_cell: LoadCell,
    rig_errors: RigErrors,
    settings: SamplerSettings,
    watcher: Watcher,
) -> tuple[SlipSamples, RigErrors, RunOut | None]:
    """Correct slip for the run-out of discs whose angles are recorded, if it is `RunOut.used`.

    Returns the samples, what of the rig's errors remains, and the run-out, None if nothing tells
    it. Raises `FitStopped` if a stop is requested.
    """
    if samples.angles is None:
        return samples, rig_errors, None
    watcher.step("run-out", None)
    if watcher.stop_requested():
        raise FitStopped(None)
    with explain_numerical_errors(samples, law):
        found = find_run_out(
            samples, law, load_cell=load_cell, rig_errors=rig_errors,
            rng=np.random.default_rng(settings.seed),  # others draw as without angles
        )  # fmt: skip
    if found is None or not found.used:
        return samples, rig_errors, found
    return without_run_out(samples, found), replace(rig_errors, slip_scatter=found.scatter), found


def _prepare(
    samples: SlipSamples,
    laws: Mapping[str, SlipLaw],
    known: tuple[LoadCell, RigErrors, StatedPriors],
    settings: SamplerSettings,
    rng: np.random.Generator,
    watcher: Watcher,
    executor: Executor | None,
    *,
    validate: bool,
) -> dict[str, PreparedFit]:
    """Prepare the fit of each law, by name, all on the blocks of the first.

    Raises `FitStopped` if a stop is requested before a law.
    """
    fits: dict[str, PreparedFit] = {}
    choice: BlockChoice | int | None = settings.block_length
    for name, law in laws.items():
        watcher.step(f"preparing: {name}", None)
        if watcher.stop_requested():
            raise FitStopped(None)
        fit = prepare_fit(
            samples, law, load_cell=known[0], rig_errors=known[1], stated=known[2], rng=rng,
            block_choice=choice, executor=executor, validate=validate,
            threads=settings.threads,
        )  # fmt: skip
        choice = fit.block_choice  # laws are compared on the same blocks
        fits[name] = fit
    return fits


def _by_scores(
    samples: SlipSamples,
    fits: Mapping[str, PreparedFit],
    rng: np.random.Generator,
    watcher: Watcher,
    executor: Executor | None,
) -> tuple[PreparedFit, LawScores]:
    """Return the fit that `choose_law` chooses, cross-validated, and the scores of all.

    Raises `FitStopped` if a stop is requested before a law or after a refit.
    """
    weighed = []
    for name, fit in fits.items():
        watcher.step(f"comparing: {name}", None)
        if watcher.stop_requested():
            raise FitStopped(None)
        with explain_numerical_errors(samples, fit.posterior.law):
            weighed.append(weigh_law(name, fit, rng=rng))

    def progress(share: float) -> None:
        """Report the share done; raise `FitStopped` if a stop is requested."""
        watcher.step("comparing laws without runs and loads", share)
        if watcher.stop_requested():
            raise FitStopped(None)

    progress(0.0)
    scores = score_laws(
        weighed, executor=executor, progress=progress,
        explaining=partial(explain_numerical_errors, samples),
    )  # fmt: skip
    found = choose_law(scores, load_groups(next(iter(fits.values())).posterior.blocks)[1])
    chosen = fits[found.laws[found.chosen].name]
    return validated(chosen, executor=executor), found


def _sample(
    fit: PreparedFit,
    earlier: Chains | None,
    settings: SamplerSettings,
    rng: np.random.Generator,
    watcher: Watcher,
    keep: Callable[[Chains], object],
    jumps: StudentMixture,
) -> tuple[Chains, Convergence]:
    """Sample, from `earlier` if given, until convergence or the largest number of steps.

    Progress goes to `watcher`, all chains to `keep` after every `CHUNK` kept steps. Raises
    `FitStopped`, with the chains so far, if a stop is requested, and `FitError` if the log density
    at the end of earlier chains is another one now.
    """
    density = fit.posterior.log_density
    if earlier is not None:
        _require_same_density(fit, earlier)
    chains = earlier or start_chains(density, jumps, ensembles=settings.ensembles, rng=rng)
    most = max(settings.max_steps, FIRST_LOOK)
    threads = _threads(fit, settings)
    look = next_look(chains.moves - CHUNK * chains.thin + 1)
    watcher.step("sampling", 0.0)
    while True:
        if chains.moves >= min(look, most):
            own = fit.posterior.own_coordinates(chains.z)
            convergence = assess(replace(chains, z=own))
            if convergence.converged or chains.moves >= most:
                return chains, convergence
            fraction = max(convergence.fraction_done(), chains.moves / most)
            watcher.step("sampling", fraction)
            look = next_look(chains.moves + 1)
        if watcher.stop_requested():
            raise FitStopped(chains)
        if chains.n_steps > MOST_KEPT:
            chains = chains.thinned()
        chains = advance(density, chains, steps=CHUNK, jumps=jumps, threads=threads)
        keep(chains)


def _require_same_density(fit: PreparedFit, earlier: Chains) -> None:
    """Raise `FitError` unless chains hold the density of this fit: it tells another version."""
    z, kept = earlier.z[0, -1], earlier.log_density[0, -1]
    d = len(fit.posterior.free)
    if z.shape[-1] != d or not np.allclose(fit.posterior.log_density(z), kept, atol=1e-3):
        raise FitError(
            "the stopped fit belongs to another posterior than these data give now: it was stopped "
            "by another version of zebro-lab, or on another machine; run without --resume"
        )


def _threads(fit: PreparedFit, settings: SamplerSettings) -> int:
    """Return the number of threads for a posterior's density."""
    return 1 if len(fit.posterior.blocks) < SHORT_CALLS else settings.threads


def next_look(moves: int) -> int:
    """Return the first number of moves, from `moves` on, at which convergence is computed.

    These are `FIRST_LOOK` and, from each to the next, a fifth more, rounded down. They are fixed,
    so that a fit that is stopped and resumed ends at the same move as a fit that is not.

    Args:
        moves: Number of sampler moves; the result is this number or larger.

    >>> [next_look(n) for n in (1, 101, 121)]
    [100, 120, 144]
    """
    look = FIRST_LOOK
    while look < moves:
        look = int(look * 1.2)
    return look
