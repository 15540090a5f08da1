# SPDX-License-Identifier: MIT
"""The manifest of a result folder is read if it is of the expected kind and schema."""

import json
import re

import pytest

from zebro_lab.files.errors import DataError, NotFound
from zebro_lab.files.folder_manifest import changed_output, read_folder_manifest, read_json_object
from zebro_lab.files.result_folder import ResultKind, result_folder


def read(file):
    return read_folder_manifest(file, of="walk", kinds=("walk", "prediction"), schema=2)


@pytest.fixture
def file(tmp_path):
    return tmp_path / "manifest.json"


@pytest.mark.parametrize("kind", ["walk", "prediction"])
def test_a_manifest_of_an_expected_kind_is_returned_whole(file, kind):
    content = {"kind": kind, "schema": 2, "settings": {"dt": 0.01}}
    file.write_text(json.dumps(content))
    assert read(file) == content


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (
            {"kind": "track", "schema": 2},
            "is not a manifest of a walk: expected 'kind' walk or prediction, found track",
        ),
        ({"kind": ["walk"], "schema": 2}, "is not a manifest of a walk"),
        ({"schema": 2}, "is not a manifest of a walk"),
        ({"kind": "walk", "schema": 3}, "has schema 3; this version of zebro-lab reads schema 2"),
        ({"kind": "walk"}, "has schema missing"),
        (["kind", "walk"], "is not a JSON object"),
    ],
)
def test_a_manifest_of_another_kind_or_schema_is_refused(file, content, message):
    file.write_text(json.dumps(content))
    with pytest.raises(DataError, match=message) as raised:
        read(file)
    assert raised.value.file == file


def test_a_folder_without_its_file_is_none_of_the_kind(file):
    with pytest.raises(NotFound, match=r"is not a run folder: manifest\.json is missing"):
        read_json_object(file, of="run folder")


def test_a_folder_of_such_folders_names_one_to_give(file):
    for name in ("b", "a"):
        (file.parent / name).mkdir()
        (file.parent / name / file.name).write_text("{}")
    said = f"manifest.json is missing; give one of the folders in it, such as {file.parent / 'a'}"
    with pytest.raises(NotFound, match=re.escape(said)):
        read_json_object(file, of="run folder")


def test_a_file_that_was_changed_after_it_was_written_is_told(tmp_path):
    with result_folder(tmp_path / "walk", ResultKind("walk", "walk", ("a",)), content={}) as draft:
        (draft / "a").write_text("1")
    file = tmp_path / "walk" / "a"
    assert changed_output(file) == ()
    file.write_text("2")
    (told,) = changed_output(file)
    assert told.startswith(f"{file} was changed after it was written")
    (tmp_path / "walk" / "b").write_text("mine")
    assert changed_output(tmp_path / "walk" / "b") == ()
    file.unlink()
    assert changed_output(file) == ()
