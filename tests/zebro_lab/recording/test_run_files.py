# SPDX-License-Identifier: MIT
"""The files of a run are whole from the beginning; its end is written wherever it is by then."""

import pytest

from support.recorders import PROFILE
from zebro_lab.files.errors import RecordingError
from zebro_lab.recording import run_files
from zebro_lab.recording.devices import profile_text
from zebro_lab.recording.run_files import RunFiles
from zebro_lab.runs.manifest import RunManifest, read_manifest

MANIFEST = RunManifest(kind="walk", label="x", source="sim:test", start="2026-01-02T03:04:05+00:00")


@pytest.fixture
def folder(tmp_path):
    """Return an empty run folder."""
    (tmp_path / "run").mkdir()
    return tmp_path / "run"


def begun(folder):
    return RunFiles(folder, MANIFEST, profiles={"legs": profile_text(PROFILE)}, start=0.0)


def test_the_end_is_written_into_a_folder_that_was_renamed(folder):
    files, renamed = begun(folder), folder.with_name("renamed")
    folder.rename(renamed)
    with pytest.raises(RecordingError, match="removed or renamed"):
        files.require_place()
    files.finish_log()
    files.write_end(MANIFEST, whole=True)
    files.close()
    assert files.folder == renamed
    manifest = read_manifest(renamed)
    assert manifest.streams == {"/legs/raw": 0}
    assert len(manifest.log_sha256) == 64


def test_a_beginning_that_fails_leaves_no_open_file(folder, monkeypatch):
    def fail(_manifest):
        raise OSError("planted")

    monkeypatch.setattr(run_files, "manifest_text", fail)
    with pytest.raises(OSError, match="planted"):  # a file left open would fail the test
        begun(folder)
