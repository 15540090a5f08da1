# SPDX-License-Identifier: MIT
"""`calibrate-slip` as its user meets it: a process with arguments, streams and an exit code."""

import json
import subprocess
import tomllib
from hashlib import sha256
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.stats import chi2

from model.slip.laws import LAWS
from model.slip.thesis_curve import THESIS_VALUES
from support.calibrate_processes import FILES, SMALL_FIT, SMALLER_FIT, calibrate_slip, names
from support.out_of_true import swept
from support.quick_fits import fit_quickly
from zebro_lab.calibration.folder import read_slip

pytestmark = pytest.mark.timeout(600)

# A fit that converges under the rules as they are.


@pytest.fixture(scope="module")
def converged(sweep, tmp_path_factory) -> tuple[subprocess.CompletedProcess[str], Path]:
    out = tmp_path_factory.mktemp("converged") / "calibration"
    return calibrate_slip(sweep, "--out", out, *SMALL_FIT), out


def test_converged_fit_exits_0_and_is_quiet_in_a_pipe(converged):
    process, _ = converged
    assert process.returncode == 0, process.stderr
    assert "error" not in process.stderr
    assert "\x1b" not in process.stdout
    assert "\r" not in process.stdout


def test_folder_holds_tables_pictures_and_nothing_else(converged):
    assert names(converged[1]) == FILES
    assert names(converged[1].parent) == {"calibration"}


def test_manifest_hashes_what_was_read_and_what_was_written(converged, sweep):
    _, out = converged
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["outputs"].keys() == FILES - {"manifest.json"}
    assert manifest["inputs"].keys() == {str(path) for path in sweep.iterdir()}
    for name, digest in (*manifest["outputs"].items(), *manifest["inputs"].items()):
        assert sha256((out / name).read_bytes()).hexdigest() == digest
    assert manifest["source"] == "sim:rig-sweep"
    assert manifest["settings"]["load_cell"]["zero_stability"] == 0.1
    assert {"python", "numpy", "emcee", "zebro-lab"} <= manifest["software"].keys()


def test_simulated_data_is_called_simulated_wherever_it_is_read(converged):
    process, out = converged
    assert "SIMULATED data, source 'sim:rig-sweep': 3600 samples in 24 runs" in process.stdout
    assert "of the measurement (simulated)" in process.stdout
    text = (out / "slip.toml").read_text()
    assert "SIMULATED data: nothing here was measured." in text
    assert tomllib.loads(text)["source"] == "sim:rig-sweep"


def test_printed_report_has_definition_coefficients_verdict_and_paths(converged):
    process, out = converged
    assert "slip definition: material" in process.stdout
    assert "Samples are averaged in" in process.stdout
    header = next(line for line in process.stdout.splitlines() if "Fn [N]" in line)
    assert {"B", "C", "D", "E", "x_m", "BCD"} <= set(header.split())
    assert "verdict: not fully tested; untested: " in process.stdout
    for name in FILES:
        assert str(out / name) in process.stdout


def test_slip_toml_says_converged(converged):
    content = tomllib.loads((converged[1] / "slip.toml").read_text())
    assert content["verdict"]["converged"]
    assert content["verdict"]["state"] == "not fully tested"
    assert content["verdict"]["likely_wrong"] == content["verdict"]["notes"] == []
    assert not content["verdict"]["trustworthy"]
    assert "repeatability (no set-point twice)" in content["verdict"]["untested"]
    outcomes = {check["name"]: check["outcome"] for check in content["verdict"]["checks"]}
    assert outcomes["Are rise and peak measured?"] == "passed"
    assert (len(outcomes), "failed" in outcomes.values()) == (8, False)
    assert content["tested"]["samples"] == 3600


def test_truth_lies_in_the_joint_region_of_99_9_percent(converged):
    curve = read_slip(converged[1])
    error = np.subtract(curve.values, THESIS_VALUES)
    assert error @ np.linalg.solve(curve.covariance, error) < chi2.ppf(0.999, len(error))


def test_summary_has_a_row_a_parameter_with_its_diagnostics(converged):
    summary = pd.read_csv(converged[1] / "summary.csv", index_col="parameter")
    # The curvature that the data are made of, chosen by predictions of left-out runs.
    assert list(summary.index[:4]) == ["slip_stiffness", "shape", "friction", "peak_slip_per_load"]
    assert (summary.r_hat <= 1.01).all()
    assert (summary.ess_bulk >= 400).all()
    assert (summary.q05 < summary["median"]).all()
    assert (summary["median"] < summary.q95).all()


# A fit that does not.


def test_fit_out_of_steps_exits_3_with_its_results_marked(
    sweep, run_command, tmp_path, monkeypatch, blank_pictures
):
    fit_quickly(monkeypatch)
    out = tmp_path / "out"
    ended = run_command("calibrate-slip", sweep, "--out", out, *SMALLER_FIT, "--max-steps", 1)
    assert ended.code == 3, ended.err
    assert "error" not in ended.err
    assert "--max-steps 1 is fewer than the 500 sampler moves" in ended.out
    assert "verdict: not trustworthy: the sampler did not converge" in ended.out
    assert names(out) == FILES | {"checkpoint.npz"}
    verdict = tomllib.loads((out / "slip.toml").read_text())["verdict"]
    assert not verdict["converged"]
    assert not verdict["trustworthy"]


# Usage and help.


@pytest.mark.parametrize(
    "arguments",
    [(), (".", "--no-such-option"), (".", "--max-steps", "0")],
    ids=["no data", "unknown option", "no steps"],
)
def test_bad_usage_exits_2(run_command, tmp_path, monkeypatch, arguments):
    monkeypatch.chdir(tmp_path)
    ended = run_command("calibrate-slip", *arguments)
    assert (ended.code, ended.out) == (2, "")
    assert "Usage: " in ended.err
    assert names(tmp_path) == set()


def test_help_names_every_slip_law_and_exit_code(run_command):
    ended = run_command("calibrate-slip", "--help")
    assert ended.code == 0
    assert all(name in "".join(ended.out.split()) for name in LAWS)  # lines break at hyphens
    text = " ".join(ended.out.split())
    for meaning in ("0 converged", "1 error", "2 usage", "3 not converged", "130 stopped"):
        assert meaning in text


def test_run_out_is_told_and_corrected_where_tables_have_angles(
    run_command, tmp_path, blank_pictures
):
    data = tmp_path / "data"
    data.mkdir()
    pd.DataFrame(swept().table).to_parquet(data / "rig.parquet")
    (data / "columns.toml").write_text(
        'source = "sim:test"\n[constants]\nradius_leg = "35 mm"\nradius_ground = "120 mm"\n'
        '[rig_errors]\nradius = "0.02 mm"\nrolling_resistance = 0.002\n'
    )
    out = tmp_path / "out"
    ended = run_command(
        "calibrate-slip", data, "--out", out, "--engine", "laplace", "--law", "brush"
    )
    assert ended.code == 0, ended.err
    told = " ".join(ended.out.split())
    assert "run-out: leg disc 0.0" in told
    assert "slip is corrected for it, which predicts left-out runs better" in told
    content = tomllib.loads((out / "slip.toml").read_text())["run_out"]
    assert content["corrected"] is True
    for disc in ("leg", "ground"):
        for name, true in (("cos", 5e-5), ("sin", 0.0), ("cos_2", 5e-5), ("sin_2", 0.0)):
            found = content[disc][name]
            assert abs(found["mean"] - true) < 4 * found["sd"]
    read_slip(out)
