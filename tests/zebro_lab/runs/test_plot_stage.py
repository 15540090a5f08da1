# SPDX-License-Identifier: MIT
"""The picture of a run is written beside it, or where it is asked for."""

import pytest

from support.written_runs import make_run
from zebro_lab.files.errors import AlreadyExists, NotFound, SettingsError
from zebro_lab.runs.exclusion import exclude_run
from zebro_lab.runs.plot_stage import plot_run
from zebro_lab.terminal.picture_options import Window


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
    with pytest.raises(SettingsError, match=r"picture\.gif.*ends in \.png, \.svg, \.pdf"):
        plot_run(run, out=tmp_path / "picture.gif")
    with pytest.raises(SettingsError, match=r"picture\.png.*--format pdf.*same format"):
        plot_run(run, out=tmp_path / "picture.png", form="pdf")
    with pytest.raises(SettingsError, match=r"--window.*900:901 s.*time of the run, 0\."):
        plot_run(run, window=Window(900.0, 901.0))
    with pytest.raises(NotFound, match="no such folder"):
        plot_run(run, out=tmp_path / "no" / "picture.png")
    with pytest.raises(NotFound, match="not a run folder"):
        plot_run(tmp_path)


@pytest.mark.parametrize("form", ["svg", "pdf"])
def test_a_picture_of_each_format_is_replaced_by_its_own_command_alone(form, tmp_path):
    run = make_run(tmp_path)
    drawn = plot_run(run, form=form)
    assert drawn.file == run.with_name(f"{run.name}.{form}")
    first = drawn.file.read_bytes()
    assert plot_run(run, out=drawn.file).file.read_bytes() == first
    drawn.file.write_bytes(first.replace(b"drawn by zebro-lab plot", b"drawn by somebody else"))
    with pytest.raises(AlreadyExists, match="was not made by plot"):
        plot_run(run, form=form)


def test_a_window_cuts_every_stream(tmp_path):
    run = make_run(tmp_path)
    whole = plot_run(run).signals
    begin, end = whole.panels[0].t[[3, 8]]
    for panel in plot_run(run, window=Window(float(begin), float(end))).signals.panels:
        assert begin <= panel.t[0] <= panel.t[-1] <= end
        assert all(len(line) == len(panel.t) for line in panel.lines.values())


def test_times_to_mark_lie_in_what_is_drawn(tmp_path):
    run = make_run(tmp_path)
    t = plot_run(run).signals.panels[0].t
    window = Window(float(t[3]), float(t[8]))
    plot_run(run, at=[float(t[5])], window=window)
    with pytest.raises(SettingsError, match=r"--at.*found .* s; expected times of what is drawn"):
        plot_run(run, at=[float(t[5]), float(t[20])], window=window)
