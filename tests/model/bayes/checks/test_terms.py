# SPDX-License-Identifier: MIT
"""Each term is found where it was planted, with its size and cause, and nowhere else."""

from dataclasses import replace

import numpy as np
import pytest

from model.bayes.advice import TryDefinition, ZeroBeforeEach
from model.bayes.checks.causes import Cause, likely, named
from model.bayes.checks.points import group_residuals
from model.bayes.checks.terms import find, suspects
from support.linearised_fits import linearised, only, scaled, swept, unchanged, with_force


def findings(change=unchanged, columns=None, *, timed=True, **more):
    """Look for all terms in changed samples, with columns of one value a run, by name."""
    _, fit, _ = linearised(change, **more)
    columns = {name: values[fit.blocks.run] for name, values in (columns or {}).items()}
    return find(fit, suspects(fit, columns, timed=timed))[0]


def elapsed(samples):
    return samples.run / (samples.n_runs - 1)


def shifted(error):
    return lambda s: replace(s, slip=s.slip - error * (1 - s.slip))


def alternating(samples):
    """Put the runs in an order in which loads alternate."""
    return only(samples, np.arange(48).reshape(2, 24).T.ravel())


def late_load(samples):
    """Let a tenth of the logarithm of a run's load be that of the next."""
    samples = alternating(samples)
    load = np.bincount(samples.run, samples.normal_force) / np.bincount(samples.run)
    change = (np.append(load[1:], load[-1]) / load) ** 0.1
    return replace(samples, traction_force=samples.traction_force * change[samples.run])


def within_runs(samples):
    n = len(samples) // samples.n_runs
    return 0.3 * (np.arange(len(samples)) % n) / n


PLANTED = {
    "a constant traction of -0.2": (
        Cause.FORCE_ZERO, with_force(lambda s: np.full(len(s), -0.2)),
    ),
    "a traction of -0.0297": (Cause.FORCE_ZERO, with_force(lambda s: -0.03 * s.normal_force)),
    "true slip is larger by +0.003": (Cause.SLIP_ZERO, shifted(0.003)),
    "slip bends the curve -1.": (Cause.DEFINITION, lambda s: replace(s, slip=s.slip + s.slip**2)),
    "driving forces are +8": (Cause.ONE_DIRECTION, scaled(lambda s: 1 - 0.08 * (s.slip < 0))),
    "the normal force holds +15": (
        Cause.CROSSTALK,
        lambda s: replace(s, normal_force=s.normal_force + 0.15 * s.traction_force),
    ),
    "forces grow with load to the power of 0.90": (
        Cause.LOAD, scaled(lambda s: (s.normal_force / 7) ** -0.1),
    ),
    "10% ± 1% of a run's load belong to the run before": (Cause.LOAD, late_load),
    "the zero of traction drifts by +0.": (
        Cause.FORCE_ZERO,
        lambda s: with_force(lambda t: 0.6 * (elapsed(t) - 0.5))(alternating(s)),
    ),
    "forces drift by +0.29": (Cause.FORCE_ZERO, with_force(within_runs)),
    "forces change by -7.8% ± 1.6% from the first": (
        Cause.OVER_TIME, scaled(lambda s: 1.05 - 0.1 * elapsed(s)),
    ),
    "forces change by -10.4% ± 1.2% at once, after 21 of 48": (
        Cause.FORCE_SCALE, scaled(lambda s: np.where(s.run > 20, 0.9, 1.0)),
    ),
    "traction is late by +0.24": (Cause.TIMING, swept(late=3)),
    "rising and falling slip are +0.009": (Cause.HYSTERESIS, swept(apart=0.01)),
}  # fmt: skip


@pytest.mark.parametrize("text", PLANTED)
def test_a_planted_term_explains_most_with_its_size_and_its_cause(text):
    cause, change = PLANTED[text]
    best = likely(findings(change))[0]
    assert best.text.startswith(text)
    assert named([best])[0] == cause
    assert best.advice.reason == best.text
    advice = {Cause.DEFINITION: TryDefinition}
    if "drift" in text:
        advice = {Cause.FORCE_ZERO: ZeroBeforeEach}
    assert isinstance(best.advice, advice.get(cause, object))


@pytest.mark.parametrize("change", [unchanged, swept()], ids=["held", "swept"])
def test_nothing_is_found_where_nothing_was_planted(change):
    found = findings(change)
    assert len(found) >= 11
    assert min(each.p for each in found) > 0.05


def test_an_unused_column_that_forces_follow_is_named_and_another_is_not():
    surface, day = np.where(np.arange(48) % 3, 1.0, -1.0), np.arange(48.0) % 5
    change = scaled(lambda s: 1 + 0.05 * surface[s.run])
    (best,) = likely(findings(change, {"surface": surface, "day": day}))
    assert best.causes == (Cause.COLUMN,)
    assert "unused column 'surface'" in best.text
    assert "one value of 'surface' at a time" in best.advice.step
    assert likely(findings(columns={"surface": surface, "day": day})) == ()


def test_a_column_of_a_table_tells_the_order_of_its_rows():
    order = np.random.default_rng(1).permutation(48)
    change = scaled(lambda s: 1.06 - 0.12 * order[s.run] / 47)
    best = likely(findings(change, {"Test no": order.astype(float)}, timed=False))[0]
    assert best.causes == (Cause.OVER_TIME,)
    assert likely(findings(change, timed=False)) == ()


@pytest.mark.parametrize("runs", [1, 5])
def test_a_few_runs_do_not_show_what_changes_from_run_to_run(runs):
    found = findings(lambda s: only(s, np.arange(runs)), {"a": np.arange(float(runs))})
    assert found
    assert not {Cause.COLUMN, Cause.OVER_TIME} & {each.causes[0] for each in found}


@pytest.mark.parametrize(("error", "beyond"), [(0.01, False), (0.05, True)])
def test_an_error_that_the_fit_estimates_counts_beyond_its_prior_and_moves_no_curve(error, beyond):
    estimated = {"radius_error": -error, "rolling_resistance": 0.0}  # with an sd of 0.01 a priori
    found = findings(shifted(error), fixed={}, found=estimated)
    (zero,) = [each for each in found if each.causes[0] is Cause.SLIP_ZERO]
    assert (zero.p < 1e-3) == beyond
    assert not zero.effect.large


def test_a_misfit_that_a_drift_explains_is_not_left_to_the_law():
    _, fit, _ = linearised(with_force(lambda s: 0.8 * elapsed(s)))
    _, without = find(fit, suspects(fit, {}, timed=True))
    assert group_residuals(fit).p < 1e-3
    assert group_residuals(without).p > 0.01
