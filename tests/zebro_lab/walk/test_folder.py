# SPDX-License-Identifier: MIT
"""Walk folders: what is written is read back, and nothing else passes for one."""

import json
from dataclasses import fields, replace
from hashlib import sha256

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from model.walk.path import WalkPath
from zebro_lab.files.errors import AlreadyExists, DataError, NotFound
from zebro_lab.walk.folder import (
    COLUMNS,
    doubts,
    measured_sources,
    read_walk,
    read_walk_manifest,
    walk_folder,
    write_path,
)

SETTINGS = {"kind": "walk", "source": "sim:made-up", "settings": {"dt": 0.01}, "inputs": {}}


def write(out, path, **changes):
    with walk_folder(out, path, **{**SETTINGS, **changes}) as draft:
        (draft / "gantt.png").write_bytes(b"a picture")


def assert_same(found: WalkPath, expected: WalkPath) -> None:
    for field in fields(WalkPath):
        np.testing.assert_allclose(
            getattr(found, field.name), getattr(expected, field.name),
            rtol=1e-9, atol=1e-300, err_msg=field.name,
        )  # fmt: skip


def test_columns_stand_in_their_documented_order(walked, tmp_path):
    write_path(tmp_path / "path.csv", walked)
    header = (tmp_path / "path.csv").read_text().splitlines()[0].split(",")
    assert header[:8] == ["t", "x", "y", "z", "roll", "pitch", "yaw", "theta1"]
    assert header == list(COLUMNS)


numbers = st.floats(-1e6, 1e6)


@settings(max_examples=25)  # a file each
@given(data=st.data())
def test_what_is_written_is_read_back(data, tmp_path_factory):
    n = data.draw(st.integers(1, 4))

    def table(*shape, elements=numbers):
        return data.draw(arrays(float, (n, *shape), elements=elements))

    path = WalkPath(
        t=np.arange(n) * 0.1,
        position=table(3),
        orientation=table(3),
        theta=table(6),
        contact=table(6, elements=st.sampled_from((0.0, 1.0))) > 0,
        slip_velocity=table(6, 2, elements=numbers | st.just(np.nan)),
        slip_ratio=table(6, elements=numbers | st.just(np.nan)),
        normal_force=table(6),
        traction_force=table(6, 2),
        body_force=table(elements=st.floats(0, 1e6) | st.just(np.nan)),
        energy=table(4, elements=numbers | st.just(np.nan)),
    )
    folder = tmp_path_factory.mktemp("walk")
    write_path(folder / "path.csv", path)
    assert_same(read_walk(folder), path)


def test_a_folder_without_the_columns_of_body_and_energies_is_read(walked, tmp_path):
    file = tmp_path / "path.csv"
    write_path(file, walked)
    table = pd.read_csv(file, dtype=str, keep_default_na=False)
    later = ["body_force", *table.filter(regex="^work|energy$").columns]
    assert len(later) == 5
    table.drop(columns=later).to_csv(file, index=False)
    assert_same(read_walk(file), walked)


def test_the_folder_is_read_as_the_file_and_its_manifest_hashes_all(walked, tmp_path):
    out = tmp_path / "out"
    write(out, walked, inputs={"log.csv": "0" * 64})
    assert_same(read_walk(out), walked)
    assert_same(read_walk(out / "path.csv"), walked)
    manifest = read_walk_manifest(out)
    assert manifest["outputs"].keys() == {"path.csv", "gantt.png"}
    for name, digest in manifest["outputs"].items():
        assert sha256((out / name).read_bytes()).hexdigest() == digest
    assert (manifest["source"], manifest["settings"]) == ("sim:made-up", {"dt": 0.01})
    assert manifest["inputs"] == {"log.csv": "0" * 64}
    assert {"zebro-lab", "numpy", "numba"} <= manifest["software"].keys()


def test_a_failing_picture_leaves_nothing_behind(walked, tmp_path):
    with pytest.raises(ZeroDivisionError), walk_folder(tmp_path / "out", walked, **SETTINGS):
        raise ZeroDivisionError
    assert list(tmp_path.iterdir()) == []


def test_earlier_walks_pictures_go_and_foreign_files_stay(walked, tmp_path):
    out = tmp_path / "out"
    with walk_folder(out, walked, **SETTINGS) as draft:
        (draft / "motion.png").write_bytes(b"of the earlier walk")
    (out / "notes.txt").write_text("mine")
    write(out, walked)
    names = {"path.csv", "manifest.json", "gantt.png", "notes.txt"}
    assert {p.name for p in out.iterdir()} == names


def test_result_of_another_command_is_not_overwritten(walked, tmp_path):
    (tmp_path / "manifest.json").write_text('{"kind": "calibration"}')
    with pytest.raises(AlreadyExists, match="another command"):
        write(tmp_path, walked)
    assert json.loads((tmp_path / "manifest.json").read_text()) == {"kind": "calibration"}


FAULTS = {
    "missing column": (lambda t: t.drop(columns="theta3"), "column 'theta3': is missing; known"),
    "empty position": (lambda t: t.assign(x=t.x.where(t.index != 3)), "column 'x', row 4 (line 5)"),
    "text": (lambda t: t.assign(yaw=["left", *t.yaw[1:]]), "column 'yaw', row 1 (line 2): 'left'"),
    "reversed time": (lambda t: t.iloc[::-1], "column 't', row 2 (line 3): time goes from 4 to 3."),
    "infinite force": (lambda t: t.assign(normal2=np.inf), "column 'normal2', row 1 (line 2): is "),
}  # fmt: skip


@pytest.mark.parametrize(("spoil", "message"), FAULTS.values(), ids=FAULTS)
def test_fault_names_file_column_and_row(spoil, message, walked, tmp_path):
    file = tmp_path / "path.csv"
    write_path(file, walked)
    spoil(pd.read_csv(file)).to_csv(file, index=False)
    with pytest.raises(DataError) as caught:
        read_walk(file)
    assert message in str(caught.value)
    assert str(file) in str(caught.value)


def test_slip_that_a_model_does_not_have_stays_absent(walked, tmp_path):
    path = replace(walked, slip_velocity=np.full_like(walked.slip_velocity, np.nan))
    write_path(tmp_path / "path.csv", path)
    assert np.isnan(read_walk(tmp_path).slip_velocity).all()


def test_missing_walk_is_said_to_be_missing(tmp_path):
    with pytest.raises(NotFound, match="choose a folder that walk or predict wrote"):
        read_walk(tmp_path)
    with pytest.raises(NotFound, match=r"manifest\.json is missing"):
        read_walk_manifest(tmp_path)


@pytest.mark.parametrize("text", ["{", "[]", '{"kind": "walk", "schema": 99}'])
def test_manifest_of_no_walk_is_refused(text, tmp_path):
    (tmp_path / "manifest.json").write_text(text)
    with pytest.raises(DataError, match=r"manifest\.json"):
        read_walk_manifest(tmp_path)


@pytest.mark.parametrize(
    ("settings", "sources"),
    [
        ({"leg_angles": "real", "slip": {"named": "c", "source": "real"}}, ("real",)),
        ({"leg_angles": "real", "slip": {"source": "assumed"}, "walks": None}, ("real",)),
        ({"leg_angles": "real", "slip": {"source": "sim:rig"}}, ("real", "sim:rig")),
        ({"leg_angles": "sim:zebro", "slip": None}, ("sim:zebro",)),
        (
            {"leg_angles": "real", "slip": {"source": "real"}, "walks": {"source": "real, sim:x"}},
            ("real", "sim:x"),
        ),
        ({"dt": 0.01}, ("sim:dynamics",)),  # a gait is computed, and so is the walk
    ],
)
def test_sources_are_those_of_data_and_not_of_the_model(settings, sources):
    manifest = {"source": "sim:dynamics", "settings": settings}
    assert measured_sources(manifest) == sources


def test_doubts_are_read_and_older_manifests_have_none():
    assert doubts({"settings": {"doubts": ["WARNING: x"]}}) == ("WARNING: x",)
    assert doubts({"settings": {}}) == ()
