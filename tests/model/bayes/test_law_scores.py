# SPDX-License-Identifier: MIT
"""The simplest law that nothing speaks against is chosen, of laws and of made-up scores."""

from types import SimpleNamespace

import numpy as np
import pytest

from model.bayes.averaging.blocks import block_means
from model.bayes.fit import prepare_fit, scaled_load_cell
from model.bayes.law_scores import LawScore, choose_law, load_groups, score_laws, weigh_law
from model.bayes.left_out import LeftOut
from model.bayes.posterior import LoadCell, SlipPosterior, default_priors
from model.errors import InsufficientData
from model.slip import Brush, CoulombStribeck, MagicFormula
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.simulated_sweep import simulate_sweep

LOADS = np.array([4.0, 8.0, 12.0])
SIMPLE, MIDDLE, RICH = Brush(), MagicFormula(0.0), CoulombStribeck()


def left_out(log_density, group) -> LeftOut:
    n = int(group.max()) + 1
    return LeftOut(group, log_density, np.full(n, 0.2), np.zeros(n, dtype=bool))


def score(law, runs, loads=None) -> LawScore:
    """Return a score of 12 runs at three loads, with densities of each run or of all together."""
    runs = np.broadcast_to(np.asarray(runs, dtype=float), 12)
    of_loads = None if loads is None else np.broadcast_to(np.asarray(loads, dtype=float), 12)
    return LawScore(
        f"{law.name} {len(law.parameters)}",
        law,
        left_out(runs, np.arange(12)),
        None if of_loads is None else left_out(of_loads, np.arange(12) // 4),
        np.zeros((1, len(law.parameters))),
    )


def chosen(*scores):
    found = choose_law(scores, LOADS)
    return found.laws[found.chosen].law


def test_a_clear_difference_decides_for_the_richer_law():
    assert chosen(score(RICH, 0.0), score(SIMPLE, -1.0)) == RICH


def test_of_laws_that_are_not_told_apart_the_simplest_is_chosen():
    noise = np.array([-1.5, 1.5] * 6)
    assert chosen(score(RICH, 0.5 + noise), score(SIMPLE, 0.0)) == SIMPLE
    assert chosen(score(RICH, 0.1), score(SIMPLE, 0.0)) == SIMPLE  # small, though always the same


def test_left_out_loads_decide_where_left_out_runs_do_not():
    assert chosen(score(RICH, 0.0, 0.0), score(SIMPLE, 0.0, -1.0)) == RICH


def test_a_law_that_predicts_runs_clearly_worse_is_not_saved_by_its_loads():
    assert chosen(score(RICH, 0.0, -1.0), score(SIMPLE, -1.0, 0.0)) == RICH


def test_of_as_many_parameters_the_law_named_first_is_chosen():
    four = MagicFormula("constant")
    assert chosen(score(four, 0.0), score(RICH, 0.1)) == four
    assert chosen(score(RICH, 0.0), score(four, 0.1)) == RICH


def test_the_error_over_loads_counts_where_it_is_the_larger():
    by_load = np.repeat([-4.0, 0.0, 4.0], 4)
    found = choose_law([score(SIMPLE, 0.0, by_load), score(RICH, 0.0, 0.0)], LOADS)
    assert found.loads(0, 1).error == pytest.approx(np.sqrt(3) * 16)


def simulated(law, truth, seed=3):
    slips = (-0.3, -0.08, -0.03, -0.01, 0.006, 0.012, 0.02, 0.035, 0.06, 0.12, 0.25, 0.5)
    plan = SweepPlan(slips=slips, loads=(4.0, 8.0, 12.0), rate=60.0)
    rng = np.random.default_rng(seed)
    return simulate_sweep(law, truth, plan=plan, imperfections=TYPICAL_RIG, rng=rng).samples


def compared(samples, laws):
    rng, choice, weighed = np.random.default_rng(1), None, []
    for law in laws:
        fit = prepare_fit(
            samples, law, load_cell=scaled_load_cell(samples, {}), rng=rng, block_choice=choice,
            validate=False,
        )  # fmt: skip
        choice = fit.block_choice
        weighed.append(weigh_law(str(law), fit, rng=rng))
    return choose_law(score_laws(weighed), load_groups(fit.posterior.blocks)[1])


SENSITIVE = MagicFormula("constant", True, 8.0)
PLANTED = {
    "magic formula": (MagicFormula("constant"), (20.0, 1.5, 0.4, 0.0)),
    "load-sensitive": (SENSITIVE, (20.0, 1.5, 0.4, 0.0, -0.15, -0.1)),
    "brush": (Brush(), (20.0, 0.4)),
    "coulomb-stribeck": (CoulombStribeck(), (20.0, 0.4, 0.7, 0.1)),
}


@pytest.mark.long
@pytest.mark.parametrize("name", PLANTED)
def test_the_law_that_made_the_data_is_chosen_or_not_told_from_the_chosen(name):
    law, truth = PLANTED[name]
    found = compared(simulated(law, truth), [planted for planted, _ in PLANTED.values()])
    assert law in [found.laws[i].law for i in found.told_together]
    assert len(found.laws[found.chosen].law.parameters) <= len(law.parameters)
    assert found.loads(0, found.chosen) is not None


def test_one_run_cannot_be_left_out():
    plan = SweepPlan(slips=(0.02,), loads=(8.0,), rate=60.0)
    samples = simulate_sweep(
        Brush(), (20.0, 0.4), plan=plan, imperfections=TYPICAL_RIG, rng=np.random.default_rng(1)
    ).samples
    blocks = block_means(samples, 10)
    posterior = SlipPosterior(blocks, Brush(), default_priors(Brush(), blocks, LoadCell()))
    fit = SimpleNamespace(posterior=posterior, approximation=None)
    with pytest.raises(InsufficientData, match="these data are one run"):
        weigh_law("brush", fit, rng=np.random.default_rng(1))
