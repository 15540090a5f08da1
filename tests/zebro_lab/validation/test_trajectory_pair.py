# SPDX-License-Identifier: MIT
"""Two trajectories are matched by time or number, and their errors are those put in."""

import numpy as np
import pytest

from support.foreign_trajectories import drive, kitti, tum, written
from zebro_lab.files.errors import DataError
from zebro_lab.track.trajectory.file import read_trajectory
from zebro_lab.track.trajectory.request import Plane, TrajectoryRequest
from zebro_lab.validation.trajectory_pair import judge_pair

T, POSITION, ROTATION = drive()


@pytest.fixture
def judge(tmp_path):
    """Return a function that judges two texts, or files, of trajectories."""

    def read(text, name, **how):
        return read_trajectory(written(tmp_path / name, text), TrajectoryRequest(**how))

    def judged(reference, estimate, *, how=None, names=("a.txt", "b.txt"), **options):
        pair = [read(text, name, **(how or {})) for text, name in
                zip((reference, estimate), names, strict=True)]  # fmt: skip
        return judge_pair(*pair, **{"max_difference": 0.01, **options})

    return judged


TRUTH = tum(T, POSITION, ROTATION)


def test_a_shift_is_the_error_everywhere_and_gone_after_alignment(judge):
    judged = judge(TRUTH, tum(T, POSITION + np.array([0.3, 0.4, 0.0]), ROTATION))
    assert [row.where for row in judged.rows] == ["plane xy", "space"]
    for row in judged.rows:
        assert row.errors.ate.rms == pytest.approx(0.5, abs=1e-7)
        assert row.errors.aligned.rms == pytest.approx(0.0, abs=1e-7)
        assert row.errors.steps.position == pytest.approx(0.0, abs=1e-7)
    assert judged.notes[-1].startswith("60 of 60 reference and 60 estimated poses are matched")


@pytest.mark.parametrize(
    ("factor", "units"), [(1000, "mm and m"), (0.001, "mm and m"), (25.4, "mm and inches")]
)
def test_lengths_in_another_unit_are_asked_about(judge, factor, units):
    other = tum(T, factor * POSITION, ROTATION)
    first, *_ = judge(TRUTH, other).notes
    assert first.startswith("WARNING")
    assert units in first
    assert not any("WARNING" in note for note in judge(TRUTH, other, correct_scale=True).notes)


def test_a_scale_of_two_is_no_unit_and_is_corrected_where_asked(judge):
    twice = tum(T, 2 * POSITION, ROTATION)
    assert not any("WARNING" in note for note in judge(TRUTH, twice).notes)
    corrected = judge(TRUTH, twice, correct_scale=True).rows[1].errors
    assert corrected.scale == pytest.approx(0.5)
    assert corrected.ate.rms == pytest.approx(0.0, abs=1e-7)


def test_files_of_one_name_are_shown_with_their_folders(judge, tmp_path):
    (tmp_path / "other").mkdir()
    title = judge(TRUTH, TRUTH, names=("a.txt", "other/a.txt")).title
    assert title == f"other/a.txt against {tmp_path.name}/a.txt"
    assert judge(TRUTH, TRUTH, names=("a.txt", "a.txt")).title == "a.txt against itself"


def test_another_clock_is_refused_and_set_by_the_offset(judge):
    late = tum(T + 100, POSITION, ROTATION)
    with pytest.raises(DataError, match=r"b.txt: .*0\.01 s: 0; .*--time-offset"):
        judge(TRUTH, late)
    assert judge(TRUTH, late, time_offset=100).rows[0].errors.ate.rms < 1e-9


def test_poses_without_times_are_matched_by_number_or_not_at_all(judge):
    whole, xy = kitti(POSITION, ROTATION), {"plane": Plane.XY}
    assert judge(whole, whole, how=xy).rows[0].errors.ate.rms == 0.0
    with pytest.raises(DataError, match=r"b.txt: has 59 poses .* has 60; .*--times"):
        judge(whole, kitti(POSITION[1:], ROTATION[1:]), how=xy)
    with pytest.raises(DataError, match=r"a.txt: has no times, .*--times"):
        judge(whole, TRUTH, how=xy)
