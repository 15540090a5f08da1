# SPDX-License-Identifier: MIT
"""From a gait or a leg log to a finished walk folder."""

from dataclasses import replace

import numpy as np
import pytest

from model.errors import DomainError
from model.walk_models import MODELS
from support.walk_requests import request
from support.watchers import Impatient, Nobody
from zebro_lab.files.errors import SettingsError
from zebro_lab.walk.folder import PICTURES, read_draws, read_walk, read_walk_manifest
from zebro_lab.walk.output import WalkStopped
from zebro_lab.walk.output_request import BandRequest, PictureRequest
from zebro_lab.walk.stage import walk
from zebro_lab.walk.summary import summarise

pytestmark = pytest.mark.usefixtures("blank_pictures")


def test_a_gait_has_a_band_around_its_path(tmp_path):
    asked = request(tmp_path / "out", dt=0.005, band=BandRequest(12, offset_sd_deg=1.0))
    walked = walk(asked, Nobody())
    draws = read_draws(tmp_path / "out")
    assert draws.position.shape[0] == 12
    end, spread = draws.position[:, -1], draws.position[:, -1].std(axis=0)
    assert np.all(np.abs(end.mean(axis=0) - walked.path.position[-1, :2]) < 3 * spread)
    assert np.all(spread > 1e-4)
    assert read_walk_manifest(tmp_path / "out")["settings"]["band"]["draws"] == 12


def test_a_gait_walked_by_a_model_without_a_band_is_refused_and_leaves_nothing(tmp_path):
    asked = request(tmp_path / "out", model="no-slip", band=BandRequest(12))
    with pytest.raises(SettingsError, match="dynamics"):
        walk(asked, Nobody())
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("model", MODELS)
def test_every_model_walks_and_its_path_is_read_back(model, tmp_path):
    walked = walk(request(tmp_path / "out", model=model), Nobody())
    path = read_walk(tmp_path / "out")
    np.testing.assert_allclose(path.position, walked.path.position, rtol=1e-9, atol=1e-12)
    manifest = read_walk_manifest(tmp_path / "out")
    assert manifest["source"] == f"sim:{model}"
    assert manifest["settings"]["gait"] == {"name": "tripod", "steering": 1.3, "direction": "left"}
    assert manifest["settings"]["dt"] == walked.dt == MODELS[model].dt
    assert summarise(path).radius > 0
    assert (", slip " in walked.title) == MODELS[model].slips


def test_pictures_come_when_asked_for_and_say_simulated(tmp_path):
    watcher = Nobody()
    walk(request(tmp_path / "out", pictures=PictureRequest(figures=True)), watcher)
    names = {f"{name}.png" for name in (*PICTURES, "stances")}
    assert {p.name for p in (tmp_path / "out").iterdir()} == names | {"path.csv", "manifest.json"}
    assert [what for what, _ in watcher.seen] == ["walking", "drawing"]


def test_film_comes_when_asked_for(tmp_path):
    watcher = Nobody()
    walk(
        replace(request(tmp_path / "out", pictures=PictureRequest(animate=True)), duration=0.2),
        watcher,
    )
    assert len(list((tmp_path / "out").glob("animation.*"))) == 1
    assert watcher.seen[-1] == ("filming", 1.0)


def test_stopped_walk_leaves_nothing_behind(tmp_path):
    with pytest.raises(WalkStopped, match="nothing was written"):
        walk(request(tmp_path / "out", pictures=PictureRequest(figures=True)), Impatient())
    assert list(tmp_path.iterdir()) == []


def test_model_that_slips_needs_a_law_and_one_that_does_not_says_so(tmp_path):
    with pytest.raises(SettingsError, match="--slip: missing"):
        walk(request(tmp_path / "out", slip=None), Nobody())
    walked = walk(request(tmp_path / "out", model="no-slip"), Nobody())
    assert "--slip coulomb:0.4 is not used" in walked.notes[0]


@pytest.mark.parametrize("bad", [{"dt": 0.0}, {"dt": -1.0}, {"dt": float("nan")}, {"dt": 100.0}])
def test_step_longer_than_the_walk_is_refused(bad, tmp_path):
    with pytest.raises((SettingsError, DomainError)):
        walk(request(tmp_path / "out", **bad), Nobody())
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("model", MODELS)
def test_a_walk_of_more_steps_than_memory_holds_is_refused(model, tmp_path):
    endless = replace(request(tmp_path / "out", model=model), duration=1e12)
    with pytest.raises(SettingsError, match=r"1e\+12 s in steps of .* at most 500,000 are walked"):
        walk(endless, Nobody())
    with pytest.raises(SettingsError, match=r"2e-06 s is 2e\+06 steps; .* lengthen --dt"):
        walk(request(tmp_path / "out", model=model, dt=2e-6), Nobody())
    assert not (tmp_path / "out").exists()
