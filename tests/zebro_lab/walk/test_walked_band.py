# SPDX-License-Identifier: MIT
"""The model that slips has a band around its path, and no other."""

import numpy as np
import pytest

from support.validated_walks import write_walk_data
from support.walk_requests import request
from support.watchers import Nobody
from zebro_lab.files.errors import SettingsError
from zebro_lab.walk.folder import read_walk_manifest
from zebro_lab.walk.path_band import read_draws
from zebro_lab.walk.predict_stage import predict
from zebro_lab.walk.request import BandRequest, ModelRequest, PredictRequest
from zebro_lab.walk.stage import walk


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


def test_a_band_needs_the_model_that_has_one(tmp_path):
    legs, _ = write_walk_data(tmp_path)
    request = PredictRequest(
        legs, tmp_path / "out", model=ModelRequest(model="no-slip", band=BandRequest(10))
    )
    with pytest.raises(SettingsError, match="dynamics"):
        predict(request, Nobody())
    with pytest.raises(SettingsError, match="no band"):
        BandRequest(1)
