# SPDX-License-Identifier: MIT
from dataclasses import replace

import numpy as np
import pytest

from model.bayes.averaging.blocks import block_means
from model.bayes.cross_validation import CrossValidation
from model.bayes.drawing.laplace import LaplaceMixture, find_mode
from model.bayes.fit import CLEAR_WIN, prepare_fit, require_forces, scaled_load_cell
from model.bayes.law_scores import compare
from model.bayes.posterior import LoadCell, SlipPosterior
from model.bayes.preliminary import BlockChoice
from model.errors import DomainError, InsufficientData
from model.slip import Brush, MagicFormula, SidedLaw
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES
from rig.slip_rig.imperfections import TYPICAL_RIG, RigImperfections
from rig.slip_rig.sweep import SweepPlan
from support.quick_fits import few_starts
from support.simulated_sweep import simulate_sweep

STIFFNESS = THESIS_VALUES[0]
SMALL = SweepPlan(slips=(0.01, 0.03, 0.06, 0.12, 0.3, 0.7), loads=(2.13, 12.75), duration=0.4)
TEN = BlockChoice(10, None, "the length of this test")


def simulated(imperfections=TYPICAL_RIG, *, plan=SMALL, seed=0):
    rng = np.random.default_rng(seed)
    return simulate_sweep(
        THESIS_LAW, THESIS_VALUES, plan=plan, imperfections=imperfections, rng=rng
    ).samples


def rows_of(samples, chosen):
    """Samples of some rows, in runs that are numbered anew."""
    rows = chosen(samples.run)
    names, run = np.unique(samples.run[rows], return_inverse=True)
    columns = ("slip", "normal_force", "traction_force", "time")
    return replace(
        samples,
        **{name: getattr(samples, name)[rows] for name in columns},
        run=run,
        run_names=tuple(samples.run_names[i] for i in names),
    )


@few_starts()
def prepared(samples, law=THESIS_LAW, *, choice=None, validate=False, load_cell=None):
    return prepare_fit(
        samples,
        law,
        load_cell=load_cell or LoadCell(),
        rng=np.random.default_rng(0),
        block_choice=choice,
        validate=validate,
    )


def mode_values(posterior, laplace):
    values = posterior.values(laplace.mode[None])[0]
    return {p.name: value for p, value in zip(posterior.parameters, values, strict=True)}


# --- errors in variables: noise in measured slip, and wander of the true one

RIG = RigImperfections(noise_sd0=0.03, noise_sd1=0.01, offset_sd=0.03)
NOISY_SENSORS = replace(RIG, speed_noise=0.01 * 12 / 3.5)  # 0.01 in each sample's slip ratio
WANDERING = replace(RIG, slip_wander_sd=0.01, slip_wander_time=0.15)
NEAR_ZERO = SweepPlan(
    slips=tuple(np.linspace(0.0, 0.3, 25)), loads=(2.13, 6.63, 12.75), duration=0.6, rate=100.0
)


def naive_fit(samples, length, fit, **fixed):
    """Fit as if block means of measured slip were exact and the law needed no averaging."""
    blocks = block_means(samples, length)
    starts = np.append(0, np.cumsum(blocks.count)[:-1])
    nothing = np.zeros(len(blocks))
    naive = replace(
        blocks,
        slip=np.add.reduceat(samples.slip, starts) / blocks.count,
        slip_wander=nothing,
        slip_error=nothing,
        load_variance=nothing,
        load_skewness=nothing,
        slip_load_covariance=nothing,
        run_slip_error=np.zeros(blocks.n_runs),
    )
    exact = {"radius_error": 0.0, "rolling_resistance": 0.0}
    posterior = SlipPosterior(naive, THESIS_LAW, fit.posterior.priors, {**exact, **fixed})
    start = posterior.coordinates(mode_values(fit.posterior, fit.laplace))
    return mode_values(posterior, find_mode(posterior.log_density, start[None]))


def slope_error(fit):
    """Return the fitted slope's relative error and the same in posterior standard deviations."""
    draws = np.random.default_rng(0).multivariate_normal(
        fit.laplace.mode, fit.laplace.covariance, size=400
    )
    sd = fit.posterior.values(draws)[:, 0].std()
    error = mode_values(fit.posterior, fit.laplace)["slip_stiffness"] - STIFFNESS
    return error / STIFFNESS, error / sd


@pytest.fixture(scope="module")
def noisy():
    samples = simulated(NOISY_SENSORS, plan=NEAR_ZERO)
    return samples, prepared(samples)


@pytest.fixture(scope="module")
def wandering():
    samples = simulated(WANDERING, plan=NEAR_ZERO)
    return samples, prepared(samples, choice=TEN)


def test_noise_in_measured_slip_does_not_bias_the_slope(noisy):
    relative, deviations = slope_error(noisy[1])
    assert abs(relative) < 0.04 or abs(deviations) < 3


def test_wander_of_the_true_slip_does_not_bias_the_slope(wandering):
    relative, deviations = slope_error(wandering[1])
    assert abs(relative) < 0.04
    assert abs(deviations) < 3


def test_taking_noisy_slip_at_its_word_flattens_the_curve(noisy):
    samples, fit = noisy
    # Its offsets are held to the truth here, or they would take over (next claim), and nor is
    # there slip that the speeds do not show.
    naive = naive_fit(samples, 1, fit, offset_spread=RIG.offset_sd, slip_scatter=0.0)
    assert naive["slip_stiffness"] < 0.9 * STIFFNESS


def test_free_offsets_swallow_a_curve_through_noisy_slip(noisy):
    samples, fit = noisy
    naive = naive_fit(samples, 1, fit)
    assert naive["offset_spread"] > 20 * RIG.offset_sd
    assert naive["slip_stiffness"] < 0.2 * STIFFNESS
    kept = mode_values(fit.posterior, fit.laplace)
    assert kept["offset_spread"] < 2 * RIG.offset_sd


def test_averaging_wandering_slip_over_a_run_blunts_the_curve(wandering):
    samples, fit = wandering
    alone = {"noise_correlation": 0.0, "offset_spread": 0.0}  # a block a run tells neither
    naive = naive_fit(samples, NEAR_ZERO.n_samples, fit, **alone)
    assert naive["slip_stiffness"] < 0.9 * STIFFNESS


# --- preparing a fit


@pytest.fixture(scope="module")
def fit():
    return prepared(simulated(), choice=TEN)


def test_the_block_length_is_chosen_unless_it_is_given(fit):
    samples = simulated()
    assert fit.block_choice is TEN
    assert len(fit.posterior.blocks) == len(block_means(samples, 10))
    chosen = prepared(samples)
    assert chosen.block_choice.correlation >= 1
    blocks = block_means(samples, chosen.block_choice.length)
    assert len(chosen.posterior.blocks) == len(blocks)


def test_the_mode_is_higher_than_the_truth(fit):
    truth = dict(zip((p.name for p in THESIS_LAW.parameters), THESIS_VALUES, strict=True))
    truth |= {"noise_floor": 0.03, "noise_slope": 0.02, "offset_spread": 0.05}
    at_truth = fit.posterior.log_density(fit.posterior.coordinates(truth)[None])[0]
    assert np.isfinite(at_truth)
    assert fit.laplace.log_density > at_truth


def test_the_same_seed_prepares_the_same_fit(fit):
    same = prepared(simulated(), choice=TEN)
    np.testing.assert_array_equal(fit.laplace.mode, same.laplace.mode)


def test_runs_of_one_block_fix_what_they_cannot_tell_apart():
    cell = LoadCell(zero_stability=0.03)
    choice = replace(TEN, length=SMALL.n_samples)
    fit = prepared(simulated(), choice=choice, load_cell=cell)
    assert fit.load_cell == cell
    assert fit.posterior.priors["offset_spread"].scale == 0.03
    assert len(fit.posterior.blocks) == fit.posterior.blocks.n_runs
    assert fit.posterior.fixed == {"noise_correlation": 0.0, "offset_spread": 0.0}
    assert len(fit.laplace.mode) == len(fit.posterior.parameters) - 2


def test_a_single_run_is_fitted_but_not_cross_validated():
    one = rows_of(simulated(), lambda run: run == 3)
    fit = prepared(one, MagicFormula(curvature=0.0), choice=TEN, validate=True)
    assert fit.cross_validation is None
    assert np.isfinite(fit.laplace.log_density)


def test_fewer_samples_than_unknowns_are_refused_with_both_numbers():
    few = rows_of(simulated(), lambda run: (run < 3) & (np.arange(len(run)) % 100 == 0))
    with pytest.raises(InsufficientData, match=r"3 samples .* 4 parameters .* at least 6"):
        prepared(few)


# --- the load cell's defaults


def test_a_small_rigs_load_cell_has_the_defaults_of_a_small_cell():
    assert scaled_load_cell(simulated(), {"gain_sd": 0.005}) == LoadCell()


def test_the_gain_of_a_cell_that_nobody_weighed_is_known_to_a_hundredth():
    assert scaled_load_cell(simulated(), {}).gain_sd == 0.01


def test_a_larger_cell_drifts_in_proportion_to_its_forces():
    samples = simulated()
    large = replace(
        samples,
        normal_force=1000 * samples.normal_force,
        traction_force=1000 * samples.traction_force,
    )
    cell = scaled_load_cell(large, {})
    assert cell.zero_stability == pytest.approx(5 * np.abs(samples.traction_force).max())
    assert cell.bias_sd == pytest.approx(2 * samples.normal_force.max())


def test_what_is_known_goes_before_every_default():
    known = {"zero_stability": 0.02, "gain_sd": 0.001}
    cell = scaled_load_cell(simulated(), known)
    assert (cell.zero_stability, cell.gain_sd) == (0.02, 0.001)


# --- forces from which no curve follows


def of_largest(*, normal: float = 1.0, traction: float = 1.0):
    samples = simulated()
    return replace(
        samples,
        normal_force=normal * samples.normal_force / samples.normal_force.max(),
        traction_force=traction * samples.traction_force / np.abs(samples.traction_force).max(),
    )


def test_a_force_just_beyond_the_bound_is_told_from_it():
    require_forces(of_largest(traction=1e9, normal=1e9), LoadCell())
    with pytest.raises(DomainError, match=r"reaches 1000000000\.5 N in absolute .* up to 1e\+09 N"):
        require_forces(of_largest(traction=1e9 + 0.5, normal=1.0), LoadCell())


@pytest.mark.parametrize(
    ("normal", "traction", "zero_stability", "advice"),
    [
        (0.013, 0.005, 0.15, "are the forces in kN"),
        (13.0, 5e5, 2500.0, r"traction force reaches 5e\+05 N, implausible under such a load"),
        (13.0, 5.0, 50.0, "correct the cell's zero stability"),
    ],
)
def test_loads_below_the_zero_are_told_by_what_is_implausible(
    normal, traction, zero_stability, advice
):
    with pytest.raises(InsufficientData, match=advice) as caught:
        require_forces(
            of_largest(normal=normal, traction=traction), LoadCell(zero_stability=zero_stability)
        )
    assert ("kN" in str(caught.value)) == (normal < 1)


# --- comparing laws


@pytest.mark.long
def test_a_peak_that_moves_with_load_is_preferred_where_it_does():
    slips = (0.005, 0.01, 0.015, 0.02, 0.03, 0.04, 0.05, 0.06, 0.08, 0.1, 0.12, 0.2, 0.4, 0.7)
    samples = simulated(plan=replace(SMALL, slips=slips, duration=0.6))
    laws = (MagicFormula(curvature=0.0), THESIS_LAW)
    fits = [prepared(samples, law, choice=TEN, validate=True) for law in laws]
    found = compare(["no curvature", "moving peak"], fits)
    assert found.chosen == 1
    assert found.difference[1] == 0
    assert found.difference[0] < -CLEAR_WIN * found.standard_error[0]


def with_densities(fit, *rows):
    """Return copies of a fit with these log densities of its left-out runs."""
    n_runs = fit.posterior.blocks.n_runs
    fold = np.arange(n_runs)
    return [
        replace(fit, cross_validation=CrossValidation(fold, np.zeros((n_runs, 12)), row))
        for row in rows
    ]


def test_a_tie_keeps_the_first(fit):
    density = np.random.default_rng(0).standard_normal(16)
    found = compare("ab", with_densities(fit, density, density.copy()))
    assert found.chosen == 0
    assert found.difference == (0.0, 0.0)
    assert found.standard_error == (0.0, 0.0)


def test_a_lead_within_the_scatter_of_the_runs_is_no_win(fit):
    density, gain = np.random.default_rng(1).standard_normal((2, 16))
    unsure = gain - gain.mean() + 0.9 * CLEAR_WIN * gain.std() / np.sqrt(16)
    sure = gain - gain.mean() + 1.1 * CLEAR_WIN * gain.std() / np.sqrt(16)
    fits = with_densities(fit, density, density + unsure, density + sure)
    assert compare("ab", fits[:2]).chosen == 0
    assert compare("ac", fits[::2]).chosen == 1


@pytest.mark.parametrize(
    ("n_runs", "evidence", "chosen"), [(5, 11.0, 1), (5, 9.0, 0), (12, 11.0, 0)]
)
def test_of_few_runs_a_lead_counts_with_the_evidence_of_all(fit, n_runs, evidence, chosen):
    few = replace(fit, posterior=fit.posterior.without_runs(np.arange(12) >= n_runs))
    gain = np.resize([-2.0, 3.0], n_runs) + 0.1  # far within its scatter
    plain, richer = with_densities(few, np.zeros(n_runs), gain)
    mode = replace(fit.laplace, log_density=fit.laplace.log_density + evidence)
    richer = replace(richer, approximation=LaplaceMixture((mode,)))
    assert compare("ab", [plain, richer]).chosen == chosen
    worse = with_densities(few, np.zeros(n_runs), -gain)[1]
    worse = replace(worse, approximation=LaplaceMixture((mode,)))
    assert compare("ab", [plain, worse]).chosen == 0


def test_one_lucky_run_is_no_win(fit):
    density = np.zeros(16)
    lucky = density.copy()
    lucky[3] = 100.0
    assert compare("ab", with_densities(fit, density, lucky)).chosen == 0


def test_the_comparison_adds_up_over_runs(fit):
    rows = np.random.default_rng(2).standard_normal((3, 16)) + np.array([[0.0], [5.0], [-5.0]])
    found = compare("abc", with_densities(fit, *rows))
    assert found.chosen == 1
    np.testing.assert_allclose(found.log_density, rows.sum(axis=1))
    np.testing.assert_allclose(found.difference, (rows - rows[1]).sum(axis=1))
    expected = 4 * np.std(rows - rows[1], axis=1)
    np.testing.assert_allclose(found.standard_error, expected, atol=1e-12)


def test_where_no_run_can_be_left_out_the_first_law_is_kept(fit):
    unvalidated = [replace(fit, cross_validation=None) for _ in range(2)]
    assert compare("ab", unvalidated).chosen == 0


@pytest.mark.parametrize("traction", [0.0, 1.5])
def test_traction_that_stands_still_is_refused(traction):
    samples = simulated()
    still = replace(samples, traction_force=np.full(len(samples), traction))
    with pytest.raises(InsufficientData, match=f"traction force is {traction:g} N in all"):
        prepared(still)


def test_a_wrong_sign_is_said_before_a_fit_is_wasted():
    samples = simulated()
    turned = replace(samples, traction_force=-samples.traction_force)
    with pytest.raises(DomainError, match=r"opposes the slip in \d+ of \d+ runs that slip.*sign"):
        require_forces(turned, LoadCell())
    require_forces(samples, LoadCell())


@pytest.mark.long
@pytest.mark.parametrize(("apart", "chosen"), [((0.6, 0.3), 1), ((0.0, 0.0), 0)])
def test_sides_are_apart_where_left_out_runs_say_so(apart, chosen):
    law = SidedLaw(Brush())
    slips = np.tile(
        [-0.3, -0.1, -0.05, -0.035, -0.02, -0.008, 0.008, 0.02, 0.035, 0.05, 0.1, 0.3], 2
    )
    plan = SweepPlan(slips=tuple(slips), loads=(4.0, 12.0), rate=60.0)
    samples = simulate_sweep(
        law, (20.0, 0.4, *apart), plan=plan, imperfections=TYPICAL_RIG,
        rng=np.random.default_rng(1),
    ).samples  # fmt: skip
    fits, choice = [], None
    for each in (law.law, law):
        fits.append(
            prepare_fit(
                samples,
                each,
                load_cell=scaled_load_cell(samples, {}),
                block_choice=choice,
                rng=np.random.default_rng(1),
            )
        )
        choice = fits[-1].block_choice
    assert compare(["together", "apart"], fits).chosen == chosen
    laplace = fits[1].laplace
    d_K, d_mu = fits[1].posterior.values(laplace.mode[None])[0, 2:4]
    sd = np.sqrt(np.diag(laplace.covariance))[2:4] * [0.2, 0.1]
    assert abs(d_K - apart[0]) < 3 * sd[0]
    assert abs(d_mu - apart[1]) < 3 * sd[1]
