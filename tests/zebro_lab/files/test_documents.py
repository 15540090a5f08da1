# SPDX-License-Identifier: MIT
"""Whatever stands in a TOML or JSON file of a user, a reader ends with one line, and soon."""

import json
import math
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rig.zebro.profile import load_leg_profile
from support.bounded_reading import error_on_fifo, refusal
from zebro_lab.calibration.folder import read_slip
from zebro_lab.experiment.plan_stage import read_plan
from zebro_lab.files.documents import json_text, read_json_document, read_toml_document
from zebro_lab.files.errors import NotFound
from zebro_lab.robot.robot_file import read_robot_file
from zebro_lab.runs.manifest import read_manifest
from zebro_lab.tables.columns_file import read_columns
from zebro_lab.track.annotations import read_annotations
from zebro_lab.track.camera_file import read_camera_file
from zebro_lab.track.floor_file import read_floor_file

RUN = {
    "schema_version": 1, "kind": "walk", "label": "x", "material": "x", "operator": "x",
    "source": "real", "start": "2026-01-01T00:00:00+00:00", "exit_status": "completed",
    "software": {"version": "1"}, "constants": {"radius_leg": 0.035}, "streams": {"/a/raw": 3},
    "stop": "2026-01-01T00:00:01+00:00",
}  # fmt: skip
TOML_READERS: dict[str, Callable[[Path], object]] = {
    "robot": read_robot_file,
    "columns": read_columns,
    "camera": read_camera_file,
    "floor": read_floor_file,
    "annotations": read_annotations,
    "plan": read_plan,
    "slip": read_slip,
    "profile": lambda file: load_leg_profile(str(file)),
}
DEEP = 100_000


def toml(folder: Path, text: str) -> Path:
    file = folder / "x.toml"
    file.write_text(text)
    return file


def run_json(folder: Path, text: str) -> Path:
    (folder / "run.json").write_text(text)
    return folder


@pytest.mark.parametrize("name", TOML_READERS)
def test_deeply_nested_toml_is_refused(name, tmp_path):
    refusal(TOML_READERS[name], toml(tmp_path, "a = " + "[" * DEEP))


def test_deeply_nested_json_is_refused(tmp_path):
    text = json.dumps(RUN)[:-1] + ', "truth": {"a": ' + "[" * DEEP + "]" * DEEP + "}}"
    refusal(read_manifest, run_json(tmp_path, text))


@pytest.mark.parametrize("digits", ["9" * 400, "9" * 5000, "0x" + "f" * 6000])
@pytest.mark.parametrize(("reader", "key"), [(read_robot_file, "mass"), (read_camera_file, "size")])
def test_an_integer_that_toml_cannot_hold_is_refused(reader, key, digits, tmp_path):
    value = f"[{digits}, 5]" if key == "size" else digits
    focal = "focal = [1, 1]\ncentre = [1, 1]\n" if key == "size" else ""
    refusal(reader, toml(tmp_path, f"{key} = {value}\n{focal}"))


@pytest.mark.parametrize("name", TOML_READERS)
def test_a_fifo_named_as_a_settings_file_does_not_hang(name, tmp_path):
    assert isinstance(error_on_fifo(TOML_READERS[name], tmp_path / "x.toml"), Exception)


@pytest.mark.parametrize("name", TOML_READERS)
def test_a_settings_file_of_many_megabytes_is_refused_by_its_size(name, tmp_path):
    file = tmp_path / "x.toml"
    with file.open("wb") as sparse:
        sparse.truncate(64 << 20)
    assert re.search("at most|more than 1 MiB", refusal(TOML_READERS[name], file))


def test_a_document_comes_back_as_it_was_written(tmp_path):
    content = {"a": [1, 2.5, "ü"], "b": {"c": True}}
    (tmp_path / "x.json").write_text(json.dumps(content))
    assert read_json_document(tmp_path / "x.json") == content
    (tmp_path / "x.toml").write_text('a = [1, 2.5, "ü"]\nb.c = true\n')
    assert read_toml_document(tmp_path / "x.toml") == content


@pytest.mark.parametrize(("read", "kind"), [(read_json_document, "JSON"),
                                            (read_toml_document, "TOML")])  # fmt: skip
def test_what_is_no_document_is_named_and_what_is_missing_comes_with_advice(read, kind, tmp_path):
    with pytest.raises(NotFound, match="make one"):
        read(tmp_path / "x", advice="make one")
    (tmp_path / "x").write_text("{")
    assert f"cannot be read as {kind}" in refusal(read, tmp_path / "x")


def test_what_json_does_not_know_is_written_plainly():
    content = {
        "nan": math.nan, "array": np.array([1.0, np.inf]), "count": np.int64(3),
        "path": Path("a/b"), "caf\udce9": True,
    }  # fmt: skip
    assert json.loads(json_text(content)) == {
        "nan": None, "array": [1.0, None], "count": 3, "path": "a/b", r"caf\udce9": True,
    }  # fmt: skip
