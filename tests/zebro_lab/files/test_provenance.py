# SPDX-License-Identifier: MIT
"""Hashes tie a result to the contents it was made from, wherever they lie."""

import hashlib
import json

from hypothesis import given
from hypothesis import strategies as st

from zebro_lab.files.provenance import RECORDED, file_hash, file_hashes, fingerprint, software

SETTINGS = {"law": "brush", "seed": 1, "load_cell": {"gain_sd": 0.01}, "block_length": None}
HASHES = {"a.csv": "1" * 64, "b.csv": "2" * 64}


def test_file_hash_is_sha_256_of_the_content(tmp_path):
    (tmp_path / "a").write_bytes(b"slip\x00" * 100_000)
    assert file_hash(tmp_path / "a") == hashlib.sha256(b"slip\x00" * 100_000).hexdigest()


def test_hashes_are_by_path_as_given(tmp_path, monkeypatch):
    (tmp_path / "a").write_bytes(b"1")
    monkeypatch.chdir(tmp_path)
    relative = (tmp_path / "a").relative_to(tmp_path)
    assert file_hashes([relative]) == {"a": file_hash(tmp_path / "a")}


def test_fingerprint_ignores_names_and_order():
    renamed = {"elsewhere/z.csv": HASHES["a.csv"], "b.csv": HASHES["b.csv"]}
    assert fingerprint(renamed, SETTINGS) == fingerprint(HASHES, SETTINGS)
    turned = dict(reversed(SETTINGS.items()))
    assert fingerprint(HASHES, turned) == fingerprint(HASHES, SETTINGS)


@given(st.sampled_from(sorted(HASHES)), st.text("0123456789abcdef", min_size=64, max_size=64))
def test_fingerprint_changes_with_any_content(name, digest):
    changed = {**HASHES, name: digest}
    same = sorted(changed.values()) == sorted(HASHES.values())
    assert (fingerprint(changed, SETTINGS) == fingerprint(HASHES, SETTINGS)) == same


@given(
    st.sampled_from(sorted(SETTINGS)),
    st.none() | st.integers() | st.text() | st.dictionaries(st.text(), st.floats(allow_nan=False)),
)
def test_fingerprint_changes_with_any_setting(name, value):
    changed = {**SETTINGS, name: value}
    assert (fingerprint(HASHES, changed) == fingerprint(HASHES, SETTINGS)) == (
        json.dumps(value) == json.dumps(SETTINGS[name])
    )


def test_software_names_commit_and_every_version_that_decides_numbers():
    versions = software()
    assert versions.keys() == {"python", *RECORDED, "commit"}
    assert all(versions.values())
