# SPDX-License-Identifier: MIT
"""Results replace what the same command made, whole or not at all, and nothing of anybody else."""

import json
import resource
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from rig.errors import InUse
from support.written_tracks import content, path_from, write_track
from zebro_lab.files.errors import NotWritten, ZebroLabError
from zebro_lab.files.result_folder import ResultKind, require_replaceable, result_folder
from zebro_lab.track.folder import TRACKED, read_track_manifest, track_folder

KIND = ResultKind("mine", "my command", ("a.csv",))


def write(out: Path) -> None:
    with result_folder(out, KIND, content={}) as draft:
        (draft / "a.csv").write_text("1")


def test_a_foreign_file_of_a_name_that_is_written_is_kept(tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "a.csv").write_text("my own comparison")
    with pytest.raises(ZebroLabError, match=r"a\.csv"):
        write(out)
    assert content(out) == {"a.csv": b"my own comparison"}


def test_a_full_disk_is_one_error_and_keeps_the_earlier_result(tmp_path):
    out = tmp_path / "out"
    write(out)
    before = content(out)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, limits[1]))
    try:
        with (
            pytest.raises(NotWritten, match=r"out cannot be written \(File too large\)"),
            result_folder(out, KIND, content={}) as draft,
        ):
            (draft / "a.csv").write_bytes(bytes(2000))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert content(out) == before


FIRST = """
import sys
from pathlib import Path
from zebro_lab.files.result_folder import ResultKind, require_replaceable
require_replaceable(Path(sys.argv[1]), ResultKind("mine", "my command", ("a.csv",)))
print("computing", flush=True)
sys.stdin.read()
"""


def test_the_second_of_two_writers_is_refused_while_the_first_lives(tmp_path):
    out = tmp_path / "out"
    command = [sys.executable, "-c", FIRST, str(out)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as first:
        assert first.stdout.readline() == b"computing\n"
        with pytest.raises(InUse, match=f"as --out is in use by process {first.pid}"):
            require_replaceable(out, KIND)
        first.kill()
    write(out)
    write(out)


def test_a_result_that_a_person_changed_is_kept(tmp_path):
    out = tmp_path / "out"
    write(out)
    (out / "a.csv").write_text("corrected by hand")
    with pytest.raises(ZebroLabError, match="changed"):
        write(out)
    assert (out / "a.csv").read_text() == "corrected by hand"


def test_a_result_with_a_manifest_that_cannot_be_read_is_kept(tmp_path):
    out = tmp_path / "out"
    write(out)
    (out / "manifest.json").write_text("{")
    with pytest.raises(ZebroLabError, match=r"manifest\.json"):
        write(out)


def test_another_commands_result_is_kept(tmp_path):
    out = tmp_path / "out"
    write_track(out, 0.0)
    before = content(out)
    with pytest.raises(ZebroLabError, match="another command"):
        write(out)
    assert content(out) == before
    assert json.loads(before["manifest.json"])["kind"] == "track"


@pytest.mark.parametrize("out", ["file/result", "file/deep/result", "broken", "broken/result"])
def test_a_place_that_can_hold_no_folder_is_refused_before_anything_is_computed(out, tmp_path):
    (tmp_path / "file").write_text("mine")
    (tmp_path / "broken").symlink_to("nowhere")
    with pytest.raises(ZebroLabError, match=r"^\S+ is a (file|broken link).*(a folder|--out)$"):
        require_replaceable(tmp_path / out, TRACKED)


@pytest.mark.parametrize("closed", [".", "out"])
def test_a_folder_that_cannot_be_written_is_refused_before_anything_is_computed(
    closed, tmp_path, monkeypatch
):
    (tmp_path / "out").mkdir()
    place = (tmp_path / closed).resolve()
    monkeypatch.setattr("os.access", lambda path, _mode: Path(path) != place)
    with pytest.raises(NotWritten, match="is not writable; choose another folder"):
        require_replaceable(tmp_path / "out", TRACKED)


def test_drafts_of_killed_writers_are_removed_and_those_of_living_ones_kept(tmp_path):
    (tmp_path / ".track.0123abcd.part").mkdir()
    (tmp_path / ".other.0123abcd.part").mkdir()
    (tmp_path / ".tracks.mine.part").mkdir()
    with track_folder(
        tmp_path / "track", **path_from(0.0), source="real", settings={}, inputs={}, report={}
    ) as draft:
        write_track(tmp_path / "track", 1.0)
        assert draft.is_dir()
    assert sorted(path.name for path in tmp_path.iterdir()) == [".tracks.mine.part", "track"]
    assert read_track_manifest(tmp_path / "track")["settings"] == {}


def test_the_folder_one_works_in_is_not_replaced_under_ones_feet(tmp_path, monkeypatch):
    write_track(tmp_path / "track", 0.0)
    monkeypatch.chdir(tmp_path / "track")
    with pytest.raises(ZebroLabError, match="is the working folder"):
        write_track(Path(), 1.0)


def test_a_result_that_is_read_is_not_replaced(tmp_path):
    write_track(tmp_path / "track", 0.0)
    floor = tmp_path / "track" / "floor.toml"
    with pytest.raises(ZebroLabError, match=r"floor\.toml, which this command reads"):
        require_replaceable(tmp_path / "track", TRACKED, inputs=(floor,))
    (tmp_path / "link").symlink_to(floor)
    with pytest.raises(ZebroLabError, match="which this command reads"):
        require_replaceable(tmp_path / "track", TRACKED, inputs=(tmp_path / "link",))
    require_replaceable(tmp_path / "track", TRACKED, inputs=(tmp_path,))


@pytest.mark.parametrize("read", ["inner", "inner/a.csv"])
def test_a_result_inside_that_would_go_with_its_folder_is_not_read_and_lost(tmp_path, read):
    outer = replace(KIND, inside={"inner": "inner"})
    write(tmp_path)
    with result_folder(
        tmp_path / "inner", ResultKind("inner", "another", ("a.csv",)), content={}
    ) as draft:
        (draft / "a.csv").write_text("1")
    require_replaceable(tmp_path, outer, inputs=())
    with pytest.raises(ZebroLabError, match="which this command reads"):
        require_replaceable(tmp_path, outer, inputs=(tmp_path / read,))
