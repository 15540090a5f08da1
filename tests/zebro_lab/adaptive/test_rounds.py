# SPDX-License-Identifier: MIT
import json
import math

import pytest

from zebro_lab.adaptive.rounds import (
    ROUNDS_FILE,
    Round,
    begin_or_resume,
    folder_of,
    settings_of,
    write_rounds,
)
from zebro_lab.adaptive.wanted import parse_wanted
from zebro_lab.files.errors import AlreadyExists, DataError, SettingsError

WANTED = [parse_wanted("friction=0.01"), parse_wanted("walk:run")]
SETTINGS = settings_of(WANTED, 600.0, "plan")
ROUNDS = [Round(1, 115.0, 16, 1, {"friction": 0.02, "walk:run": math.nan})]


def test_rounds_that_were_written_are_resumed_as_they_were(tmp_path):
    assert begin_or_resume(tmp_path, SETTINGS, resume=False) == []
    write_rounds(tmp_path, SETTINGS, ROUNDS)
    (found,) = begin_or_resume(tmp_path, SETTINGS, resume=True)
    assert (found.number, found.seconds, found.points, found.refused) == (1, 115.0, 16, 1)
    assert found.half_widths["friction"] == 0.02
    assert math.isnan(found.half_widths["walk:run"])


def test_an_experiment_is_not_begun_twice_without_being_asked_to(tmp_path):
    begin_or_resume(tmp_path, SETTINGS, resume=False)
    with pytest.raises(AlreadyExists, match="--resume"):
        begin_or_resume(tmp_path, SETTINGS, resume=False)


@pytest.mark.parametrize(
    "other",
    [
        settings_of([parse_wanted("friction=0.02")], 600.0, "plan"),
        settings_of(WANTED, 700.0, "plan"),
        settings_of(WANTED, 600.0, "another plan"),
    ],
)
def test_another_experiment_is_not_gone_on_with(tmp_path, other):
    begin_or_resume(tmp_path, SETTINGS, resume=False)
    with pytest.raises(SettingsError, match="give the same command"):
        begin_or_resume(tmp_path, other, resume=True)


@pytest.mark.parametrize("rounds", [None, 3, [3], [{"number": 1}], {"a": 1}])
def test_a_damaged_file_is_said(tmp_path, rounds):
    begin_or_resume(tmp_path, SETTINGS, resume=False)
    (tmp_path / ROUNDS_FILE).write_text(json.dumps({"settings": SETTINGS, "rounds": rounds}))
    with pytest.raises(DataError, match=ROUNDS_FILE):
        begin_or_resume(tmp_path, SETTINGS, resume=True)


def test_rounds_whose_file_is_missing_are_not_begun_anew(tmp_path):
    folder_of(tmp_path, 1).mkdir()
    with pytest.raises(AlreadyExists, match=f"{ROUNDS_FILE} is missing"):
        begin_or_resume(tmp_path, SETTINGS, resume=True)
