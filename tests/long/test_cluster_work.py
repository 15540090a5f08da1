# SPDX-License-Identifier: MIT
"""Fits without left-out runs, walks and bands are the same on a cluster that loses a worker."""

import os
import signal
import threading
import time

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

pytest.importorskip("distributed")
pytestmark = [pytest.mark.long, pytest.mark.filterwarnings("ignore")]

PLAN = SweepPlan(slips=(-0.05, 0.01, 0.03, 0.3), loads=(4.0, 8.0), rate=40.0)
UNEVEN = "slope_deg = [3.0, 0.0]\n"


@pytest.fixture
def local():
    from distributed import LocalCluster

    with LocalCluster(
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


def kill_one_at_work(local, killed):
    """Kill a worker that has tasks of another client, as soon as there is one."""
    from distributed import Client

    with Client(local.scheduler_address, set_as_default=False) as client:
        pids, end = client.run(os.getpid), time.monotonic() + 120
        while time.monotonic() < end:
            busy = [address for address, tasks in client.processing().items() if tasks]
            if busy:
                os.kill(pids[busy[0]], signal.SIGKILL)
                killed.append(busy[0])
                return
            time.sleep(0.005)


def test_laws_are_compared_by_the_same_refits(local, monkeypatch):
    monkeypatch.setattr(left_out, "MAX_PARETO_K", -10.0)  # so that all are refits
    expected, killed = scored(None), []
    watch = threading.Thread(target=kill_one_at_work, args=(local, killed))
    watch.start()
    with open_executor(WorkersRequest(scheduler=local.scheduler_address)) as executor:
        found = scored(executor)
    watch.join()
    assert killed
    for mine, other in zip(found, expected, strict=True):
        assert mine.runs.refitted.all()
        for name in ("runs", "loads"):
            a, b = getattr(mine, name), getattr(other, name)
            np.testing.assert_array_equal(a.log_density, b.log_density)
            np.testing.assert_array_equal(a.pareto_k, b.pareto_k)


@pytest.mark.parametrize("ground", ["", UNEVEN], ids=["level", "uneven"])
def test_a_band_is_the_same_by_commands(local, ground, tmp_path):
    write_walk(tmp_path / "run")
    options = ["predict", "run/legs.csv", "--slip", "coulomb:0.38"]
    options += ["--draws", 10 if ground else 60]
    if ground:
        (tmp_path / "ground.toml").write_text(ground)
        options += ["--ground", "ground.toml"]

    def predict(out, *more):
        with started(*options, "--out", out, *more, cwd=tmp_path) as process:
            _, err = process.communicate(timeout=240)
        assert process.returncode == 0, err
        with np.load(tmp_path / out / "draws.npz") as stored:
            return stored["poses"], (tmp_path / out / "band.csv").read_text()

    expected, killed = predict("here"), []
    watch = threading.Thread(target=kill_one_at_work, args=(local, killed))
    watch.start()
    found = predict("there", "--scheduler", local.scheduler_address)
    watch.join()
    assert killed
    np.testing.assert_array_equal(found[0], expected[0])
    assert found[1] == expected[1]


def test_walks_are_fitted_the_same_by_commands(local, tmp_path):
    write_walk(tmp_path / "walk")
    for name in ("here", "there"):
        (tmp_path / name).mkdir()
    folders = [write_calibration(tmp_path / name) for name in ("here", "there")]

    def fit(calibration, *more):
        words = ("calibrate", "--walks", "walk", "--out", calibration, *more)
        with started(*words, cwd=tmp_path) as process:
            _, err = process.communicate(timeout=400)
        assert process.returncode == 0, err
        with np.load(calibration / "walks" / "draws.npz") as stored:
            return (calibration / "walks" / "walks.toml").read_text(), dict(stored)

    expected, killed = fit(folders[0]), []
    watch = threading.Thread(target=kill_one_at_work, args=(local, killed))
    watch.start()
    found = fit(folders[1], "--scheduler", local.scheduler_address)
    watch.join()
    assert killed
    assert found[0] == expected[0]
    for name, values in expected[1].items():
        np.testing.assert_array_equal(found[1][name], values)
