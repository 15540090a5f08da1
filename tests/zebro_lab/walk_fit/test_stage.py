# SPDX-License-Identifier: MIT
"""Walks are fitted beside the calibration that they need, and written with their sources."""

import json

import numpy as np
import pytest

from support.drawn_figures import figures_saved
from support.judged_walks import judged_walk
from support.tracked_walks import write_walk
from support.walk_posteriors import posterior_of, write_calibration
from support.watchers import Nobody
from zebro_lab.calibration.request import CalibrationRequest
from zebro_lab.calibration.walks_folder import read_stored_walks
from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.validation.shared_clock import LARGEST_OFFSET, shifted
from zebro_lab.walk_fit import stage
from zebro_lab.walk_fit.request import WalksRequest
from zebro_lab.walk_fit.stage import calibrate_walks, require_walks


def test_walks_need_a_calibration(tmp_path):
    folder, none = write_walk(tmp_path / "walk"), CalibrationRequest(out=tmp_path / "none")
    with pytest.raises(NotFound, match="finished calibration"):
        calibrate_walks(WalksRequest((folder,)), none, Nobody())
    with pytest.raises(SettingsError, match="--walks"):
        calibrate_walks(WalksRequest(), none, Nobody())


@pytest.mark.parametrize("estimate", [False, True])
def test_clocks_are_looked_at_before_a_fit_and_only_large_offsets_refused(
    estimate, tmp_path, monkeypatch
):
    asked = []

    def clock(_, *, largest=None):
        asked.append(largest)
        return lambda track, *_: shifted(track, -30.0) if estimate else track

    for name in ("checked_clock", "estimated_clock_of"):
        monkeypatch.setattr(stage, name, clock)
    walk = write_walk(tmp_path / "walk", late=30.0 * estimate)
    options = CalibrationRequest(out=tmp_path / "new")
    require_walks(WalksRequest((walk,), estimate_offset=estimate), options, Nobody())
    assert asked == [None if estimate else 2 * LARGEST_OFFSET]
    assert not (tmp_path / "new").exists()


def test_the_fit_is_written_beside_the_calibration_with_what_it_was_made_of(tmp_path, monkeypatch):
    posterior = posterior_of(None)

    class Fit:
        def __init__(self, progress):
            progress(0.5)
            self.posterior = posterior

    run, priors = judged_walk("one", off=0.02), []
    monkeypatch.setattr(
        stage, "fit_walks_on_file",
        lambda *_, prior, progress, **__: priors.append(prior) or Fit(progress),
    )  # fmt: skip
    monkeypatch.setattr(stage, "judge_left_out", lambda *_, **__: (run,))
    saved = figures_saved(monkeypatch)
    calibration = write_calibration(tmp_path)
    walks = (write_walk(tmp_path / "one"), write_walk(tmp_path / "two", begin=7.0, every=1.5))
    watcher = Nobody()
    done = calibrate_walks(
        WalksRequest(walks),
        CalibrationRequest(out=calibration, seed=3),
        watcher,
    )
    assert done.folder == calibration / "walks"
    assert done.source == "sim:rig-sweep, unknown"
    assert ("fitting walks", 0.35) in watcher.seen
    assert [what for what, _ in watcher.seen][-1] == "drawing"
    assert any(note.startswith("one: ") for note in done.notes)
    stored = read_stored_walks(calibration / "slip.toml")
    np.testing.assert_array_equal(stored.posterior.values, posterior.values)
    manifest = json.loads((done.folder / "manifest.json").read_text())
    assert manifest["settings"]["seed"] == 3
    assert manifest["settings"]["anisotropy"] == 1.3
    assert priors[0].lateral_sd == pytest.approx(np.log(1.3))
    read = [calibration / "slip.toml", *(walk / "legs.csv" for walk in walks)]
    assert {str(file) for file in read} <= set(manifest["inputs"])
    assert set(saved) == {"walk_parameters.png", "left_out.one.png"}
