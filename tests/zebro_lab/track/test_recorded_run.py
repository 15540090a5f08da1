# SPDX-License-Identifier: MIT
"""Photographs of a recorded run: `track --run`, `predict`, `validate`, and whose clock counts."""

import json
import shutil
from datetime import UTC, datetime, timedelta
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
import pytest

from rig.clock import ManualClock
from rig.device import Sample
from support.synthetic import with_time_stamp
from tracking.images import clock_picture
from zebro_lab.recording.devices import profile_text
from zebro_lab.recording.recorder import RunRecorder
from zebro_lab.runs.manifest import RunManifest, read_manifest

pytestmark = pytest.mark.usefixtures("blank_pictures")

WALK = Path(__file__).parents[3] / "datasets/walk-sim"
PROFILE = "zebro-100-serial"
BEGUN = datetime(2020, 6, 1, 12, 0, 0, tzinfo=UTC)  # of the walk, as the camera has it
SOME = 5  # photographs, two seconds apart
BENCH = ("--camera", WALK / "camera.toml", "--floor", WALK / "floor.toml", "--robot",
         WALK / "robot.toml")  # fmt: skip


@pytest.fixture(scope="module")
def recorded(tmp_path_factory) -> Path:
    """Return a folder with `photos/`, and `data/` with a run of the walk's own leg counts."""
    folder = tmp_path_factory.mktemp("recorded")
    (folder / "photos").mkdir()
    for number in range(SOME):
        shutil.copy(WALK / f"photos/simulated_{number:02d}.jpg", folder / "photos")
    legs = pd.read_csv(WALK / "legs.csv").query(f"t < {2 * SOME}")
    counts = legs[[f"count{leg}" for leg in range(1, 7)]].to_numpy()
    clock = ManualClock()
    recorder = RunRecorder(
        folder / "data", clock=clock,
        manifest=RunManifest(
            kind="walk", label="circle", source="sim:walk-sim", sources={"legs": "sim:walk-sim"}
        ),
        profiles={"legs": (PROFILE, profile_text(PROFILE))},
    )  # fmt: skip
    with recorder as run:
        run.write("legs", [
            Sample(t, t, n, tuple(row))
            for n, (t, row) in enumerate(zip(legs["t"].tolist(), counts.tolist(), strict=True))
        ])  # fmt: skip
        clock.sleep(2.0 * SOME)
        run.end("completed")
    return folder


@pytest.fixture
def lab(recorded, tmp_path, monkeypatch) -> Path:
    """Return a copy of it to work in, whose run is `run/`; no picture is drawn."""
    shutil.copytree(recorded / "photos", tmp_path / "photos")
    shutil.copytree(next((recorded / "data").iterdir()), tmp_path / "run")
    monkeypatch.setattr("zebro_lab.track.pictures.draw_track", lambda *_, **__: None)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def photographed_clock(lab: Path, *, ahead: timedelta) -> Path:
    """Photograph the computer's clock 5 s before the run, with a camera that is ahead of it."""
    begun = datetime.fromisoformat(read_manifest(lab / "run").start)
    shown = begun - timedelta(seconds=5)
    jpeg = cv2.imencode(".jpg", clock_picture(shown.timestamp(), module_px=8))[1].tobytes()
    file = lab / "photos" / "clock.jpg"
    file.write_bytes(with_time_stamp(jpeg, shown + ahead))
    return file


def test_a_recorded_run_is_tracked_predicted_and_validated_on_its_own_clock(lab, run_command):
    begun = datetime.fromisoformat(read_manifest(lab / "run").start)
    clock = photographed_clock(lab, ahead=BEGUN - begun)
    code, out, _ = run_command(
        "track", "photos", *BENCH, "--run", "run", "--clock", clock.resolve()
    )
    assert code == 0
    assert f"{SOME} of {SOME} photographs" in out
    assert "counted from the run's start" in out
    assert "WARNING" not in out
    track = pd.read_csv("run/track/track.csv")
    true = pd.read_csv(WALK / "photos.csv").iloc[:SOME]
    np.testing.assert_allclose(track["t_s"], true["t"], atol=0.06)  # the code is renewed at 10 Hz
    assert json.loads(Path("run/track/manifest.json").read_text())["source"] == "sim:photographs"
    code, _, _ = run_command(
        "predict", "run", "--slip", "coulomb:0.38", "--robot", WALK / "robot.toml"
    )
    assert code == 0
    code, out, _ = run_command("validate", "run")
    assert code == 0
    assert "SIMULATED: sim:photographs, sim:walk-sim" in out
    metrics = pd.read_csv("run/validation/metrics.csv")
    row = metrics[metrics["model"] == "prediction"].iloc[0]
    assert row["ate_m"] < 0.02


def test_untied_clocks_are_pointed_at_and_still_tracked(lab, run_command):
    code, out, _ = run_command("track", "photos", *BENCH, "--run", "run")
    assert code == 0
    assert "WARNING: time is counted from the first photograph" in out
    assert "--clock" in out
    assert pd.read_csv("run/track/track.csv")["t_s"].iloc[0] == 0


def test_a_moment_of_the_cameras_clock_is_the_runs_start(lab, run_command):
    code, out, err = run_command(
        "track", "photos", *BENCH, "--run", "run", "--start", "2020-06-01T12:00:01", "--json"
    )
    assert code == 0
    assert "WARNING: 1 of 5 photographs were taken before or after the run" in err
    found = json.loads(out)
    assert (found["command"], found["folder"], found["simulated"]) == ("track", "run/track", True)
    assert (found["photographs"], found["poses"], found["left_out"]) == (5, 5, {})
    assert found["duration_s"] == pytest.approx(8, abs=0.2)
    assert pd.read_csv("run/track/track.csv")["t_s"].iloc[0] == pytest.approx(-1, abs=0.1)


FAULTS = {
    "photographs of another day": (("--start", "2020-05-31T12:00:00"), "86400.0 to 86408.0 s"),
    "no run": (("--run", "photos"), "photos is not a run folder"),
    "file of the run": (("--run", "run/run.json"), "run/run.json is a file, not a folder; name a"),
    "no clock in the picture": (("--clock", "photos/simulated_00.jpg"), "no QR clock is decoded"),
}  # fmt: skip


@pytest.mark.parametrize(("arguments", "message"), FAULTS.values(), ids=FAULTS)
def test_times_that_cannot_be_are_one_line_and_write_nothing(arguments, message, lab, run_command):
    named = () if "--run" in arguments else ("--run", "run")
    code, out, err = run_command("track", "photos", *BENCH, *named, *arguments)
    assert (code, out) == (1, "")
    assert message in err
    assert err.count("\n") == 1
    assert not Path("run/track").exists()
