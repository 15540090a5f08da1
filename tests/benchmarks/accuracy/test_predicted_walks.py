# SPDX-License-Identifier: MIT

from benchmarks.accuracy import predicted_walks
from benchmarks.accuracy.lab_walks import Bench


def test_the_tilt_of_a_walk_is_within_its_swing(one_walk, calibration, tmp_path, rows):
    assert list(predicted_walks.tilt(Bench(calibration, tmp_path / "scratch"))) == []
    [[name, error, swing]] = rows()
    assert name == predicted_walks.short(one_walk)
    for each, most in zip(error.rstrip("°").split(), swing.rstrip("°").split(), strict=True):
        assert float(each) <= float(most) + 0.01  # as printed; a tripod's roll is 0.00
