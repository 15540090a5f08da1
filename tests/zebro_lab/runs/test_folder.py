# SPDX-License-Identifier: MIT
"""Run folders: what is written is read back, and damage is told."""

import contextlib
from datetime import datetime, timedelta, timezone
from importlib.metadata import version

import numpy as np
import pytest

from support.written_runs import START, edit, make_run, make_table
from zebro_lab.calibration.rig_data import read_rig_data
from zebro_lab.files.errors import AlreadyExists, DataError, NotFound
from zebro_lab.runs.folder import read_slip_rig_run, removing_new_folders
from zebro_lab.runs.manifest import read_manifest
from zebro_lab.runs.recorded_walk import read_recorded_legs
from zebro_lab.runs.signals import read_signals

FIELDS = ("t", "omega_leg", "omega_ground", "normal_force", "traction_force")


@pytest.mark.parametrize("n", [1, 63, 64, 65, 1000])
def test_run_round_trips_to_the_last_bit(tmp_path, n):
    run = read_slip_rig_run(make_run(tmp_path, n))
    for name in FIELDS:
        np.testing.assert_array_equal(getattr(run.table, name), getattr(make_table(n), name))
    assert run.notes == ()


def test_manifest_tells_what_was_recorded(tmp_path):
    folder = make_run(tmp_path, 200)
    manifest = read_manifest(folder)
    assert folder.name == "20260304T050607Z_slip-rig_Delrin-steel"
    assert sorted(path.name for path in folder.iterdir()) == ["log.mcap", "profiles", "run.json"]
    assert (manifest.kind, manifest.label, manifest.source) == (
        "slip-rig", "Delrin, steel", "sim:noise",
    )  # fmt: skip
    assert manifest.constants == {"radius_leg": 0.035, "radius_ground": 0.12}
    assert manifest.streams == {"/board/raw": 200}
    assert manifest.software["version"] == version("zebro-lab")
    assert datetime.fromisoformat(manifest.stop) - START == timedelta(seconds=0.199)


def test_a_run_of_a_version_without_profiles_and_an_unknown_zero_are_refused(tmp_path):
    folder = make_run(tmp_path)
    edit(folder, constants={"radius_leg": 0.03, "radius_ground": 0.1, "zero_normal": None})
    with pytest.raises(DataError, match=r"is unknown; .*constants\.zero_normal"):
        read_slip_rig_run(folder)
    edit(folder, profiles=...)
    for read in (read_slip_rig_run, read_signals, read_recorded_legs):
        with pytest.raises(DataError, match=r"run\.json: is of an earlier version without prof"):
            read(folder)


def test_start_in_any_zone_names_the_folder_in_utc(tmp_path):
    local = START.astimezone(timezone(timedelta(hours=2)))
    assert make_run(tmp_path, start=local).name.startswith("20260304T050607Z")


def test_run_is_never_overwritten(tmp_path):
    make_run(tmp_path)
    with pytest.raises(AlreadyExists, match="choose another name with --label"):
        make_run(tmp_path)


def flipped(data):
    middle = len(data) // 2
    return data[:middle] + bytes([data[middle] ^ 0xFF]) + data[middle + 1 :]


DAMAGE = {f"cut at {kept}": lambda data, kept=kept: data[: int(len(data) * kept)]
          for kept in (0.4, 0.7, 0.99)} | {"flipped": flipped}  # fmt: skip


@pytest.mark.parametrize("damage", DAMAGE.values(), ids=DAMAGE)
def test_a_damaged_log_is_salvaged_but_for_the_damage_with_a_note(tmp_path, damage):
    folder = make_run(tmp_path, 5_000)
    log = folder / "log.mcap"
    log.write_bytes(damage(log.read_bytes()))
    run = read_slip_rig_run(folder)
    assert 1_000 <= len(run.table) <= 5_000
    recorded = make_table(5_000).t
    if damage is flipped:  # one chunk is lost, from the middle
        assert len(run.table) == 4_900
        assert set(run.table.t) < set(recorded)
        assert run.table.t[-1] == recorded[-1]
    else:
        np.testing.assert_array_equal(run.table.t, recorded[: len(run.table)])
    assert "log.mcap is incomplete" in run.notes[0]
    assert f"; {len(run.table)} of 5000 samples were read" in run.notes[0]
    assert run.notes[0] in read_rig_data([folder]).notes


@pytest.mark.parametrize("kept", [20, 200, 2000])
def test_log_cut_before_its_first_whole_chunk_is_an_error(tmp_path, kept):
    folder = make_run(tmp_path, 5_000)
    (folder / "log.mcap").write_bytes((folder / "log.mcap").read_bytes()[:kept])
    with pytest.raises(DataError, match="holds no samples of topic /board/raw") as caught:
        read_slip_rig_run(folder)
    assert "\n" not in str(caught.value)


def test_log_of_another_run_is_refused(tmp_path):
    first, second = make_run(tmp_path, label="a"), make_run(tmp_path, 300, label="b")
    (first / "log.mcap").write_bytes((second / "log.mcap").read_bytes())
    with pytest.raises(DataError, match="was changed after the recording"):
        read_slip_rig_run(first)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"kind": "walk"}, "is a run of kind 'walk', expected 'slip-rig'"),
        ({"constants": {}}, "column 'radius_leg': is nan m, expected more than 0"),
        ({"constants": {"radius_leg": 0.0}}, "column 'radius_leg': is 0 m, expected more than 0"),
    ],
)
def test_wrong_manifest_is_named(tmp_path, change, message):
    folder = make_run(tmp_path)
    edit(folder, **change)
    with pytest.raises(DataError, match=message) as caught:
        read_slip_rig_run(folder)
    assert str(caught.value).startswith(str(folder / "run.json"))


def test_missing_and_foreign_files_are_named(tmp_path):
    folder = make_run(tmp_path)
    (folder / "log.mcap").write_bytes(b"no mcap at all")
    with pytest.raises(DataError, match="is not an MCAP file"):
        read_slip_rig_run(folder)
    (folder / "log.mcap").unlink()
    with pytest.raises(NotFound, match=r"log\.mcap: missing"):
        read_slip_rig_run(folder)
    (folder / "run.json").write_text("{")
    with pytest.raises(DataError, match="cannot be read as JSON"):
        read_slip_rig_run(folder)
    (folder / "run.json").unlink()
    with pytest.raises(NotFound, match="is not a run folder"):
        read_slip_rig_run(folder)


def test_many_run_folders_are_as_many_runs_without_the_excluded(tmp_path):
    for n, label in enumerate("abc", 200):
        make_run(tmp_path, n, label=label)
    bad = tmp_path / "20260304T050607Z_slip-rig_b"
    edit(bad, excluded={"why": "belt came off"})
    data = read_rig_data([tmp_path])
    assert [name[-1] for name in data.samples.run_names] == ["a", "c"]
    assert f"{bad.name}: left out, belt came off" in data.notes
    with pytest.raises(DataError, match=r"every run is left out: .*belt came off"):
        read_rig_data([bad])


@pytest.mark.parametrize(
    ("error", "beside", "left"),
    [(KeyboardInterrupt(), None, []), (OSError("disk"), "mine", ["mine"]), (None, None, ["b"])],
)
def test_new_folders_go_where_something_fails_unless_they_hold_a_file(
    tmp_path, error, beside, left
):
    raised = pytest.raises(type(error)) if error else contextlib.nullcontext()
    with raised, removing_new_folders(tmp_path / "a" / "b"):
        (tmp_path / "a" / "b").mkdir(parents=True)
        if beside is not None:
            (tmp_path / "a" / beside).touch()
        if error is not None:
            raise error
    assert [path.name for path in tmp_path.glob("a/*")] == left
    assert (tmp_path / "a").exists() == bool(left)
