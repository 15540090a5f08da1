# SPDX-License-Identifier: MIT
"""Times are as sharp as their stamps allow, and a faulty table is named by row."""

import os
from pathlib import Path

import numpy as np
import pytest

from support.hostile_files import within_two_seconds
from support.written_photos import write_photo
from tracking.errors import TimesError
from tracking.images import exif_time, times_from_exif, times_from_interval, times_from_table


def test_exif_time_has_its_fraction(tmp_path):
    path = write_photo(tmp_path / "a.jpg", taken="2024:05:06 07:08:09", fraction="25")
    t, step = exif_time(path)
    assert t % 60 == pytest.approx(9.25)
    assert step == pytest.approx(0.01)
    assert exif_time(write_photo(tmp_path / "b.jpg")) is None


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
        ("photo,t_s\na.jpg,soon\n", "row 2 .*, t_s: 'soon'"),
        ("photo,t_s\na.jpg,nan\n", "found 'nan'; expected a finite number"),
    ],
)
def test_a_faulty_table_is_named_by_row(tmp_path, text, message):
    table = tmp_path / "times.csv"
    table.write_text(text)
    with pytest.raises(TimesError, match=message):
        times_from_table(table, [tmp_path / "a.jpg"])


@pytest.mark.parametrize(
    "content",
    [
        b"photo,t_s\n\xff,1\n",
        b"photo,t_s\n" + b"a" * 200_000 + b",1\n",
        b"photo,t_s\na.jpg,1,2,3\n",
    ],
    ids=["not UTF-8", "long", "surplus"],
)
def test_a_table_of_times_that_is_none_is_refused_in_one_line(content, tmp_path):
    table = tmp_path / "times.csv"
    table.write_bytes(content)
    with pytest.raises(TimesError) as raised:
        times_from_table(table, [Path("b.jpg")])
    assert "\n" not in str(raised.value)
    assert "row for" not in str(raised.value)


def test_a_fifo_named_as_a_table_of_times_does_not_hang(tmp_path):
    fifo = tmp_path / "times.csv"
    os.mkfifo(fifo)
    said = within_two_seconds(lambda: times_from_table(fifo, [Path("a.jpg")]))
    assert isinstance(said, TimesError)
