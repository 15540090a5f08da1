# SPDX-License-Identifier: MIT
"""Results replace what the same command made, whole or not at all, and nothing of anybody else."""

import fcntl
import json
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from support.table_runs import slip_rig_run
from zebro_lab.files import replacement
from zebro_lab.files.errors import ZebroLabError
from zebro_lab.files.result_folder import require_replaceable
from zebro_lab.mcap.slip_rig_log import SlipRigTable
from zebro_lab.report.request import ReportRequest
from zebro_lab.report.stage import report
from zebro_lab.runs.plot_stage import plot_run
from zebro_lab.track.annotate_stage import draw_grid
from zebro_lab.track.folder import TRACKED, read_track_manifest, track_folder
from zebro_lab.validation.compare.request import CompareRequest
from zebro_lab.validation.compare.stage import compare

START = datetime(2026, 3, 4, 5, 6, 7, tzinfo=UTC)
SLIP_TOML = """
schema = 1
source = "sim:rig-sweep"
slip_definition = "material"
law = {{ name = "coulomb-stribeck", stribeck = false }}
[parameters]
slip_stiffness = {{ mean = 20.0 }}
friction = {{ mean = {friction} }}
[covariance]
matrix = [[1.0, 0.0], [0.0, 1e-4]]
[tested]
normal_force = [2.0, 13.0]
slip_ratio = [0.0, 1.0]
"""


@pytest.fixture
def run(tmp_path) -> Path:
    """Return a run folder of the slip rig."""
    rng, n = np.random.default_rng(1), 200
    table = SlipRigTable(
        np.arange(n) * 1e-3, 12 + rng.normal(size=n) / 10, 2 + rng.normal(size=n) / 10,
        6 + rng.normal(size=n) / 10, rng.normal(size=n),
    )  # fmt: skip
    return slip_rig_run(
        tmp_path / "data", table, label="sweep", material="POM", operator="a", source="real",
        start=START, radius_leg=0.035, radius_ground=0.12,
    )  # fmt: skip


def calibration(folder: Path, friction: float) -> Path:
    folder.mkdir(parents=True)
    (folder / "slip.toml").write_text(SLIP_TOML.format(friction=friction))
    return folder


@pytest.fixture
def compared(tmp_path) -> Callable[[Path], None]:
    """Return what writes a comparison into a folder."""
    one, other = calibration(tmp_path / "one", 0.3), calibration(tmp_path / "other", 0.4)
    return lambda out: void(compare(CompareRequest(one, other, out)))


def void(_: object) -> None:
    """Forget what a stage returns."""


def path_from(x: float) -> dict[str, object]:
    """Return the table and the TUM lines of a path that begins at x [m]."""
    columns = {"t_s": [0.0, 1.0], "x_m": [x, x + 1.0], "y_m": [0.0, 0.0]}
    return {"columns": columns, "tum": (f"0 {x} 0 0 0 0 0 1", f"1 {x + 1} 0 0 0 0 0 1")}


def write_track(out: Path, x: float) -> None:
    with track_folder(out, **path_from(x), source="real", settings={"x": x}, inputs={}, report={}):
        pass


def content(folder: Path) -> dict[str, bytes]:
    """Return every file below a folder by its name."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }


class Killed(BaseException):
    """Stands for a process that is killed: none of its later writes reaches the disk."""


class Killer:
    """Ends every change of a file from the n-th on, as SIGKILL between two calls does."""

    CHANGES = ("os.rename", "os.mkdir", "os.link", "os.remove", "os.rmdir", "os.chmod",
               "os.truncate", "os.symlink")  # fmt: skip

    def __init__(self) -> None:
        self.left: int | None = None
        sys.addaudithook(self._hear)

    def _hear(self, event: str, arguments: tuple[object, ...]) -> None:
        if self.left is None or not self._changes(event, arguments):
            return
        self.left -= 1
        if self.left < 0:
            raise Killed

    def _changes(self, event: str, arguments: tuple[object, ...]) -> bool:
        if event != "open":
            return event in self.CHANGES
        flags = arguments[2]
        return isinstance(flags, int) and bool(flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT))

    @contextmanager
    def after(self, changes: int) -> Iterator[None]:
        """Let the body make so many changes, then kill it."""
        self.left = changes
        try:
            yield
        finally:
            self.left = None


@pytest.fixture(scope="module")
def killer() -> Killer:
    return Killer()  # a hook cannot be taken away again: one for all tests


def survives(write: Callable[[], None], killer: Killer, changes: int) -> bool:
    """Kill a writer after so many changes; tell whether it came to its end before."""
    try:
        with killer.after(changes):
            write()
    except Killed:
        return False
    return True


def test_a_kill_at_any_change_leaves_the_old_or_the_new_result_whole(tmp_path, killer):
    old, new = tmp_path / "old", tmp_path / "new"
    write_track(old, 0.0)
    write_track(new, 5.0)
    for changes in range(200):
        out = tmp_path / f"killed-{changes}" / "track"
        write_track(out, 0.0)
        (out / "notes.txt").write_text("mine")
        finished = survives(lambda out=out: write_track(out, 5.0), killer, changes)
        previous = out.with_name("track.previous")
        found = content(out if out.exists() else previous)
        assert found.pop("notes.txt") == b"mine"
        assert found in (content(old), content(new)), f"killed after {changes} changes"
        if finished:
            break
    assert finished
    assert found == content(new)
    assert changes > 5


def test_a_foreign_file_of_a_name_that_is_written_is_kept(tmp_path, compared):
    out = tmp_path / "out"
    out.mkdir()
    (out / "comparison.csv").write_text("my own comparison")
    with pytest.raises(ZebroLabError, match=r"comparison\.csv"):
        compared(out)
    assert content(out) == {"comparison.csv": b"my own comparison"}


def test_a_result_that_a_person_changed_is_kept(tmp_path, compared):
    out = tmp_path / "out"
    compared(out)
    (out / "comparison.csv").write_text("corrected by hand")
    with pytest.raises(ZebroLabError, match="changed"):
        compared(out)
    assert (out / "comparison.csv").read_text() == "corrected by hand"


def test_a_result_with_a_manifest_that_cannot_be_read_is_kept(tmp_path, compared):
    out = tmp_path / "out"
    compared(out)
    (out / "manifest.json").write_text("{")
    with pytest.raises(ZebroLabError, match=r"manifest\.json"):
        compared(out)


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


def test_a_foreign_page_is_kept(run, tmp_path):
    out = tmp_path / "index.html"
    out.write_text("<!DOCTYPE html>\n<html><body>My thesis</body></html>")
    with pytest.raises(ZebroLabError, match=r"index\.html"):
        report(ReportRequest(run, run / "none", out), made=START)
    assert "My thesis" in out.read_text()


@pytest.mark.timeout(60)
def test_a_manifest_that_is_a_fifo_beside_a_page_is_not_waited_for(run, tmp_path):
    page = tmp_path / "r.html"
    report(ReportRequest(run, run / "none", page), made=START)
    os.mkfifo(tmp_path / "manifest.json")
    report(ReportRequest(run, run / "none", page), made=START)


def test_a_plot_keeps_a_foreign_picture(run, tmp_path):
    out = tmp_path / "robot.png"
    Image.new("RGB", (8, 8), "red").save(out)
    before = out.read_bytes()
    with pytest.raises(ZebroLabError, match=r"robot\.png"):
        plot_run(run, out=out)
    assert out.read_bytes() == before


@pytest.fixture
def photos(tmp_path) -> Path:
    folder = tmp_path / "photos"
    folder.mkdir()
    Image.new("RGB", (64, 48), "white").save(folder / "p01.png")
    return folder


def test_a_grid_does_not_replace_its_photograph(photos):
    before = content(photos)
    with pytest.raises(ZebroLabError, match=r"p01\.png"):
        draw_grid(photos, "p01.png", photos / "p01.png")
    assert content(photos) == before


def test_a_grid_is_not_written_among_the_photographs_that_are_tracked(photos):
    with pytest.raises(ZebroLabError, match="photograph"):
        draw_grid(photos, "p01.png", photos / "grid.png")
    assert list(content(photos)) == ["p01.png"]


def test_results_of_the_same_command_are_replaced(run, photos, compared, tmp_path):
    for _ in range(2):
        compared(tmp_path / "out")
        report(ReportRequest(run, run / "none", tmp_path / "r.html"), made=START)
        plot_run(run, out=tmp_path / "p.png")
        draw_grid(photos, "p01.png", tmp_path / "g.png")


def test_another_commands_result_is_kept(tmp_path, compared):
    out = tmp_path / "out"
    write_track(out, 0.0)
    before = content(out)
    with pytest.raises(ZebroLabError, match="another command"):
        compared(out)
    assert content(out) == before
    assert json.loads(before["manifest.json"])["kind"] == "track"


def test_a_reader_restores_what_an_interrupted_replacement_left_and_says_so(tmp_path, caplog):
    write_track(tmp_path / "track", 0.0)
    (tmp_path / "track").rename(tmp_path / "track.previous")
    assert read_track_manifest(tmp_path / "track")["settings"] == {"x": 0.0}
    assert not (tmp_path / "track.previous").exists()
    assert "restored from track.previous" in caplog.text


@pytest.mark.parametrize("named", ["one", "one/slip.toml"])
def test_a_calibration_is_restored_whichever_way_it_is_named(tmp_path, compared, named, caplog):
    (tmp_path / "one").rename(tmp_path / "one.previous")
    compare(CompareRequest(tmp_path / named, tmp_path / "other", tmp_path / "out"))
    assert "restored" in caplog.text


def test_a_folder_that_somebody_keeps_as_previous_is_never_removed(tmp_path):
    out = tmp_path / "track"
    write_track(tmp_path / "track.previous", 7.0)
    write_track(out, 0.0)
    assert read_track_manifest(tmp_path / "track.previous")["settings"] == {"x": 7.0}
    with pytest.raises(ZebroLabError, match=r"track\.previous is in the way"):
        write_track(out, 1.0)
    assert read_track_manifest(out)["settings"] == {"x": 0.0}


def test_a_linked_folder_is_replaced_behind_its_link(tmp_path):
    write_track(tmp_path / "track-3", 0.0)
    (tmp_path / "track").symlink_to("track-3")
    write_track(tmp_path / "track", 1.0)
    assert (tmp_path / "track").is_symlink()
    assert read_track_manifest(tmp_path / "track-3")["settings"] == {"x": 1.0}


def test_a_manifest_that_names_a_file_of_a_foreign_encoding_is_read_back(tmp_path):
    with track_folder(
        tmp_path / "track", **path_from(0.0), source="real", settings={}, inputs={"caf\udce9": "0"},
        report={},
    ):  # fmt: skip
        pass
    assert read_track_manifest(tmp_path / "track")["inputs"] == {r"caf\udce9": "0"}


@pytest.mark.parametrize("out", ["file/result", "file/deep/result", "broken", "broken/result"])
def test_a_place_that_can_hold_no_folder_is_refused_before_anything_is_computed(out, tmp_path):
    (tmp_path / "file").write_text("mine")
    (tmp_path / "broken").symlink_to("nowhere")
    with pytest.raises(ZebroLabError, match=r"^\S+ is (a file|a link).*; name another --out$"):
        require_replaceable(tmp_path / out, TRACKED)


def test_foreign_folders_links_and_rights_are_carried_over(tmp_path):
    out = tmp_path / "track"
    write_track(out, 0.0)
    (out / "mine" / "deep").mkdir(parents=True)
    (out / "mine" / "deep" / "a.txt").write_text("a")
    (out / "mine" / "empty").mkdir(mode=0o700)
    (out / "link").symlink_to("nowhere")
    inode = (out / "mine" / "deep" / "a.txt").stat().st_ino
    out.chmod(0o775)
    write_track(out, 1.0)
    assert (out / "mine" / "deep" / "a.txt").stat().st_ino == inode
    assert (out / "mine" / "empty").stat().st_mode & 0o777 == 0o700
    assert (out / "link").readlink() == Path("nowhere")
    assert out.stat().st_mode & 0o777 == 0o775
    assert sorted(path.name for path in tmp_path.iterdir()) == ["track"]


def test_foreign_files_are_kept_where_no_hard_links_are(tmp_path, monkeypatch):
    def refuse(*_, **__) -> None:
        raise PermissionError(1, "Operation not permitted")

    out = tmp_path / "track"
    write_track(out, 0.0)
    (out / "mine").mkdir()
    for name in ("notes.txt", "mine/a.txt"):
        (out / name).write_text("mine")
    monkeypatch.setattr(os, "link", refuse)
    write_track(out, 1.0)
    assert (out / "notes.txt").read_text() == (out / "mine" / "a.txt").read_text() == "mine"
    assert not (tmp_path / "track.previous").exists()


def test_drafts_of_killed_writers_are_removed_and_those_of_living_ones_kept(tmp_path):
    (tmp_path / ".track.0123abcd.part").mkdir()
    (tmp_path / ".tracks.0123abcd.part").mkdir()
    with track_folder(
        tmp_path / "track", **path_from(0.0), source="real", settings={}, inputs={}, report={}
    ) as draft:
        write_track(tmp_path / "track", 1.0)
        assert draft.is_dir()
    assert sorted(path.name for path in tmp_path.iterdir()) == [".tracks.0123abcd.part", "track"]
    assert read_track_manifest(tmp_path / "track")["settings"] == {}


def test_the_folder_one_works_in_is_not_replaced_under_ones_feet(tmp_path, monkeypatch):
    write_track(tmp_path / "track", 0.0)
    monkeypatch.chdir(tmp_path / "track")
    with pytest.raises(ZebroLabError, match="folder you are in"):
        write_track(Path(), 1.0)


def test_a_result_that_is_read_is_not_replaced(tmp_path):
    write_track(tmp_path / "track", 0.0)
    floor = tmp_path / "track" / "floor.toml"
    with pytest.raises(ZebroLabError, match=r"floor\.toml, which is read"):
        require_replaceable(tmp_path / "track", TRACKED, inputs=(floor,))
    (tmp_path / "link").symlink_to(floor)
    with pytest.raises(ZebroLabError, match="which is read"):
        require_replaceable(tmp_path / "track", TRACKED, inputs=(tmp_path / "link",))
    require_replaceable(tmp_path / "track", TRACKED, inputs=(tmp_path,))


def test_a_waiting_writer_gives_up_with_one_line(tmp_path, monkeypatch):
    monkeypatch.setattr(replacement, "PATIENCE", 0.1)
    write_track(tmp_path / "track", 0.0)
    with (tmp_path / ".track.replacing").open("w") as note:
        fcntl.flock(note, fcntl.LOCK_EX)
        with pytest.raises(ZebroLabError, match="by another process"):
            write_track(tmp_path / "track", 1.0)
    write_track(tmp_path / "track", 2.0)
    assert read_track_manifest(tmp_path / "track")["settings"] == {"x": 2.0}


def test_a_picture_is_known_by_its_command_and_one_of_a_result_is_kept(run, photos, tmp_path):
    grid = tmp_path / "grid.png"
    draw_grid(photos, "p01.png", grid)
    with pytest.raises(ZebroLabError, match="not made by plot"):
        plot_run(run, out=grid)
    early = tmp_path / "early.png"
    words = PngInfo()
    words.add_text("Software", "zebro-lab")
    Image.new("RGB", (8, 8)).save(early, pnginfo=words)
    (tmp_path / "manifest.json").write_text(json.dumps({"outputs": {"early.png": "0"}}))
    with pytest.raises(ZebroLabError, match="belongs to the result"):
        plot_run(run, out=early)
    (tmp_path / "manifest.json").unlink()
    plot_run(run, out=early)
