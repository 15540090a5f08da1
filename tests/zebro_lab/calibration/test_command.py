# SPDX-License-Identifier: MIT
"""`calibrate-slip` as its user meets it: a process with arguments, streams and an exit code."""

import json
import shlex
import shutil
import signal
import subprocess
import sys
import time
import tomllib
from hashlib import sha256
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.stats import chi2

from model.slip.laws import LAWS
from model.slip.thesis import THESIS_VALUES
from zebro_lab.calibration.folder import read_slip
from zebro_lab.main import slip_app as app
from zebro_lab.terminal.ending import run as run_app

pytestmark = pytest.mark.timeout(600)

COMMAND = str(Path(sys.executable).with_name("calibrate-slip"))
SMALL_FIT = ("--curvature", "peak", "--block-length", "30", "--threads", "1")
PICTURES = {f"{name}.png" for name in ("curves", "surface", "corner", "traces", "residuals")}
FILES = {"slip.toml", "summary.csv", "posterior.nc", "manifest.json"} | PICTURES
LOOK_OFTEN = "import zebro_lab.calibration.stage as stage; stage.CHECKPOINT_SECONDS = 0.0; "
EASILY_PLEASED = (
    "import model.bayes.convergence as rules; "
    "rules.MIN_LENGTH, rules.MIN_ESS, rules.MAX_R_HAT, rules.MAX_MCSE = 5, 50, 1.2, 0.5; "
)
JUDGED_EARLY = "import model.bayes.calibrate as fits; fits.FIRST_LOOK = 40; "
"""Judge from 40 kept steps on instead of 100: not every claim needs that many."""
MAIN = "from zebro_lab.main import calibrate_slip; calibrate_slip()"


def run(command: list[str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=500)


def calibrate_slip(*arguments: object) -> subprocess.CompletedProcess[str]:
    return run([COMMAND, *map(str, arguments)])


def patched(patch: str, *arguments: object) -> list[str]:
    """Return the command with a few of its constants changed."""
    return [sys.executable, "-c", patch + MAIN, *map(str, arguments)]


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


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
    assert "averaged in 120 blocks of about 30 (as asked for)." in process.stdout
    header = next(line for line in process.stdout.splitlines() if "Fn [N]" in line)
    assert {"B", "C", "D", "E", "x_m", "BCD"} <= set(header.split())
    assert "verdict: converged" in process.stdout
    for name in FILES:
        assert str(out / name) in process.stdout


def test_slip_toml_says_converged(converged):
    content = tomllib.loads((converged[1] / "slip.toml").read_text())
    assert content["verdict"]["converged"]
    assert content["verdict"]["trustworthy"]
    assert content["tested"]["samples"] == 3600


def test_truth_lies_in_the_joint_region_of_99_9_percent(converged):
    curve = read_slip(converged[1])
    error = np.subtract(curve.values, THESIS_VALUES)
    assert error @ np.linalg.solve(curve.covariance, error) < chi2.ppf(0.999, len(error))


def test_summary_has_a_row_a_parameter_with_its_diagnostics(converged):
    summary = pd.read_csv(converged[1] / "summary.csv", index_col="parameter")
    assert list(summary.index[:4]) == ["slip_stiffness", "shape", "friction", "peak_slip_per_load"]
    assert (summary.r_hat <= 1.01).all()
    assert (summary.ess_bulk >= 400).all()
    assert (summary.q05 < summary["median"]).all()
    assert (summary["median"] < summary.q95).all()


# A fit that does not.


def test_fit_out_of_steps_exits_3_with_its_results_marked(sweep, tmp_path):
    out = tmp_path / "out"
    arguments = (sweep, "--out", out, *SMALL_FIT, "--max-steps", 1)
    process = run(patched(JUDGED_EARLY, *arguments))
    assert process.returncode == 3, process.stderr
    assert "error" not in process.stderr
    assert "--max-steps 1 is fewer than the 500 sampler moves" in process.stdout
    assert "verdict: NOT CONVERGED" in process.stdout
    assert "next: sample longer: give the same command with --resume --max-steps" in process.stdout
    assert names(out) == FILES | {"checkpoint.npz"}
    verdict = tomllib.loads((out / "slip.toml").read_text())["verdict"]
    assert not verdict["converged"]
    assert not verdict["trustworthy"]
    assert "NOT CONVERGED" in verdict["headline"]


# Stopping and going on.


def last_line(stderr: str) -> str:
    """Return the last line, below those that tell the progress of a slow fit."""
    *progress, last = stderr.splitlines(keepends=True)
    assert all(" of this step" in line for line in progress)
    return last


def start_and_signal(number: signal.Signals, command: list[str], out: Path) -> tuple[int, str, str]:
    """Start a fit, send it a signal once it has a checkpoint, and wait for its end."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        deadline = time.monotonic() + 300
        while not (out / "checkpoint.npz").exists():
            assert process.poll() is None, process.communicate()
            assert time.monotonic() < deadline, "no checkpoint appeared"
            time.sleep(0.05)
        process.send_signal(number)
        stdout, stderr = process.communicate(timeout=120)
    finally:
        process.kill()
        process.wait()
    return process.returncode, stdout, stderr


@pytest.fixture(
    scope="module", params=[signal.SIGINT, signal.SIGTERM], ids=lambda number: number.name
)
def stopped(
    request, sweep, tmp_path_factory
) -> tuple[tuple[object, ...], Path, tuple[int, str, str]]:
    """Return the arguments of a fit that was asked to stop, its folder and how it ended."""
    out = tmp_path_factory.mktemp("stopped") / "out"
    arguments = (sweep, "--out", out, *SMALL_FIT)
    command = patched(LOOK_OFTEN + JUDGED_EARLY, *arguments)
    return arguments, out, start_and_signal(request.param, command, out)


def test_stopped_fit_exits_130_with_a_checkpoint_alone_and_says_how_to_go_on(stopped):
    arguments, out, ending = stopped
    checkpoint = out / "checkpoint.npz"
    message, command = last_line(ending[2]).split("; go on with: ")
    assert (ending[0], message) == (130, f"stopped; {checkpoint} keeps the fit")
    assert "SIMULATED data, source 'sim:rig-sweep': 3600 samples" in ending[1]  # before the fit
    assert "verdict" not in ending[1]
    assert shlex.split(command)[1:] == [*map(str, arguments), "--resume"]
    assert names(out) == {"checkpoint.npz"}
    with np.load(checkpoint, allow_pickle=False) as stored:
        assert np.isfinite(stored["z"]).all()


@pytest.mark.parametrize("stopped", [signal.SIGINT], indirect=True, ids=["SIGINT"])
def test_stopped_fit_resumes_to_convergence(stopped, sweep, tmp_path):
    out = tmp_path / "out"
    shutil.copytree(stopped[1], out)
    arguments = (sweep, "--out", out, *SMALL_FIT, "--resume")
    resumed = run(patched(EASILY_PLEASED, *arguments))
    assert resumed.returncode == 0
    assert "error" not in resumed.stderr
    assert names(out) == FILES
    assert tomllib.loads((out / "slip.toml").read_text())["verdict"]["converged"]


def test_killed_fit_leaves_a_checkpoint_that_resumes(sweep, tmp_path):
    out = tmp_path / "out"
    arguments = (sweep, "--out", out, *SMALL_FIT)
    code, *_ = start_and_signal(signal.SIGKILL, patched(LOOK_OFTEN + JUDGED_EARLY, *arguments), out)
    assert code == -signal.SIGKILL
    resumed = run(patched(JUDGED_EARLY, *arguments, "--resume", "--max-steps", 1))
    assert resumed.returncode == 3
    assert "error" not in resumed.stderr
    assert names(out) >= FILES


# What cannot be used.


@pytest.fixture
def refusal(monkeypatch, capsys):
    """Return a runner of the command in this process: its one line, having checked its ending."""

    def run(*arguments: object, out: Path) -> str:
        monkeypatch.setattr(sys, "argv", [COMMAND, *map(str, arguments), "--out", str(out)])
        with pytest.raises(SystemExit) as ended:
            run_app(app)
        streams = capsys.readouterr()
        assert ended.value.code == 1
        assert "parameters" not in streams.out  # what was read may be told
        assert streams.err.startswith("error: ")
        assert streams.err.endswith("\n")
        assert streams.err.count("\n") == 1
        return streams.err

    return run


def faulty(sweep: Path, folder: Path, fault: str) -> None:
    """Write the sweep with a fault into a folder."""
    (folder / "columns.toml").write_text((sweep / "columns.toml").read_text())
    table = pd.read_csv(sweep / "sweep.csv").head(600)
    file = folder / "rig.csv"
    match fault:
        case "missing column":
            table = table.drop(columns="normal_force")
        case "unknown unit":
            with (folder / "columns.toml").open("a") as columns:
                columns.write('\n[columns.normal_force]\nunit = "Newtom"\n')
        case "not a number":
            table.loc[40, "traction_force"] = np.nan
        case "infinite":
            table.loc[40, "traction_force"] = np.inf
        case "negative load":
            table.loc[40, "normal_force"] = -1.0
        case "constant slip":
            table = table.assign(omega_leg=12.0, omega_ground=3.0)
        case "mixed definitions":
            ratios = table.drop(columns=["omega_leg", "omega_ground", "radius_leg"])
            ratios.assign(slip_ratio=0.1, slip_definition="travel").to_csv(
                folder / "other.csv", index=False
            )
        case "repeated time":
            table.loc[40, "t"] = table.loc[39, "t"]
        case "three samples":
            table = table.head(3)
    table.to_csv(file, index=False)
    match fault:
        case "empty folder":
            file.unlink()
        case "truncated parquet":
            file.unlink()
            table.to_parquet(folder / "rig.parquet")
            content = (folder / "rig.parquet").read_bytes()
            (folder / "rig.parquet").write_bytes(content[: len(content) // 2])
        case "binary file":
            file.write_bytes(bytes(range(256)) * 8)


FAULTS = {
    "missing column": "column 'normal_force': is missing",
    "unknown unit": "unknown unit 'Newtom'",
    "not a number": "column 'traction_force', row 41 (line 42): is empty; expected finite",
    "infinite": "column 'traction_force', row 41 (line 42): is infinite; expected finite",
    "negative load": "column 'normal_force', row 41 (line 42): the normal force is -1 N",
    "constant slip": "a curve needs several set-points",
    "mixed definitions": "'travel'",
    "repeated time": "column 't', row 41 (line 42): time",
    "three samples": "3 samples in all, expected at least 20",
    "empty folder": "holds no data",
    "truncated parquet": "rig.parquet: is not a complete Parquet file",
    "binary file": "rig.csv: is not text but a binary file",
}


@pytest.mark.parametrize("fault", FAULTS)
def test_bad_input_is_one_line_and_leaves_nothing(sweep, tmp_path, refusal, fault):
    data, out = tmp_path / "data", tmp_path / "out"
    data.mkdir()
    faulty(sweep, data, fault)
    line = refusal(data, out=out)
    assert FAULTS[fault] in line
    assert str(data) in line
    assert names(tmp_path) == {"data"}


@pytest.mark.parametrize("fault", ["not a number", "truncated parquet", "empty folder"])
def test_bad_input_ends_the_process_with_1_and_no_traceback(sweep, tmp_path, fault):
    data = tmp_path / "data"
    data.mkdir()
    faulty(sweep, data, fault)
    process = calibrate_slip(data, "--out", tmp_path / "out")
    assert (process.returncode, process.stdout) == (1, "")
    assert process.stderr.startswith("error: ")
    assert process.stderr.count("\n") == 1
    assert FAULTS[fault] in process.stderr
    assert names(tmp_path) == {"data"}


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        (("--columns", "absent.toml"), "absent.toml"),
        (("--resume",), "checkpoint.npz: no stopped fit to resume; run without --resume"),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else "",
)
def test_option_that_cannot_be_followed_is_one_line(sweep, tmp_path, refusal, options, problem):
    assert problem in refusal(sweep, *options, out=tmp_path / "out")
    assert names(tmp_path) == set()


def test_damaged_checkpoint_is_one_line_and_is_kept(sweep, tmp_path, refusal):
    (tmp_path / "checkpoint.npz").write_bytes(b"PK\x03\x04 no archive")
    line = refusal(sweep, "--resume", out=tmp_path)
    assert "checkpoint.npz: is not a checkpoint of zebro-lab" in line
    assert "delete it and run without --resume" in line
    assert names(tmp_path) == {"checkpoint.npz"}


@pytest.mark.parametrize(
    "arguments",
    [(), (".", "--no-such-option"), (".", "--max-steps", "0"), (".", "--ensembles", "3")],
    ids=["no data", "unknown option", "no steps", "few ensembles"],
)
def test_bad_usage_exits_2(tmp_path, arguments):
    process = subprocess.run(
        [COMMAND, *arguments], capture_output=True, text=True, check=False, cwd=tmp_path
    )
    assert (process.returncode, process.stdout) == (2, "")
    assert "Usage: calibrate-slip" in process.stderr
    assert names(tmp_path) == set()


@pytest.mark.parametrize(
    ("entry", "arguments"),
    [
        ("calibrate_slip", ["--help"]),
        ("main", ["--help"]),
        ("main", ["calibrate", "--help"]),
        ("main", ["init", "--help"]),
    ],
)
def test_help_imports_nothing_heavy(entry, arguments):
    code = f"""
import sys
from zebro_lab.main import {entry}
sys.argv = ["command", *{arguments}]
try:
    {entry}()
finally:
    print("modules:", *sys.modules)
"""
    process = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    printed, _, modules = process.stdout.partition("modules:")
    assert "Usage:" in printed
    heavy = {"numpy", "scipy", "pandas", "numba", "matplotlib", "emcee", "arviz", "pyarrow", "pint"}
    assert not heavy & set(modules.split())


def test_help_names_every_slip_law():
    shown = "".join(calibrate_slip("--help").stdout.split())  # lines break at hyphens
    assert all(name in shown for name in LAWS)


def test_help_names_every_exit_code():
    process = calibrate_slip("--help")
    assert process.returncode == 0
    text = " ".join(process.stdout.split())
    for meaning in ("0 converged", "1 error", "2 usage", "3 not converged", "130 stopped"):
        assert meaning in text
