# SPDX-License-Identifier: MIT
"""A single file is overwritten only if the same command wrote it."""

import json
import os
from pathlib import Path

import pytest
from PIL import Image

from support.written_runs import START, make_run
from support.written_tracks import content
from zebro_lab.files.errors import ZebroLabError
from zebro_lab.files.single_file import require_overwritable
from zebro_lab.report.request import ReportRequest
from zebro_lab.report.stage import REPORT, report
from zebro_lab.runs.plot_stage import PLOT, plot_run
from zebro_lab.track.annotate_stage import draw_grid
from zebro_lab.track.camera.stage import LENS

pytestmark = pytest.mark.usefixtures("coarse_pictures")


@pytest.fixture
def run(tmp_path) -> Path:
    """Return a run folder of the slip rig."""
    return make_run(tmp_path / "data")


@pytest.fixture
def photos(tmp_path) -> Path:
    folder = tmp_path / "photos"
    folder.mkdir()
    Image.new("RGB", (64, 48), "white").save(folder / "p01.png")
    return folder


@pytest.mark.parametrize("name", ["log.mcap", "run.json"])
def test_a_report_does_not_replace_what_it_reports_on(run, name):
    before = content(run)
    request = ReportRequest(run, run / "no-calibration", run / name)
    with pytest.raises(ZebroLabError, match=name):
        report(request, made=START)
    assert content(run) == before


@pytest.mark.parametrize("link", [os.symlink, os.link])
def test_a_report_does_not_replace_its_input_through_a_link(run, tmp_path, link):
    out = tmp_path / "report.html"
    link(run / "log.mcap", out)
    with pytest.raises(ZebroLabError, match=r"report\.html"):
        report(ReportRequest(run, run / "none", out), made=START)
    assert out.samefile(run / "log.mcap")


@pytest.mark.timeout(60)
def test_a_manifest_that_is_a_fifo_beside_a_page_is_not_waited_for(run, tmp_path):
    page = tmp_path / "r.html"
    report(ReportRequest(run, run / "none", page), made=START)
    os.mkfifo(tmp_path / "manifest.json")
    report(ReportRequest(run, run / "none", page), made=START)


def test_a_grid_is_not_written_among_the_photographs_that_are_tracked(photos):
    with pytest.raises(ZebroLabError, match="photograph"):
        draw_grid(photos, "p01.png", photos / "grid.png")
    assert list(content(photos)) == ["p01.png"]


@pytest.mark.parametrize("kind", [REPORT, LENS, PLOT])
def test_notes_that_quote_the_mark_of_a_command_are_kept(kind, tmp_path):
    notes = tmp_path / "notes.md"
    for begin, mark in kind.marks.items():
        notes.write_bytes(b"Such files hold: " + begin + mark)
        with pytest.raises(ZebroLabError, match=f"not made by {kind.command}"):
            require_overwritable(notes, kind)


def test_results_of_the_same_command_are_replaced(run, photos, tmp_path):
    for _ in range(2):
        report(ReportRequest(run, run / "none", tmp_path / "r.html"), made=START)
        plot_run(run, out=tmp_path / "p.png")
        draw_grid(photos, "p01.png", tmp_path / "g.png")


def test_a_picture_is_known_by_its_command_and_one_of_a_result_is_kept(run, photos, tmp_path):
    grid = tmp_path / "grid.png"
    draw_grid(photos, "p01.png", grid)
    with pytest.raises(ZebroLabError, match="not made by plot"):
        plot_run(run, out=grid)
    (tmp_path / "manifest.json").write_text(json.dumps({"outputs": {"p.png": "0"}}))
    plot = tmp_path / "other" / "p.png"
    plot.parent.mkdir()
    plot_run(run, out=plot)
    plot.rename(tmp_path / "p.png")
    with pytest.raises(ZebroLabError, match="is part of the result"):
        plot_run(run, out=tmp_path / "p.png")
    (tmp_path / "manifest.json").unlink()
    plot_run(run, out=tmp_path / "p.png")
