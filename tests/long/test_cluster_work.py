# SPDX-License-Identifier: MIT
"""Fits without left-out runs, walks and bands are the same on a cluster that loses a worker.

Commands have no time limit but that of the test: on a busy machine, which compiles the loops of
walks first, one took longer than four minutes.
"""

import os
import signal

import numpy as np
import pytest

from model.bayes import left_out
from model.bayes.fit import prepare_fit
from model.bayes.law_scores import score_laws, weigh_law
from model.bayes.posterior import LoadCell
from model.slip import Brush, CoulombStribeck
from rig.slip_rig.imperfections import TYPICAL_RIG
from rig.slip_rig.sweep import SweepPlan
from support.commands import started
from support.simulated_sweep import simulate_sweep
from support.tracked_walks import write_walk
from support.walk_posteriors import write_calibration
from zebro_lab.workers import WorkersRequest, open_executor

distributed = pytest.importorskip("distributed")
pytestmark = [
    pytest.mark.long,
    pytest.mark.timeout(3600),
    pytest.mark.filterwarnings("ignore"),
]

PLAN = SweepPlan(slips=(-0.05, 0.01, 0.03, 0.3), loads=(4.0, 8.0), rate=40.0)
UNEVEN = "slope_deg = [3.0, 0.0]\n"


@pytest.fixture
def local():
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as found:
        yield found


def scored(executor):
    """Compare two laws by fits without each run and each load."""
    rng = np.random.default_rng(4)
    samples = simulate_sweep(
        Brush(), (20.0, 0.4), plan=PLAN, imperfections=TYPICAL_RIG, rng=rng
    ).samples
    weighed = []
    for law in (Brush(), CoulombStribeck()):
        fit = prepare_fit(
            samples, law, load_cell=LoadCell(), rng=rng, block_choice=10, validate=False
        )
        weighed.append(weigh_law(law.name, fit, rng=rng))
    return score_laws(weighed, executor=executor)


class KilledAtWork(distributed.SchedulerPlugin):
    """Kills the worker that is given the first task, as soon as it is given.

    A watcher that asks the scheduler again and again who is at work misses short tasks on a busy
    machine.

    Attributes:
        address: Address of the killed worker; None before.
    """

    def __init__(self, local):
        self.local, self.address = local, None

    def transition(self, key, start, finish, *_, **__):
        if finish == "processing" and self.address is None:
            self.address = self.local.scheduler.tasks[key].processing_on.address
            nannies = {nanny.worker_address: nanny for nanny in self.local.workers.values()}
            os.kill(nannies[self.address].pid, signal.SIGKILL)


@pytest.fixture
def killed(local):
    """Return what kills a worker of the cluster at its first task."""
    plugin = KilledAtWork(local)
    local.scheduler.add_plugin(plugin)
    return plugin


def test_laws_are_compared_by_the_same_refits(local, killed, monkeypatch):
    monkeypatch.setattr(left_out, "MAX_PARETO_K", -10.0)  # so that all are refits
    expected = scored(None)
    with open_executor(WorkersRequest(scheduler=local.scheduler_address)) as executor:
        found = scored(executor)
    assert killed.address
    for mine, other in zip(found, expected, strict=True):
        assert mine.runs.refitted.all()
        for name in ("runs", "loads"):
            a, b = getattr(mine, name), getattr(other, name)
            np.testing.assert_array_equal(a.log_density, b.log_density)
            np.testing.assert_array_equal(a.pareto_k, b.pareto_k)


@pytest.mark.parametrize("ground", ["", UNEVEN], ids=["level", "uneven"])
def test_a_band_is_the_same_by_commands(local, killed, ground, tmp_path):
    write_walk(tmp_path / "run")
    options = ["predict", "run/legs.csv", "--slip", "coulomb:0.38"]
    options += ["--draws", 10 if ground else 60]
    if ground:
        (tmp_path / "ground.toml").write_text(ground)
        options += ["--ground", "ground.toml"]

    def predict(out, *more):
        with started(*options, "--out", out, *more, cwd=tmp_path) as process:
            _, err = process.communicate()
        assert process.returncode == 0, err
        with np.load(tmp_path / out / "draws.npz") as stored:
            return stored["poses"], (tmp_path / out / "band.csv").read_text()

    expected = predict("here")
    found = predict("there", "--scheduler", local.scheduler_address)
    assert killed.address
    np.testing.assert_array_equal(found[0], expected[0])
    assert found[1] == expected[1]


def test_walks_are_fitted_the_same_by_commands(local, killed, tmp_path):
    write_walk(tmp_path / "walk")
    for name in ("here", "there"):
        (tmp_path / name).mkdir()
    folders = [write_calibration(tmp_path / name) for name in ("here", "there")]

    def fit(calibration, *more):
        words = ("calibrate", "--walks", "walk", "--out", calibration, *more)
        with started(*words, cwd=tmp_path) as process:
            _, err = process.communicate()
        assert process.returncode == 0, err
        with np.load(calibration / "walks" / "draws.npz") as stored:
            return (calibration / "walks" / "walks.toml").read_text(), dict(stored)

    expected = fit(folders[0])
    found = fit(folders[1], "--scheduler", local.scheduler_address)
    assert killed.address
    assert found[0] == expected[0]
    for name, values in expected[1].items():
        np.testing.assert_array_equal(found[1][name], values)
