# SPDX-License-Identifier: MIT
"""Readers of JSON, and what a report reads."""

from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from benchmarks.faults.fuzzed_readers.bombs import json_bombs
from benchmarks.faults.fuzzed_readers.reader import (
    Reader,
    csv_check,
    json_check,
    text_check,
    toml_check,
)
from benchmarks.faults.fuzzed_readers.settings import slip_document
from benchmarks.faults.hostile_inputs import (
    as_json,
    as_toml,
    documents,
    tables,
)
from zebro_lab.experiment.journal import JOURNAL_FILE, read_journal
from zebro_lab.report.page import render_report
from zebro_lab.report.sources import find_sources
from zebro_lab.runs.manifest import read_manifest
from zebro_lab.runs.stage import list_runs
from zebro_lab.track.folder import read_track_manifest
from zebro_lab.walk.folder import read_walk_manifest

RUN = {
    "schema_version": 1, "kind": "walk", "label": "x", "material": "x", "operator": "x",
    "source": "real", "start": "2026-01-01T00:00:00+00:00", "exit_status": "completed",
    "software": {"version": "1"}, "constants": {"radius_leg": 0.035}, "streams": {"/a/raw": 3},
    "stop": "2026-01-01T00:00:01+00:00", "log_sha256": "0" * 64, "robot": "x", "profiles": {},
    "sources": {"legs": "real"}, "counters": {"legs": {"lost": 1}}, "clocks": {"legs": {"a": 1.0}},
    "truth": {}, "inputs": {"a": "b"}, "excluded": {"why": "x"},
}  # fmt: skip


def _listed(file: Path) -> object:
    read_manifest(file.parent)
    return list_runs(file.parent)


def of_manifests() -> Mapping[str, Reader]:
    """Return readers of JSON."""
    manifest = {
        "schema": 1, "kind": "track", "source": "real", "settings": {}, "inputs": {"a": "b"},
        "outputs": {"a.png": "0"}, "software": {}, "notes": ["x"],
    }  # fmt: skip
    walk = manifest | {"kind": "predict"}
    events = [{"kind": "plan", "fingerprint": "a", "text": "x"},
              {"kind": "point", "number": 3, "accepted": True, "folder": "a"},
              {"kind": "end", "text": "emergency stop: x"}]  # fmt: skip

    def journal(rng: np.random.Generator) -> bytes:
        one = documents(as_json, *events)
        return b"\n".join([as_json(events[0]), *(one(rng) for _ in range(int(rng.integers(4))))])

    return {
        "run.json": Reader("run.json", _listed, documents(as_json, RUN), json_check,
                           special=json_bombs),
        "track's manifest": Reader("manifest.json", lambda f: read_track_manifest(f.parent),
                                   documents(as_json, manifest), json_check, special=json_bombs),
        "walk's manifest": Reader("manifest.json", lambda f: read_walk_manifest(f.parent),
                                  documents(as_json, walk), json_check, special=json_bombs),
        "journal": Reader(JOURNAL_FILE, lambda f: read_journal(f.parent), journal, text_check),
    }  # fmt: skip


def of_reports() -> Mapping[str, Reader]:
    """Return readers of what a report shows."""
    row = {"ate_m": 0.01, "coverage90_x": 0.9, "nees": 1.0}
    validation = {
        "schema": 1, "kind": "validation", "source": "sim:x", "settings": {}, "inputs": {"a": "b"},
        "outputs": {"a.png": "0"}, "software": {"numpy": "2"}, "notes": ["x"],
        "runs": {"a": {"prediction": row, "stand still": row}}, "imu": {"a": {"roll_bias_deg": 1}},
    }  # fmt: skip

    def render(folder: Path) -> object:
        sources = find_sources(folder / "run", calibration=folder / "calibration")
        return render_report(sources, title="x", made=datetime(2026, 1, 1, tzinfo=UTC))

    def prepare(folder: Path) -> None:
        for name, content in (
            ("run/run.json", RUN),
            ("run/validation/manifest.json", validation),
            ("calibration/manifest.json", validation | {"kind": "calibration"}),
        ):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(as_json(content))
        (folder / "calibration/slip.toml").write_bytes(as_toml(reported))
        (folder / "calibration/summary.csv").write_text("parameter,prior\nfriction,x\n")

    reported = slip_document() | {
        "verdict": {"headline": "x", "next_steps": ["y"]},
        "parameters": {"friction": {"symbol": "x", "unit": "-", "median": 1.0}},
        "tested": {"normal_force": [1, 2], "slip_ratio": [0, 1], "runs": 3, "samples": 4},
    }
    summary = {"parameter": ["friction", "a"], "prior": ["x", "y"], "r_hat": [1.0, 2.0]}
    return {
        "report: validation": Reader("run/validation/manifest.json",
                                     lambda f: render(f.parents[2]),
                                     documents(as_json, validation), json_check, prepare=prepare),
        "report: slip.toml": Reader("calibration/slip.toml", lambda f: render(f.parents[1]),
                                    documents(as_toml, reported), toml_check, prepare=prepare),
        "report: summary.csv": Reader("calibration/summary.csv", lambda f: render(f.parents[1]),
                                      tables(summary), csv_check, prepare=prepare),
    }  # fmt: skip
