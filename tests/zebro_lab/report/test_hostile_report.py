# SPDX-License-Identifier: MIT
"""A report of a folder that somebody wrote to do harm: no script, no other file, one line of fault.

The page is also loaded in Chromium where there is one: nothing else knows for sure what runs.
"""

import base64
import json
import re
import shutil
import subprocess
from datetime import UTC, datetime
from pathlib import Path

import pytest
from PIL import Image

from support.commands import COMMAND
from support.report_pages import change_manifest, write_json
from zebro_lab.files.errors import DataError
from zebro_lab.report.request import ReportRequest
from zebro_lab.report.stage import report

MADE = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)
MARK = "document.title='OWNED'"
HARM = (
    f"<script>{MARK}</script>",
    f'"onerror={MARK}//',
    f"'><img src=x onerror={MARK}>",
    f"javascript:{MARK}",
    f"</style><script>{MARK}</script>",
    f"</title><script>{MARK}</script>",
    "{{ 7*7 }}{% raw %}{{ config }}",
    f"<svg/onload={MARK}>",
    "\u202egnp.exe \u2066x\u2069 \x1b[2J\x1b[31m\x00\x07",
    "a\nb\rc\u2028d",
)
ALL = " ".join(HARM)
CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)


KEPT = ("kind", "schema")
"""Keys of manifests whose values are compared: with others the page would not be made at all."""


def spoiled(value: object, key: str = "") -> object:
    """Return the content of a manifest with harm in place of every text."""
    if isinstance(value, dict):
        return {name: spoiled(each, name) for name, each in value.items()}
    return ALL if isinstance(value, str) and key not in KEPT else value


@pytest.fixture
def secret(tmp_path) -> bytes:
    """Return the bytes of a picture outside the run."""
    Image.new("RGB", (7, 7), (1, 2, 3)).save(tmp_path / "secret.png")
    return (tmp_path / "secret.png").read_bytes()


@pytest.fixture
def run(walk, tmp_path, secret) -> Path:
    """Return a folder of a run with harm in every text, and a calibration beside it."""
    folder = walk.rename(tmp_path / "run <b>&amp; ${HOME}")
    for file in (*folder.rglob("*.json"), *(tmp_path / "calibration").glob("*.json")):
        write_json(file, spoiled(json.loads(file.read_text())))
    write_json(folder / "run.json", {"kind": "walk", "label": ALL, "exit_status": ALL,
                                     "streams": {ALL: 3}, "excluded": {"why": ALL}})  # fmt: skip
    row = {"ate_m": 0.01, "coverage90_x": 0.9, "nees": 1.0}
    change_manifest(folder / "validation", runs={ALL: {ALL: row, "prediction": row}}, outputs={})
    hostile_name = "<img src=x onerror=document.title='OWNED'>.png"
    outside = ("../../secret.png", str(tmp_path / "secret.png"), "link.png",
               "x/../../../secret.png")  # fmt: skip
    change_manifest(folder / "track", outputs=dict.fromkeys((*outside, hostile_name), ALL))
    change_manifest(folder / "prediction", outputs={})
    (folder / "track/x").mkdir()
    (folder / "track/link.png").symlink_to(tmp_path / "secret.png")
    Image.new("RGB", (5, 5)).save(folder / "track" / hostile_name)
    slip = tmp_path / "calibration/slip.toml"
    slip.write_text(re.sub(r'= "[^"]*"', lambda _: f"= {json.dumps(ALL)}", slip.read_text()))
    change_manifest(tmp_path / "calibration", outputs={})
    return folder


def page_of(run: Path) -> str:
    out = run.parent / "report.html"
    calibration = run.parent / "calibration"
    report(ReportRequest(run, calibration=calibration, out=out, title=ALL), made=MADE)
    return out.read_text()


def test_pictures_outside_the_folder_are_left_out_and_named(run, secret):
    page = page_of(run)
    assert base64.b64encode(secret).decode() not in page
    assert page.count("data:image/webp") == 1
    assert "Picture not shown" in page


def test_marks_of_direction_and_controls_are_spelled_out(run):
    page = page_of(run)
    assert not set("\u202e\u2066\u2069\x1b\x00\x07\u2028") & set(page)
    assert "\\u202egnp.exe" in page


SWAPPED = {
    "runs": {"validation/manifest.json": {"runs": 5}},
    "no row": {"validation/manifest.json": {"runs": {"a": {}}}},
    "settings": {"prediction/manifest.json": {"settings": [1]}},
    "slip": {"prediction/manifest.json": {"settings": {"model": "x", "slip": 3}}},
    "left out": {"track/manifest.json": {"left_out": [1]}},
    "outputs": {"track/manifest.json": {"outputs": 3}},
    "kind": {"track/manifest.json": {"kind": ["track"]}},
    "recorded": {"run.json": {"streams": 3}},
    "excluded": {"run.json": {"excluded": "yes"}},
}


@pytest.mark.parametrize("name", SWAPPED)
def test_values_of_another_type_are_named_in_one_line(name, run):
    if name == "left out":
        run.joinpath("track/manifest.json").unlink()
    for file, change in SWAPPED[name].items():
        content = json.loads((run / file).read_text()) if (run / file).is_file() else {}
        write_json(run / file, {"kind": "track", **content, **change})
    with pytest.raises(DataError) as raised:
        page_of(run)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(
    ("file", "text"),
    [
        ("slip.toml", "verdict = 3\n"),
        ("slip.toml", "parameters = [1]\n"),
        ("slip.toml", ""),
    ],
    ids=["verdict", "parameters", "empty"],
)
def test_a_calibration_that_lacks_what_is_shown_is_named_in_one_line(file, text, run):
    (run.parent / "calibration" / file).write_text(text)
    with pytest.raises(DataError) as raised:
        page_of(run)
    assert "\n" not in str(raised.value)


@pytest.mark.browser
@pytest.mark.skipif(CHROMIUM is None, reason="no Chromium is at hand")
def test_nothing_of_a_hostile_run_runs_in_a_browser(run, secret, tmp_path):
    out = tmp_path / "report.html"
    subprocess.run(
        [COMMAND, "report", run, "--calibration",
         run.parent / "calibration", "--out", out, "--title", HARM[0] + HARM[5]],
        check=True, capture_output=True,
    )  # fmt: skip
    loaded = in_chromium(out, tmp_path / "profile")
    assert "OWNED" not in loaded.partition("<title>")[2].partition("</title>")[0].replace(
        "document.title='OWNED'", ""
    )
    assert base64.b64encode(secret).decode() not in loaded
    assert "<script" not in loaded
    # The same page with a script of ours in it: the policy stops it, and the browser runs scripts.
    script = "<script>document.documentElement.dataset.ran='yes'</script>"
    with_script = tmp_path / "with.html"
    with_script.write_text(out.read_text().replace("<body>", f"<body>{script}"))
    assert 'data-ran="yes"' not in in_chromium(with_script, tmp_path / "profile")
    bare = tmp_path / "bare.html"
    bare.write_text(f"<!DOCTYPE html><html><body>{script}</body></html>")
    assert 'data-ran="yes"' in in_chromium(bare, tmp_path / "profile")


def in_chromium(file: Path, profile: Path) -> str:
    """Load a page, let it run for three seconds, and return its document as it is then."""
    return subprocess.run(
        [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic",
         "--no-first-run", "--disable-background-networking", "--disable-component-update",
         "--disable-sync", f"--user-data-dir={profile}", "--virtual-time-budget=3000",
         "--dump-dom", file.as_uri()],
        check=True, capture_output=True, text=True, timeout=60,
    ).stdout  # fmt: skip
