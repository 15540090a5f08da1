# SPDX-License-Identifier: MIT
"""The picture of a run is written beside it, or where it is asked for."""

import pytest

from support.written_runs import make_run
from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.runs.exclusion import exclude_run
from zebro_lab.runs.plot_stage import plot_run


def test_a_picture_stands_beside_its_run_and_says_how_that_ended(tmp_path):
    run = make_run(tmp_path)
    drawn = plot_run(run)
    assert drawn.file == run.with_name(f"{run.name}.png")
    assert drawn.file.read_bytes().startswith(b"\x89PNG")
    exclude_run(run, why="belt came off")
    named = plot_run(run, out=tmp_path / "all.png")
    assert named.signals.state == "excluded: belt came off"


def test_what_cannot_be_drawn_is_named(tmp_path):
    run = make_run(tmp_path)
    with pytest.raises(SettingsError, match=r"ending in \.png"):
        plot_run(run, out=tmp_path / "picture.pdf")
    with pytest.raises(NotFound, match="no such folder"):
        plot_run(run, out=tmp_path / "no" / "picture.png")
    with pytest.raises(NotFound, match="not a run folder"):
        plot_run(tmp_path)
