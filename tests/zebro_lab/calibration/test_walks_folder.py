# SPDX-License-Identifier: MIT
"""What walks said, stored beside a calibration, and what predictions make of it."""

import json
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pandas as pd
import pytest

from model.walk_fit.prior import ACROSS, LATERAL, NAMES, WrongLeg, all_cases
from support.walk_posteriors import (
    KNOCKED,
    OFF,
    SLIP_TOML,
    posterior_of,
    predict_log,
    stored,
    write_calibration,
    write_legs,
)
from support.watchers import Nobody
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.calibration.walks_folder import FOLDER, read_stored_walks
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.report.request import ReportRequest
from zebro_lab.report.stage import report
from zebro_lab.walk.folder import read_draws, read_walk, read_walk_manifest
from zebro_lab.walk.prediction_file import read_prediction
from zebro_lab.walk.request import BandRequest, ModelRequest, PredictRequest
from zebro_lab.walk.stage import predict
from zebro_lab.walk_fit.pictures import draw_walks


@pytest.fixture
def legs(tmp_path):
    """Return two leg logs."""
    return write_legs(tmp_path)


@pytest.fixture
def calibration(tmp_path):
    """Return a calibration without walks."""
    return write_calibration(tmp_path)


def test_a_posterior_comes_back_as_it_was(calibration, legs):
    posterior = posterior_of(KNOCKED, steering=0.02)
    found = stored(calibration, legs, posterior).posterior
    for name in ("values", "case", "weight", "best"):
        np.testing.assert_array_equal(getattr(found, name), getattr(posterior, name))
    assert (found.best_case, found.walks, found.cases) == (KNOCKED, ("one", "two"), all_cases(2))
    assert found.prior == posterior.prior
    assert found.misfit == posterior.misfit
    assert found.contractions() == posterior.contractions()


def test_the_folder_tells_a_person_and_a_program_the_same(calibration, legs):
    import tomllib

    stored(calibration, legs, posterior_of(WrongLeg(2)))
    folder = calibration / FOLDER
    told = tomllib.loads((folder / "walks.toml").read_text())
    assert [each["name"] for each in told["parameter"]] == list(NAMES)
    assert told["case"][0]["leg"] == 3
    assert told["case"][0]["offset"] == pytest.approx(OFF)
    manifest = json.loads((folder / "manifest.json").read_text())
    assert manifest["source"] == "sim:test"
    assert set(manifest["outputs"]) == {p.name for p in folder.iterdir()} - {"manifest.json"}
    assert str(calibration / "slip.toml") in manifest["inputs"]


def test_a_calibration_made_anew_does_not_keep_what_walks_said_of_the_old_one(calibration, legs):
    stored(calibration, legs, posterior_of(None))
    slip = calibration / "slip.toml"
    slip.write_text(SLIP_TOML.replace("20.0", "21.0"))
    with pytest.raises(DataError, match="another slip law"):
        parse_slip(str(calibration))
    assert parse_slip(str(calibration), with_walks=False).walks is None


@pytest.mark.parametrize("file", ["walks.toml", "draws.npz"])
def test_damaged_files_are_named(calibration, legs, file):
    stored(calibration, legs, posterior_of(None))
    (calibration / FOLDER / file).write_bytes(b"no such thing")
    with pytest.raises(DataError, match="fit the walks again"):
        parse_slip(str(calibration))


def test_a_calibration_without_walks_has_none(calibration):
    assert parse_slip(str(calibration)).walks is None


def test_steering_that_walks_found_turns_the_predicted_path(calibration, legs, tmp_path):
    plain = predict_log(tmp_path, legs[0], str(calibration), name="plain")
    stored(calibration, legs, posterior_of(None, steering=0.1))
    # Another log than those that were fitted, of the same gait.
    other = tmp_path / "other.csv"
    pd.read_csv(legs[0]).iloc[:-1].to_csv(other, index=False)
    informed = predict_log(tmp_path, other, str(calibration))
    turned = informed.path.yaw[-1] - plain.path.yaw[-1]
    assert turned == pytest.approx(0.1 * plain.path.length, rel=0.03)
    assert "legs and floor are those fitted to one, two" in " ".join(informed.notes)


def test_a_band_is_drawn_from_what_walks_said(calibration, legs, tmp_path):
    stored(calibration, legs, posterior_of(WrongLeg(2)))
    predict_log(tmp_path, legs[0], str(calibration), draws=12)
    draws = read_draws(tmp_path / "prediction")
    settings = read_walk_manifest(tmp_path / "prediction")["settings"]
    assert settings["walks"]["leg_offset"][2] == pytest.approx(OFF)
    single = read_walk(tmp_path / "prediction")
    ahead = np.quantile(draws.position[:, -1, 0], [0.0, 1.0])
    assert ahead[0] - 0.01 < single.position[-1, 0] < ahead[1] + 0.01


def test_offsets_that_walks_told_are_not_asked_for_again(calibration, legs, tmp_path):
    stored(calibration, legs, posterior_of(None))
    request = PredictRequest(
        legs[0], tmp_path / "out",
        model=ModelRequest(slip=str(calibration), band=BandRequest(5, offset_sd_deg=1.0)),
    )  # fmt: skip
    with pytest.raises(SettingsError, match="offset-sd-deg"):
        predict(request, Nobody())


def test_lateral_traction_of_a_band_is_what_walks_told(calibration, legs, tmp_path):
    stored(calibration, legs, posterior_of(None))
    predict_log(tmp_path, legs[0], str(calibration), draws=3)
    settings = read_walk_manifest(tmp_path / "prediction")["settings"]
    assert settings["band"]["anisotropy"] is None
    assert settings["walks"]["lateral_grip"] == 1.0
    assert "as walks inform them" in " ".join(read_prediction(tmp_path / "prediction").notes)


def test_walks_of_the_schema_before_are_read_as_fitted_alike_in_all_directions(
    calibration, legs, tmp_path
):
    sure = posterior_of(WrongLeg(2))
    stored(calibration, legs, sure)
    folder = calibration / FOLDER
    with np.load(folder / "draws.npz") as arrays:
        older = {name: arrays[name] for name in arrays}
    for name in ("values", "best"):
        older[name] = np.delete(older[name], ACROSS, axis=-1)
    np.savez(folder / "draws.npz", **older)
    text = (folder / "walks.toml").read_text()
    lines = [line for line in text.splitlines() if not line.startswith("lateral_sd")]
    (folder / "walks.toml").write_text("\n".join(lines).replace("schema = 3", "schema = 2"))
    found = read_stored_walks(calibration / "slip.toml").posterior
    np.testing.assert_array_equal(found.values, sure.values)
    assert found.prior.lateral_sd == 0.0
    assert not any(each.informed for each in found.contractions() if each.name in LATERAL)
    np.testing.assert_array_equal(found.draw(9, rng=np.random.default_rng(1)).lateral_grip, 1.0)
    predict_log(tmp_path, legs[0], str(calibration), draws=3)
    settings = read_walk_manifest(tmp_path / "prediction")["settings"]
    assert settings["band"]["anisotropy"] == 1.0


def test_a_model_without_slip_takes_nothing_from_walks(calibration, legs, tmp_path):
    stored(calibration, legs, posterior_of(None, steering=0.1))
    done = predict_log(tmp_path, legs[0], str(calibration), model="no-slip")
    assert done.informed is None


def test_a_report_tells_what_walks_said_and_what_they_did_not(calibration, legs, tmp_path):
    posterior = posterior_of(WrongLeg(2))
    stored(
        calibration, legs, posterior,
        draw=lambda draft: draw_walks(draft, posterior, (), simulated=True),
    )  # fmt: skip
    run = tmp_path / "run"
    run.mkdir()
    predict_log(run, legs[0], str(calibration))
    page = tmp_path / "report.html"
    report(ReportRequest(run, calibration, page), made=datetime(2026, 1, 2, tzinfo=UTC))
    text = page.read_text()
    assert "Legs and floor estimated from tracked walks" in text
    assert "Mounted wrong: leg 3" in text
    assert "SIMULATED: sim:rig-sweep, sim:test" in text
    assert text.count("data:image/webp") >= 1
    told = read_stored_walks(calibration / "slip.toml").posterior.contractions()
    silent = next(each.name for each in told if not each.informed)
    assert silent.replace("_", " ") in text


def test_too_few_effective_draws_are_a_doubt_that_predictions_and_their_readers_repeat(
    calibration, legs, tmp_path
):
    sure = posterior_of(None)
    weight = np.r_[0.5, 0.5, np.zeros(len(sure.weight) - 2)]
    assert stored(calibration, legs, sure).doubts == ()
    (doubt,) = stored(calibration, legs, replace(sure, weight=weight)).doubts
    assert f"walks in {calibration / FOLDER} is not reliable: 2 effective draws, expected" in doubt
    assert doubt.startswith("WARNING: ")
    walked = predict_log(tmp_path, legs[0], str(calibration))
    assert doubt in walked.notes
    assert read_walk_manifest(tmp_path / "prediction")["settings"]["doubts"] == [doubt]
    assert doubt in read_prediction(tmp_path / "prediction").notes
    unused = predict_log(tmp_path, legs[0], str(calibration), name="x", model="no-slip")
    assert doubt not in unused.notes
