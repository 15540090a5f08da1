# SPDX-License-Identifier: MIT
"""A run's manifest is read back as it was written, and what is wrong in it is named."""

import json
import math
from pathlib import Path

import pytest

from support.bounded_reading import refusal
from zebro_lab.runs.manifest import (
    RunManifest,
    manifest_text,
    read_manifest,
    software_version,
    write_manifest,
)

RUN = {
    "schema_version": 1, "kind": "walk", "label": "x", "material": "x", "operator": "x",
    "source": "real", "start": "2026-01-01T00:00:00+00:00", "exit_status": "completed",
    "software": {"version": "1"}, "constants": {"radius_leg": 0.035}, "streams": {"/a/raw": 3},
    "stop": "2026-01-01T00:00:01+00:00",
}  # fmt: skip


def run_json(folder: Path, text: str) -> Path:
    (folder / "run.json").write_text(text)
    return folder


def test_a_manifest_is_read_back_as_it_was_written(tmp_path):
    written = RunManifest(
        kind="walk", label="caf\udce9", material="x", operator="ü", source="sim:zebro",
        start="2026-01-01T00:00:00+00:00", stop=None, exit_status="recording",
        software=software_version(), constants={}, streams={"/legs/raw": 3},
        exclusions=({"did": "excluded", "why": "belt"},), duration={"/legs/raw": 0.5},
    )  # fmt: skip
    write_manifest(tmp_path, written)
    read = read_manifest(tmp_path)
    assert read.label == r"caf\udce9"
    assert manifest_text(read) == manifest_text(written)
    assert "truth" not in (tmp_path / "run.json").read_text()


REQUIRED = {
    **dict.fromkeys(
        ("kind", "label", "material", "operator", "source", "start", "exit_status"), "a text"
    ),
    **dict.fromkeys(("software", "constants", "streams"), "an object"),
}
NO_MOMENTS = ("yesterday", "", "2026-01-01", "2026-01-01T00:00:00", "9999-99-99T99:99:99+00:00",
              "0001-01-01T00:00:00+23:00")  # fmt: skip
FAULTS = [
    *(({name: ...}, f"'{name}' is missing, expected {kind}") for name, kind in REQUIRED.items()),
    *(({"start": start}, "expected a date and time with a time zone") for start in NO_MOMENTS),
    ({"stop": "tomorrow"}, "'stop'"),
    ({"streams": {"/a/raw": "many"}}, "'streams'"),
    ({"streams": {"/a/raw": [1]}}, "'streams'"),
    ({"excluded": {"why": ["x"]}}, "'excluded'"),
    ({"constants": {"radius_leg": "5"}}, "'constants' has 'radius_leg': '5', expected a number"),
    ({"profiles": {"legs": 3}}, "'profiles'"),
    ({"counters": {"legs": 3}}, "'counters'"),
    ({"clocks": {"legs": {"offset": "x"}}}, "'clocks' has 'legs.offset': 'x', expected a number"),
    ({"label": "caf\udce9"}, "surrogate"),
    ({"schema_version": 2}, "'schema_version' is 2, expected 1"),
    ({"schema_version": None}, "'schema_version' is null"),
    ({"operator": 3}, "'operator' is 3, expected a text"),
    ({"seed": True}, "'seed' is true, expected a whole number"),
    ({"operator": None}, "'operator' is null, expected a text"),
    ({"kind": "slip_rig"}, "'kind' is 'slip_rig'; did you mean 'slip-rig'"),
    ({"exclusions": [{"did": "excluded"}]}, "an entry of 'exclusions' lacks 'did' or 'why'"),
]


@pytest.mark.parametrize(("change", "message"), FAULTS)
def test_a_manifest_of_another_form_is_named(change, message, tmp_path):
    entries = {name: value for name, value in (RUN | change).items() if value is not ...}
    found = refusal(read_manifest, run_json(tmp_path, json.dumps(entries)))
    assert found.startswith(str(tmp_path / "run.json"))
    assert message in found


def test_an_unknown_number_is_left_out_but_an_unknown_constant_stays_unknown(tmp_path):
    unknown = {
        "constants": {"zero_normal": math.nan}, "stop": None,
        "clocks": {"legs": {"offset": 1.0, "delay": math.nan}},
        "counters": {"legs": {"received": 1, "lost": None}},
        "exclusions": ({"did": "excluded", "why": "belt", "at": None},),
    }  # fmt: skip
    write_manifest(tmp_path, RunManifest(**(RUN | unknown)))
    read = read_manifest(tmp_path)
    assert math.isnan(read.constants["zero_normal"])
    assert read.clocks == {"legs": {"offset": 1.0}}
    assert read.counters == {"legs": {"received": 1}}
    assert read.exclusions == [{"did": "excluded", "why": "belt"}]
