# SPDX-License-Identifier: MIT
"""Every exclusion of a run and its undoing is kept with its reason."""

import pytest

from support.written_runs import edit, make_run
from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.runs.exclusion import NO_REASON, exclude_run, past_reasons, take_in_again
from zebro_lab.runs.manifest import read_manifest


def test_every_reason_is_kept_in_order(tmp_path):
    folder = make_run(tmp_path)
    log = (folder / "log.mcap").read_bytes()
    exclude_run(folder, why=" belt slipped ")
    take_in_again(folder)
    exclude_run(folder, why="wrong disc")
    manifest = read_manifest(folder)
    assert manifest.excluded == {"why": "wrong disc"}
    assert [(each["did"], each["why"]) for each in manifest.exclusions] == [
        ("excluded", "belt slipped"), ("undone", NO_REASON), ("excluded", "wrong disc"),
    ]  # fmt: skip
    assert past_reasons(manifest) == ("belt slipped",)
    assert past_reasons(take_in_again(folder, why="no")) == ("wrong disc", "belt slipped")
    assert (folder / "log.mcap").read_bytes() == log


def test_an_exclusion_by_hand_or_an_earlier_version_enters_the_history(tmp_path):
    folder = make_run(tmp_path)
    edit(folder, excluded={"why": "by hand"})
    assert past_reasons(read_manifest(folder)) == ()
    manifest = exclude_run(folder, why="again")
    assert [each["why"] for each in manifest.exclusions] == ["by hand", "again"]
    assert past_reasons(manifest) == ("by hand",)


def test_no_reason_no_exclusion_and_no_run_are_refused(tmp_path):
    folder = make_run(tmp_path)
    with pytest.raises(DataError, match="state why the run is excluded"):
        exclude_run(folder, why="  ")
    with pytest.raises(DataError, match="there is nothing to undo"):
        take_in_again(folder)
    with pytest.raises(NotFound, match="is not a run folder"):
        exclude_run(tmp_path, why="x")
