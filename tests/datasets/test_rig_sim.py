# SPDX-License-Identifier: MIT
import importlib.util
import tomllib
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from model.slip.definition import slip_ratio
from model.slip.thesis_curve import THESIS_LAW, THESIS_VALUES

FOLDER = Path(__file__).parents[2] / "datasets" / "rig-sim"
COMMITTED = sorted(FOLDER.glob("*.csv.gz"))


@pytest.fixture(scope="module")
def generator():
    spec = importlib.util.spec_from_file_location("rig_sim_generate", FOLDER / "generate.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def truth():
    return tomllib.loads((FOLDER / "truth.toml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def regenerated(generator, tmp_path_factory):
    folder = tmp_path_factory.mktemp("rig-sim")
    generator.write(folder)
    return folder


def committed_column(name):
    return np.concatenate([pd.read_csv(path)[name].to_numpy() for path in COMMITTED])


def test_there_is_one_file_a_load_and_all_are_small(generator):
    assert len(COMMITTED) == len(generator.PLAN.loads)
    assert sum(path.stat().st_size for path in COMMITTED) < 5e6


def test_generating_again_gives_the_committed_numbers(regenerated):
    assert [p.name for p in sorted(regenerated.glob("*.csv.gz"))] == [p.name for p in COMMITTED]
    for path in COMMITTED:
        old, new = pd.read_csv(path), pd.read_csv(regenerated / path.name)
        assert list(new) == list(old)
        for name in old:
            # a last bit may turn with the processor's sine; float32 keeps 6e-8 of a value
            np.testing.assert_allclose(
                new[name].to_numpy(), old[name].to_numpy(), rtol=3e-7, atol=1e-7
            )


def test_generating_again_gives_the_committed_truth_and_leaves_no_litter(regenerated):
    assert (regenerated / "truth.toml").read_text() == (FOLDER / "truth.toml").read_text()
    names = {path.name for path in COMMITTED} | {"truth.toml", "manifest.toml"}
    assert {path.name for path in regenerated.iterdir()} == names


def test_rounding_to_single_precision_is_far_below_the_sensors_noise(generator):
    exact, rig = generator.simulate()
    for name, noise in [
        ("omega_leg", rig.speed_noise),
        ("omega_ground", rig.speed_noise),
        ("normal_force", rig.noise_sd0),
        ("traction_force", rig.noise_sd0),
    ]:
        rounding = np.abs(committed_column(name) - exact.table[name]).max()
        assert rounding < 1e-4 * noise
    np.testing.assert_array_equal(committed_column("t"), exact.table["t"])
    np.testing.assert_array_equal(committed_column("run"), exact.table["run"])


def test_every_place_that_names_the_source_says_simulated(generator, truth):
    columns = tomllib.loads((FOLDER / "columns.toml").read_text(encoding="utf-8"))
    assert columns["source"] == truth["source"] == generator.SOURCE == "sim:rig-sweep"
    for path in COMMITTED:
        assert path.name.startswith("simulated")
    assert "SIMULATED" in (FOLDER / "README.md").read_text(encoding="utf-8").splitlines()[0]


def test_truth_toml_states_the_law_and_the_rig(generator, truth):
    _, rig = generator.simulate()
    assert list(truth[THESIS_LAW.name].values()) == list(THESIS_VALUES)
    assert list(truth[THESIS_LAW.name]) == [p.name for p in THESIS_LAW.parameters]
    for name, value in truth["rig"].items():
        assert getattr(rig, name) == value


def test_the_committed_log_follows_the_true_law(truth):
    rig = truth["rig"]
    Fn, Ft = committed_column("normal_force"), committed_column("traction_force")
    slip = slip_ratio(
        committed_column("omega_leg") * 0.035, committed_column("omega_ground") * 0.12, "material"
    )
    # The mean of a run is known better than a sample: white noise of the load is not in the force.
    Fn, Ft, slip = (x.reshape(248, -1).mean(axis=1) for x in (Fn, Ft, slip))
    load = (1 + rig["gain_normal"]) * Fn - rig["bias_normal"] + rig["crosstalk"] * Ft
    force = (1 + rig["gain_traction"]) * THESIS_LAW.force(slip, load, THESIS_VALUES)
    late = np.abs(slip) > 0.25  # where the blur of the measured slip hardly moves the force
    residual = (Ft - force)[late]
    memory = 2 * rig["noise_correlation_time"]  # s; noise of means over the run's one second
    noise = (rig["noise_sd0"] + rig["noise_sd1"] * np.abs(force[late])) * np.sqrt(memory)
    promised = np.sqrt(np.mean(noise**2) + rig["offset_sd"] ** 2)
    assert residual.std() == pytest.approx(promised, rel=0.25)
    assert abs(residual.mean()) < 4 * promised / np.sqrt(late.sum())
