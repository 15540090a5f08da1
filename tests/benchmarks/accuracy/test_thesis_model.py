# SPDX-License-Identifier: MIT
import re

from benchmarks.accuracy import thesis_model


def test_a_mended_right_turn_rolls_as_the_left_one(capsys):
    thesis_model.right_turns()
    rolls = [float(x) for x in re.findall(r"([+-]\d+\.\d+) degrees", capsys.readouterr().out)]
    left, printed, mended = rolls
    assert abs(abs(mended) - abs(left)) < abs(abs(printed) - abs(left))


def test_the_curvature_at_each_load_is_printed(capsys):
    thesis_model.curvature()
    assert len(re.findall(r" N: ", capsys.readouterr().out)) == 5
