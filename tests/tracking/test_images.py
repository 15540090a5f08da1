# SPDX-License-Identifier: MIT
"""Photographs are read or named with what is wrong; times are as sharp as their stamps allow."""

import cv2
import numpy as np
import PIL.Image
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tracking.errors import PhotoError, TimesError, TrackingError
from tracking.images import (
    clock_offset,
    clock_picture,
    clock_text,
    exif_time,
    find_photos,
    fit_interval,
    read_clock,
    read_pixels,
    times_from_exif,
    times_from_interval,
    times_from_table,
    video_frames,
)


def write_photo(path, pixels=None, *, taken=None, fraction=None, orientation=None):
    picture = PIL.Image.fromarray(np.full((48, 64, 3), 90, np.uint8) if pixels is None else pixels)
    exif = PIL.Image.Exif()
    if taken is not None:
        details = {0x9003: taken}
        if fraction is not None:
            details[0x9291] = fraction
        exif[0x8769] = details
    if orientation is not None:
        exif[0x0112] = orientation
    picture.save(path, exif=exif, quality=95)
    return path


def test_photographs_are_counted_as_people_count(tmp_path):
    for name in ("p10.jpg", "p2.jpg", "p1.JPG", "notes.txt"):
        write_photo(tmp_path / name) if name != "notes.txt" else (tmp_path / name).write_text("")
    assert [path.name for path in find_photos(tmp_path)] == ["p1.JPG", "p2.jpg", "p10.jpg"]


def test_a_folder_without_photographs_is_named(tmp_path):
    with pytest.raises(TrackingError, match="holds no photographs"):
        find_photos(tmp_path)
    with pytest.raises(TrackingError, match="not a folder"):
        find_photos(tmp_path / "missing")


def test_pixels_come_as_bgr_and_upright(tmp_path):
    pixels = np.zeros((48, 64, 3), np.uint8)
    pixels[:, :, 0] = 200
    found = read_pixels(write_photo(tmp_path / "a.png", pixels))
    assert found[5, 5].tolist() == [0, 0, 200]
    turned = read_pixels(write_photo(tmp_path / "b.jpg", pixels, orientation=6))
    assert turned.shape == (64, 48, 3)


def break_file(path, kind):
    write_photo(path, np.random.default_rng(0).integers(0, 255, (300, 400, 3), np.uint8))
    if kind == "empty":
        path.write_bytes(b"")
    elif kind == "cut":
        path.write_bytes(path.read_bytes()[:9000])
    elif kind == "text":
        path.write_text("not a picture at all, really")
    elif kind == "heic":
        path.write_bytes(b"\0\0\0\x18ftypheic\0\0\0\0mif1heic")


@pytest.mark.parametrize(
    ("kind", "message"),
    [("empty", "0 bytes"), ("cut", "cut short"), ("text", "not a picture"), ("heic", "HEIC")],
)
def test_a_bad_file_is_named_with_its_fault(tmp_path, kind, message):
    path = tmp_path / "p7.jpg"
    break_file(path, kind)
    with pytest.raises(PhotoError, match=rf"p7\.jpg: .*{message}"):
        read_pixels(path)


@pytest.mark.parametrize("side", [11_000, 14_200])
def test_a_picture_of_hundreds_of_megapixels_is_refused_unread(tmp_path, side):
    PIL.Image.new("1", (side, side)).save(tmp_path / "huge.png")
    with pytest.raises(PhotoError, match=r"^huge\.png: [^(]*megapixels; at most 80 are read"):
        read_pixels(tmp_path / "huge.png")


def test_a_photograph_of_another_size_is_named(tmp_path):
    with pytest.raises(PhotoError, match="64x48 px; expected 1280x960"):
        read_pixels(write_photo(tmp_path / "a.jpg"), size=(1280, 960))


def test_exif_time_has_its_fraction(tmp_path):
    path = write_photo(tmp_path / "a.jpg", taken="2024:05:06 07:08:09", fraction="25")
    t, step = exif_time(path)
    assert t % 60 == pytest.approx(9.25)
    assert step == pytest.approx(0.01)
    assert exif_time(write_photo(tmp_path / "b.jpg")) is None


@given(
    start=st.floats(0, 10), interval=st.floats(2.2, 8.0), count=st.integers(12, 60),
    dropped=st.integers(2, 9),
)  # fmt: skip
@example(start=0.0067150, interval=2.9998184, count=48, dropped=7)  # 0.66 s off: a triangle
def test_whole_seconds_and_a_regular_interval_never_lose_the_second(
    start, interval, count, dropped
):
    numbers = np.delete(np.arange(count), dropped)
    truth = start + interval * numbers
    fit = fit_interval(np.floor(truth))
    assert fit is not None
    assert fit.interval == pytest.approx(interval, abs=1.5 / count)
    # The stamps leave each time a second at most, and the centroid of a convex polygon lies within
    # two thirds of its width from either edge.
    assert np.abs(fit.t - truth).max() <= 2 / 3 + 1e-9
    assert fit.sd.max() < 0.3


def test_fitted_times_are_sharper_than_stamps_and_cover():
    rng, z, sds = np.random.default_rng(0), [], []
    for _ in range(200):
        truth = rng.uniform(0, 1) + rng.uniform(1.8, 2.6) * np.arange(40)
        fit = fit_interval(np.floor(truth))
        z.append((fit.t - truth) / fit.sd)
        sds.append(fit.sd)
    assert np.mean(sds) < 0.05
    assert 0.8 < np.sqrt(np.mean(np.square(z))) < 1.2


def test_missing_exposures_are_counted():
    truth = 0.3 + 2.37 * np.delete(np.arange(30), [7, 8])
    fit = fit_interval(np.floor(truth))
    assert fit.missing == (7, 8)


def test_an_irregular_hand_gives_no_interval():
    stamps = np.cumsum(np.random.default_rng(1).integers(2, 30, 25))
    assert fit_interval(stamps) is None


def test_exif_of_a_folder_with_and_without_fractions(tmp_path):
    truth = 3.3 + 2.25 * np.arange(12)
    whole, fine = [], []
    for index, t in enumerate(truth):
        text = f"2024:05:06 07:08:{int(t):02d}"
        whole.append(write_photo(tmp_path / f"w{index}.jpg", taken=text))
        fine.append(
            write_photo(tmp_path / f"f{index}.jpg", taken=text, fraction=f"{t % 1:.2f}"[2:])
        )
    for paths, sd in ((whole, 0.2), (fine, 0.01)):
        times = times_from_exif(paths)
        difference = times.t - truth
        assert np.ptp(difference) < 4 * sd
        assert times.sd.max() < sd


def test_no_times_at_all_says_what_to_give(tmp_path):
    paths = [write_photo(tmp_path / f"{index}.jpg") for index in range(3)]
    with pytest.raises(TimesError, match=r"0\.jpg and 2 others.*--interval"):
        times_from_exif(paths)


def test_an_interval_gives_its_beat():
    times = times_from_interval(4, 2.0, jitter=0.01)
    np.testing.assert_allclose(times.t, [0, 2, 4, 6])
    with pytest.raises(TimesError, match="0 s"):
        times_from_interval(4, 0.0)


def test_a_table_gives_times_by_name(tmp_path):
    table = tmp_path / "times.csv"
    table.write_text("photo,t_s,t_sigma\nb.jpg,4.5,0.1\na.jpg,2.5,\n")
    times = times_from_table(table, [tmp_path / "a.jpg", tmp_path / "b.jpg"])
    np.testing.assert_allclose(times.t, [2.5, 4.5])
    np.testing.assert_allclose(times.sd, [0.0, 0.1])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("photo,t_s\nb.jpg,1\n", "no row for a.jpg"),
        ("name,time\na.jpg,1\n", "expected columns photo, t_s"),
        ("photo,t_s\na.jpg,soon\n", "row 2, t_s: 'soon'"),
        ("photo,t_s\na.jpg,nan\n", "'nan' is not a time"),
    ],
)
def test_a_faulty_table_is_named_by_row(tmp_path, text, message):
    table = tmp_path / "times.csv"
    table.write_text(text)
    with pytest.raises(TimesError, match=message):
        times_from_table(table, [tmp_path / "a.jpg"])


def test_the_clock_is_read_from_its_own_picture_and_ties_exif(tmp_path):
    picture = cv2.resize(clock_picture(1_714_979_289.123), None, fx=0.8, fy=0.8)
    assert read_clock(picture) == pytest.approx(1_714_979_289.123)
    assert clock_text(2.0).endswith(":2.000")
    assert read_clock(np.full((300, 300), 200, np.uint8)) is None
    # 2024-05-06 07:08:09 is 1714979289: the phone is 1.5 s ahead of the code it photographs.
    rgb = np.repeat(clock_picture(1_714_979_287.75 - 0.05)[:, :, None], 3, axis=2)
    path = write_photo(tmp_path / "c.png", rgb, taken="2024:05:06 07:08:09", fraction="250")
    offset = clock_offset(path)
    assert offset.seconds == pytest.approx(1.5, abs=1e-3)
    with pytest.raises(PhotoError, match="QR clock"):
        clock_offset(write_photo(tmp_path / "d.jpg"))


def write_video(path, count, rate=10.0):
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), rate, (64, 48))
    for index in range(count):
        writer.write(np.full((48, 64, 3), 10 * index, np.uint8))
    writer.release()
    return path


def test_frames_come_with_their_own_times(tmp_path):
    frames = list(video_frames(write_video(tmp_path / "a.avi", 12)))
    np.testing.assert_allclose([frame.t for frame in frames], 0.1 * np.arange(12), atol=1e-3)
    assert frames[3].name == "a.avi#3"
    thinned = list(video_frames(tmp_path / "a.avi", every=0.3))
    np.testing.assert_allclose([frame.t for frame in thinned], [0, 0.3, 0.6, 0.9], atol=1e-3)
    assert thinned[1].pixels.mean() == pytest.approx(30, abs=3)


@pytest.mark.parametrize("kind", ["empty", "text", "no frames"])
def test_a_video_without_frames_is_named(tmp_path, kind, capfd):
    path = tmp_path / "v.avi"
    if kind == "no frames":
        write_video(path, 0)
    else:
        path.write_text("" if kind == "empty" else "hello")
    with pytest.raises(PhotoError, match=r"v\.avi"):
        list(video_frames(path))
