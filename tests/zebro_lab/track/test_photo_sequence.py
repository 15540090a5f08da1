# SPDX-License-Identifier: MIT
"""Photographs come in order of time, from wherever their times are; frames of a video too."""

from datetime import UTC, datetime, timedelta
from pathlib import Path

import cv2
import numpy as np
import PIL.Image
import pytest

from support.synthetic.stamp import with_time_stamp
from tracking.camera import Camera
from tracking.images import clock_picture
from zebro_lab.files.errors import DataError, SettingsError
from zebro_lab.track.photo_sequence import calibrated_for, exposure_times, open_photos
from zebro_lab.track.request import TimeRequest

START = datetime(2020, 6, 1, 12, 0, 0, tzinfo=UTC)
STARTED = START.timestamp()


def photo(path: Path, seconds: float | None, pixels=None) -> None:
    grey = np.full((60, 80), 128, np.uint8) if pixels is None else pixels
    jpeg = cv2.imencode(".jpg", grey)[1].tobytes()
    taken = None if seconds is None else START + timedelta(seconds=seconds)
    path.write_bytes(jpeg if taken is None else with_time_stamp(jpeg, taken))


def names_of(sequence) -> tuple[str, ...]:
    return tuple(photo.name for photo in sequence.photos)


def test_photographs_are_ordered_by_their_own_clock(tmp_path):
    for name, seconds in (("a.jpg", 4.25), ("b.jpg", 0.5), ("c.jpg", 2.0)):
        photo(tmp_path / name, seconds)
    with open_photos(tmp_path, TimeRequest()) as sequence:
        assert names_of(sequence) == ("b.jpg", "c.jpg", "a.jpg")
        assert sequence.source == "sim:photographs"
        np.testing.assert_allclose(sequence.times.t - STARTED, [0.5, 2.0, 4.25], atol=1e-3)


def test_a_copy_of_a_photograph_counts_once_and_is_named(tmp_path):
    for number in range(3):
        photo(tmp_path / f"p{number}.jpg", 2.0 * number)
    (tmp_path / "p1 (1).jpg").write_bytes((tmp_path / "p1.jpg").read_bytes())
    with open_photos(tmp_path, TimeRequest()) as sequence:
        assert names_of(sequence) == ("p0.jpg", "p1.jpg", "p2.jpg")
        assert sequence.left_out["p1 (1).jpg"].startswith("a copy of p1.jpg, byte for byte")


@pytest.mark.parametrize("option", ["interval", "times"])
def test_times_in_milliseconds_are_told_by_the_photographs_own_times(option, tmp_path):
    for number in range(3):
        photo(tmp_path / f"p{number}.jpg", 2.0 * number)
    table = tmp_path / "times.csv"
    table.write_text("photo,t_s\np0.jpg,0\np1.jpg,2000\np2.jpg,4000\n")
    given = TimeRequest(interval=2000.0) if option == "interval" else TimeRequest(table=table)
    with (
        pytest.raises(SettingsError, match=rf"--{option}: found 2000 s .* are 2 s apart"),
        open_photos(tmp_path, given),
    ):
        pass


def test_an_interval_counts_in_the_order_a_person_counts(tmp_path):
    for number in (1, 2, 10):
        photo(tmp_path / f"p{number}.jpg", None)
    with open_photos(tmp_path, TimeRequest(interval=2.0)) as sequence:
        assert names_of(sequence) == ("p1.jpg", "p2.jpg", "p10.jpg")
        np.testing.assert_allclose(sequence.times.t, [0, 2, 4])


def test_a_photographed_code_ties_the_cameras_clock_to_the_computers(tmp_path):
    shown = STARTED - 3600.0 + 1.0
    photo(tmp_path / "clock.jpg", 1.0, clock_picture(shown, module_px=8))
    for number in range(2):
        photo(tmp_path / f"p{number}.jpg", 10.5 + 2.0 * number)
    with open_photos(tmp_path, TimeRequest(clock=tmp_path / "clock.jpg")) as sequence:
        assert names_of(sequence) == ("p0.jpg", "p1.jpg")
        assert "camera's clock +3599.9" in sequence.times.source
        np.testing.assert_allclose(sequence.times.t - STARTED, [-3589.5, -3587.5], atol=0.1)


@pytest.mark.parametrize("interval", [None, 2.0])
def test_the_photograph_of_the_clock_alone_is_no_walk(interval, tmp_path):
    clock = tmp_path / "clock.jpg"
    photo(clock, 1.0, clock_picture(STARTED, module_px=8))
    with (
        pytest.raises(DataError, match="no photograph but"),
        open_photos(tmp_path, TimeRequest(interval=interval, clock=clock)),
    ):
        pass


def test_frames_of_a_video_keep_their_own_times_and_leave_no_files(tmp_path):
    video = tmp_path / "walk.avi"
    writer = cv2.VideoWriter(str(video), cv2.VideoWriter.fourcc(*"MJPG"), 10.0, (80, 60))
    for level in range(20):
        writer.write(np.full((60, 80, 3), 10 * level, np.uint8))
    writer.release()
    with open_photos(video, TimeRequest(every=0.5)) as sequence:
        np.testing.assert_allclose(np.diff(sequence.times.t), 0.5, atol=5e-3)
        assert sequence.photos[1].name == "walk.avi#5"
        kept = [photo.path for photo in sequence.photos]
        assert all(path.is_file() for path in kept)
        assert sequence.is_video
        lens = Camera((160, 120), np.diag([100.0, 100.0, 1.0]), np.zeros(5))
        assert calibrated_for(lens, sequence).size == (80, 60)
    assert not any(path.exists() for path in kept)


def test_a_video_takes_no_times_of_others(tmp_path):
    (tmp_path / "walk.mp4").touch()
    with (
        pytest.raises(SettingsError, match="--interval: leave out for a video"),
        open_photos(tmp_path / "walk.mp4", TimeRequest(interval=2.0)),
    ):
        pass


@pytest.mark.parametrize("name", ["", "walk.jpg"])
def test_photographs_take_no_step_between_frames(tmp_path, name):
    (tmp_path / "walk.jpg").touch()
    with (
        pytest.raises(SettingsError, match="--every: leave out for photographs"),
        open_photos(tmp_path / name, TimeRequest(every=0.1)),
    ):
        pass


def test_exposures_need_an_interval():
    np.testing.assert_allclose(exposure_times(("a#1", "a#2"), TimeRequest(interval=3.0)).t, [0, 3])
    with pytest.raises(SettingsError, match="2 exposures"):
        exposure_times(("a#1", "a#2"), TimeRequest())


def test_a_lens_fits_photographs_of_its_shape_alone(tmp_path):
    camera = Camera(
        (160, 120), np.array([[200.0, 0, 79.5], [0, 200, 59.5], [0, 0, 1]]), np.zeros(5)
    )
    photo(tmp_path / "a.jpg", 0.0)
    with open_photos(tmp_path, TimeRequest()) as sequence:
        assert calibrated_for(camera, sequence).size == (80, 60)
    PIL.Image.new("RGB", (80, 45)).save(tmp_path / "a.jpg")
    with (
        open_photos(tmp_path, TimeRequest(interval=1.0)) as sequence,
        pytest.raises(DataError, match="80x45"),
    ):
        calibrated_for(camera, sequence)
