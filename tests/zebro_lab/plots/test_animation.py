# SPDX-License-Identifier: MIT
"""The film of a walk."""

import numpy as np
import pytest
from matplotlib.animation import FFMpegWriter
from PIL import Image

from model.robot import Robot
from zebro_lab.plots import animation
from zebro_lab.plots.animation import FRAME_RATE, animate, frame_times


@pytest.fixture(scope="module")
def film(walked, tmp_path_factory):
    """Return a second of film as frames in grey, shape (n, height, width), and a frame's time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(FFMpegWriter, "isAvailable", classmethod(lambda _: False))
        file = animate(
            walked.part(slice(101)), Robot(), tmp_path_factory.mktemp("film"), title="A walk"
        )
    assert file.name == "animation.gif"
    with Image.open(file) as image:
        frames = []
        for number in range(image.n_frames):
            image.seek(number)
            frames.append(np.asarray(image.convert("L"), dtype=float))
        duration = image.info["duration"]
    return np.array(frames), duration


def test_film_runs_at_the_pace_of_life(film):
    frames, duration = film
    assert len(frames) == FRAME_RATE
    assert duration == 1000 / FRAME_RATE


def test_every_frame_shows_something_new(film):
    frames = film[0]
    assert (np.abs(np.diff(frames, axis=0)).max(axis=(1, 2)) > 50).all()


@pytest.mark.parametrize("duration", [0.01, 1.0, 20.0, 60.0, 1000.0])
def test_frames_span_the_walk_and_are_not_too_many(duration):
    t = np.linspace(3.0, 3.0 + duration, 200)
    frames, speed_up = frame_times(t)
    assert 1 <= len(frames) <= 400
    assert frames[0] == 3.0
    assert t[-1] - frames[-1] <= speed_up / FRAME_RATE + 1e-9
    assert speed_up == max(1.0, duration / 20)


def test_mp4_is_written_where_ffmpeg_is(monkeypatch):
    monkeypatch.setattr(FFMpegWriter, "isAvailable", classmethod(lambda _: True))
    writer, name = animation._writer()
    assert isinstance(writer, FFMpegWriter)
    assert name == "animation.mp4"
