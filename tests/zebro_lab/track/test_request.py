# SPDX-License-Identifier: MIT
"""What is asked of a track agrees with itself."""

from dataclasses import replace
from pathlib import Path

import pytest

from zebro_lab.files.errors import SettingsError
from zebro_lab.track.request import TimeRequest, TrackRequest

ASKED = TrackRequest(Path("photos"), Path("camera.toml"), Path("floor.toml"))


def test_a_track_is_written_where_told_or_into_its_run():
    assert replace(ASKED, run=Path("run")).folder == Path("run/track")
    assert replace(ASKED, run=Path("run"), out=Path("out")).folder == Path("out")
    with pytest.raises(SettingsError, match="--run RUN"):
        _ = ASKED.folder


def test_every_file_that_is_named_is_an_input():
    asked = replace(ASKED, run=Path("run"), times=TimeRequest(table=Path("t.csv")))
    assert set(map(str, asked.inputs)) == {"photos", "camera.toml", "floor.toml", "t.csv", "run"}


def test_the_mean_height_is_as_uncertain_as_the_bounce_unless_said():
    bouncing = replace(ASKED, height_sd="8mm")
    assert bouncing.stated_mean_height_sd == bouncing.bounce_sd
    known = replace(bouncing, mean_height_sd="0.5mm")
    assert known.bounce_sd == pytest.approx(8e-3)
    assert known.stated_mean_height_sd == pytest.approx(5e-4)
    with pytest.raises(SettingsError, match=r"^--mean-height-sd: is 5 m, which is improbable"):
        replace(ASKED, mean_height_sd="5")


def test_lengths_and_frame_steps_are_those_of_the_help():
    assert ASKED.bounce_sd == 5e-3
    assert replace(ASKED, height_sd="2 cm").bounce_sd == pytest.approx(0.02)
    assert ASKED.stated_height is None
    assert replace(ASKED, body_height="60mm").stated_height == pytest.approx(0.06)
    with pytest.raises(SettingsError, match=r'^--body-height: is 60 m, which is .* as "60 mm"'):
        _ = replace(ASKED, body_height="60").stated_height
    with pytest.raises(SettingsError, match=r"^--height-sd: is 5 m, which is improbable"):
        _ = replace(ASKED, height_sd="5").bounce_sd
    assert TimeRequest().frame_step == 0.5
    assert TimeRequest(every=0.0).frame_step == 0.0


@pytest.mark.parametrize(
    ("text", "problem"), [("noon", "is not a time"), ("2020-06-01T12:00+02:00", "without a zone")]
)
def test_a_moment_is_that_of_a_clock_without_a_zone(text, problem, run_command):
    ended = run_command("track", "photos", "--camera", "c", "--floor", "f", "--start", text)
    assert ended.code == 2
    assert problem in " ".join(ended.err.split())
