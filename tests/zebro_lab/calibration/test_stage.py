# SPDX-License-Identifier: MIT
"""The stage without the command: the same numbers again, after a stop, beside foreign files."""

import json
import signal
import tomllib
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from shutil import copytree

import numpy as np
import pandas as pd
import pytest
import xarray as xr

from model.bayes.calibration import Calibration
from model.bayes.drawing.sampler import Chains
from model.errors import DomainError
from support.quick_fits import NO_PRIOR_STARTS, fit_quickly
from zebro_lab.calibration import stage
from zebro_lab.calibration.folder import read_slip
from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.calibration.stage import Stopped, calibrate
from zebro_lab.files.errors import AlreadyExists, SettingsError
from zebro_lab.terminal.stopping import StoppedBySignal
from zebro_lab.workers import WorkersRequest

TABLES = {"slip.toml", "summary.csv", "posterior.nc", "manifest.json"}


@dataclass
class Watcher:
    """Counts the looks of a fit at its watcher, and may stop it at one of them.

    Attributes:
        stop_at: Look at which to ask for a stop.
        die_at: Look at which to end without a word, as a killed process does.
        looks: Looks so far.
    """

    stop_at: int | None = None
    die_at: int | None = None
    looks: int = 0

    def step(self, what: str, fraction: float | None) -> None:
        assert what
        assert fraction is None or 0 <= fraction <= 1

    def stop_requested(self) -> bool:
        self.looks += 1
        if self.looks == self.die_at:
            raise Killed
        return self.looks == self.stop_at


class Killed(BaseException):
    """Stands for a process that ends between two instructions."""


@pytest.fixture(autouse=True, scope="module")
def short_fits() -> Iterator[pytest.MonkeyPatch]:
    """Judge from 10 kept steps on, and draw nothing: these claims need no converged fit."""
    with pytest.MonkeyPatch.context() as patch:
        fit_quickly(patch)
        patch.setattr(*NO_PRIOR_STARTS)
        patch.setattr(stage, "draw_calibration", lambda *_: None)
        patch.setattr(stage, "CHECKPOINT_SECONDS", 1e9)  # a slow machine would keep a fit
        yield patch


@pytest.fixture(scope="module")
def request_for(sweep):
    """Return a maker of requests for a fit that ends, unconverged, after 21 kept steps."""

    def make(out: Path, **changes) -> CalibrationRequest:
        asked = CalibrationRequest(
            (sweep,), out, law="coulomb-stribeck", max_steps=100, workers=WorkersRequest(1)
        )
        return replace(asked, **changes)

    return make


@pytest.fixture(scope="module")
def fitted(tmp_path_factory, request_for) -> tuple[Path, Calibration, Chains]:
    """Return the folder of an uninterrupted fit, what it concluded, and its chains."""
    out, kept = tmp_path_factory.mktemp("fit") / "calibration", []
    with pytest.MonkeyPatch.context() as patch:
        fit = stage.fit_slip_law
        patch.setattr(stage, "fit_slip_law", lambda *a, **k: kept.append(fit(*a, **k)) or kept[0])
        calibrate(request_for(out), Watcher())
    return out, *kept[0]


@pytest.fixture
def uninterrupted(fitted) -> Path:
    """Return the folder of an uninterrupted fit."""
    return fitted[0]


@pytest.fixture
def already_fitted(fitted, monkeypatch) -> None:
    """Give every fit of the test the chains and the conclusion of the one that is done."""
    _, calibration, chains = fitted

    def fit(*_, keep, **__):
        keep(chains)
        return calibration, chains

    monkeypatch.setattr(stage, "fit_slip_law", fit)


def checkpoint_arrays(out: Path) -> dict[str, np.ndarray]:
    with np.load(out / "checkpoint.npz", allow_pickle=False) as stored:
        return dict(stored)


def assert_same_fit(out: Path, other: Path) -> None:
    assert (out / "slip.toml").read_text() == (other / "slip.toml").read_text()
    assert (out / "summary.csv").read_text() == (other / "summary.csv").read_text()
    mine, theirs = checkpoint_arrays(out), checkpoint_arrays(other)
    assert mine.keys() == theirs.keys()
    for name, values in mine.items():
        np.testing.assert_array_equal(values, theirs[name], err_msg=name)


def test_fit_writes_its_files_and_a_checkpoint_while_it_has_not_converged(uninterrupted):
    found = {path.name for path in uninterrupted.iterdir()}
    assert found == TABLES | {"checkpoint.npz"}
    assert checkpoint_arrays(uninterrupted)["z"].shape[1] == 21


def test_fit_is_the_same_with_two_threads(uninterrupted, request_for, tmp_path):
    asked = request_for(tmp_path / "out", workers=WorkersRequest(2))
    calibrate(asked, Watcher(), executor=ThreadPoolExecutor(2))
    assert_same_fit(tmp_path / "out", uninterrupted)


def test_a_fit_that_was_stopped_and_then_killed_goes_on_to_be_bitwise_the_uninterrupted_one(
    uninterrupted, request_for, tmp_path, monkeypatch
):
    out = tmp_path / "out"
    with pytest.raises(Stopped) as stopped:
        calibrate(request_for(out), Watcher(stop_at=2))
    assert stopped.value.checkpoint == out / "checkpoint.npz"
    assert [path.name for path in out.iterdir()] == ["checkpoint.npz"]
    monkeypatch.setattr(stage, "CHECKPOINT_SECONDS", -1.0)  # after every few steps
    with pytest.raises(Killed):
        calibrate(request_for(out, resume=True), Watcher(die_at=3))
    assert 1 < checkpoint_arrays(out)["z"].shape[1] < 21
    calibrate(request_for(out, resume=True), Watcher())
    assert_same_fit(out, uninterrupted)


def test_stop_before_sampling_writes_nothing(request_for, tmp_path):
    with pytest.raises(Stopped, match="nothing was written") as stopped:
        calibrate(request_for(tmp_path / "out"), Watcher(stop_at=1))
    assert stopped.value.checkpoint is None
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("sampled_long", [True, False])
def test_a_signal_while_drawing_tells_of_a_checkpoint_if_there_is_one(
    already_fitted, request_for, tmp_path, monkeypatch, sampled_long
):
    def signalled(*_):
        raise StoppedBySignal(signal.SIGINT)

    monkeypatch.setattr(stage, "draw_calibration", signalled)
    monkeypatch.setattr(stage, "CHECKPOINT_SECONDS", -1.0 if sampled_long else 1e9)
    out = tmp_path / "out"
    with pytest.raises(Stopped if sampled_long else StoppedBySignal) as stopped:
        calibrate(request_for(out), Watcher())
    assert getattr(stopped.value, "checkpoint", None) == (
        out / "checkpoint.npz" if sampled_long else None
    )
    assert out.is_dir() == sampled_long


def test_checkpoint_of_other_settings_is_refused(uninterrupted, request_for):
    with pytest.raises(ValueError, match="is of a fit with other data or settings"):
        calibrate(request_for(uninterrupted, resume=True, seed=2), Watcher())


def test_failure_while_drawing_leaves_the_earlier_calibration_untouched(
    uninterrupted, already_fitted, request_for, monkeypatch
):
    before = {path.name: path.read_bytes() for path in uninterrupted.iterdir()}

    def fail(folder: Path, *_) -> None:
        (folder / "curves.png").write_bytes(b"half a pict")
        raise OSError("disk full")

    monkeypatch.setattr(stage, "draw_calibration", fail)
    with pytest.raises(OSError, match="disk full"):
        calibrate(request_for(uninterrupted, seed=2), Watcher())
    assert {path.name: path.read_bytes() for path in uninterrupted.iterdir()} == before
    assert list(uninterrupted.parent.iterdir()) == [uninterrupted]


def test_failure_while_drawing_leaves_no_folder(already_fitted, request_for, tmp_path, monkeypatch):
    def fail(*_) -> None:
        raise OSError("disk full")

    monkeypatch.setattr(stage, "draw_calibration", fail)
    with pytest.raises(OSError, match="disk full"):
        calibrate(request_for(tmp_path / "deep" / "out"), Watcher())
    assert list(tmp_path.iterdir()) == []


def test_a_fit_by_another_seed_replaces_its_forerunner_and_leaves_foreign_files(
    uninterrupted, request_for, tmp_path
):
    out = tmp_path / "out"
    foreign = {"my-photo.png", "notes.txt"}
    copytree(uninterrupted, out)
    before = (out / "slip.toml").read_text()
    for name in foreign:
        (out / name).write_text("not this fit's")
    calibrate(request_for(out, seed=2, max_steps=1), Watcher())
    assert (out / "slip.toml").read_text() != before
    first_steps = [checkpoint_arrays(each)["z"][:, 0] for each in (out, uninterrupted)]
    assert not np.array_equal(*first_steps)
    assert {path.name for path in out.iterdir()} == TABLES | {"checkpoint.npz"} | foreign
    assert {(out / name).read_text() for name in foreign} == {"not this fit's"}
    assert read_slip(out).law.name == "coulomb-stribeck"


def test_posterior_nc_has_an_ensemble_as_a_chain(uninterrupted):
    stored = xr.open_datatree(uninterrupted / "posterior.nc")
    assert stored["posterior"].sizes["chain"] == 2
    assert stored["observed_data"]["traction_force"].sizes["block"] == 120
    assert (stored.attrs["source"], stored.attrs["slip_definition"]) == (
        "sim:rig-sweep",
        "material",
    )
    assert "the sampler did not converge" in stored.attrs["verdict"]


def test_curve_without_a_peak_is_written_with_its_peak_at_infinity(request_for, tmp_path):
    calibration, _ = calibrate(request_for(tmp_path, law="brush", max_steps=1), Watcher())
    content = tomllib.loads((tmp_path / "slip.toml").read_text())
    assert [row["peak_slip"] for row in content["curve"]] == [np.inf, np.inf]
    assert read_slip(tmp_path).law == calibration.posterior.law


def test_weighted_draws_alone_make_a_calibration_that_says_so(request_for, tmp_path):
    out, answers = tmp_path / "calibration", []
    gaussian = ("radius_error = 0 ± 0.0003", "rolling_resistance = 0 ± 0.001")  # nearly
    request = request_for(out, engine="laplace", prior=gaussian)
    found, _ = calibrate(request, Watcher(), first=answers.append)
    (first,) = answers
    assert first.reliable
    assert found.convergence.converged
    assert "sampling by emcee" in found.verdict.untested
    assert not found.verdict.trustworthy
    assert not (out / "checkpoint.npz").exists()
    for early, late in zip(first.estimates, found.parameters, strict=False):
        assert early.median == pytest.approx(late.median, abs=0.15 * late.sd)
    assert read_slip(out).covariance.shape == (4, 4)


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({"law": "brush", "load_sensitivity": True}, "belongs to the Magic Formula"),
        ({"engine": "laplace", "resume": True}, "leave out --engine laplace"),
    ],
)
def test_options_that_do_not_fit_are_refused(request_for, tmp_path, changes, problem):
    with pytest.raises(SettingsError, match=problem):
        calibrate(request_for(tmp_path / "out", **changes), Watcher())
    assert not (tmp_path / "out").exists()


def test_file_in_the_place_of_the_folder_is_refused_before_the_data_is_read(request_for, tmp_path):
    (tmp_path / "out").write_text("a file")
    with pytest.raises(AlreadyExists, match="is a file; give the name of a folder as --out"):
        calibrate(request_for(tmp_path / "out", data=(tmp_path / "absent",)), Watcher())
    assert (tmp_path / "out").read_text() == "a file"


def test_a_slip_toml_that_a_person_wrote_is_kept(already_fitted, request_for, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "slip.toml").write_text("# measured by hand\n")
    with pytest.raises(AlreadyExists, match=r"slip\.toml"):
        calibrate(request_for(out), Watcher())
    assert (out / "slip.toml").read_text() == "# measured by hand\n"


def test_data_are_not_calibrated_into_their_own_folder(
    already_fitted, request_for, sweep, tmp_path
):
    data = tmp_path / "data"
    data.mkdir()
    for file in sweep.iterdir():
        (data / file.name).write_bytes(file.read_bytes())
    with pytest.raises(AlreadyExists, match="--out"):
        calibrate(request_for(data, data=(data,)), Watcher())
    assert {path.name for path in data.iterdir()} == {path.name for path in sweep.iterdir()}


def test_an_earlier_calibration_is_recorded_with_how_the_data_agree(
    tmp_path, request_for, uninterrupted, sweep
):
    new = tmp_path / "this-year"
    copytree(sweep, new)
    (table,) = new.glob("*.csv")
    table.write_text("".join(table.read_text().splitlines(keepends=True)[:-1]))
    changes = {"prior": ("offset_spread = 0.05 ± 0.02 N",)}
    with pytest.raises(DomainError, match="offset_spread: a prior of its own, and one from"):
        calibrate(
            request_for(tmp_path / "x", data=(new,), prior_from=uninterrupted, **changes),
            Watcher(),
        )
    with pytest.raises(SettingsError, match="would count twice"):
        calibrate(request_for(tmp_path / "x", prior_from=uninterrupted), Watcher())
    out = tmp_path / "calibration"
    request = request_for(out, data=(new,), prior_from=uninterrupted)
    calibration, _ = calibrate(request, Watcher())
    slip = tomllib.loads((out / "slip.toml").read_text())
    assert "gain_normal" in slip["priors"]["from"]["parameters"]
    (agreement,) = slip["priors"]["agreement"]
    assert agreement["degrees_of_freedom"] > 0
    assert agreement["conflict"] in (True, False)
    summary = pd.read_csv(out / "summary.csv", index_col="parameter")
    assert "calibration" in summary.loc["friction", "prior"]
    assert calibration.posterior.correlation is not None
    manifest = json.loads((out / "manifest.json").read_text())
    assert manifest["settings"]["prior_from"] == str(uninterrupted)
    assert str(uninterrupted / "posterior.nc") in manifest["inputs"]
