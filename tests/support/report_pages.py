# SPDX-License-Identifier: MIT
"""Results with random numbers, the page that reports on them, and what that page holds."""

import json
from datetime import UTC, datetime
from html.parser import HTMLParser

import numpy as np
from PIL import Image

from zebro_lab.report.request import ReportRequest
from zebro_lab.report.stage import report

MADE = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)


VOID = {"meta", "img", "br", "wbr", "link", "input", "hr"}


HOSTILE = '<script>alert("x")</script> & "quotes"'


SLIP = """
slip_definition = "material"
[verdict]
headline = "weak: <shape>"
next_steps = ["slip more:\\n[points]\\nslips = [0.01]"]
[law]
name = "magic-formula"
[tested]
samples = 620
runs = 24
normal_force = [2.1, 12.7]
slip_ratio = [-0.01, 0.9]
[parameters.shape]
symbol = "C"
unit = "dimensionless"
median = 1.5623
q05 = 1.5511
q95 = 1.5737
"""


class Page(HTMLParser):
    """What a page holds: tags with their attributes, balanced, and numbers with their text."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.open, self.numbers, self.text = [], [], [], ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)
        if tag == "data":
            self.numbers.append([dict(attrs), ""])

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data
        if self.open and self.open[-1] == "data":
            self.numbers[-1][1] += data

    def all(self, tag):
        return [attrs for name, attrs in self.tags if name == tag]


def write_json(file, content):
    """Write a JSON file and the folders that it lies in."""
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(content))


def picture(file, *, rng):
    pixels = rng.integers(0, 255, (4, 4, 3), dtype=np.uint8)
    Image.fromarray(pixels).save(file)


def part(folder, kind, rng, *, pictures=(), **content):
    shown = dict.fromkeys(pictures, "0" * 64)
    write_json(folder / "manifest.json", {
        "schema": 1, "kind": kind, "source": "sim:test", "settings": {},
        "inputs": {"a.csv": "1" * 64}, "outputs": shown, "software": {"numpy": "2"}, **content,
    })  # fmt: skip
    for name in pictures:
        picture(folder / name, rng=rng)


def change_manifest(folder, **content):
    """Replace values of a folder's manifest."""
    file = folder / "manifest.json"
    write_json(file, {**json.loads(file.read_text()), **content})


def metrics(rng):
    names = ["ate_m", "ate_of_length", "x_rms_m", "y_rms_m", "along_rms_m", "cross_rms_m",
             "yaw_rms_deg", "final_m", "ate_aligned_m", "radius_m", "radius_tracked_m", "length_m",
             "yaw_rate_deg_s", "crps_x_m", "crps_y_m", "energy_m", "nees", "nees_low", "nees_high",
             "nees_p", "along_p", "cross_p", "yaw_p"]  # fmt: skip
    names += [f"coverage{level}_{s}" for level in (50, 90, 95) for s in ("x", "y", "yaw")]
    names += [f"width{level}_{s}" for level in (50, 90, 95) for s in ("x_m", "y_m", "yaw_deg")]
    return {name: float(rng.uniform(0.001, 9)) for name in names}


def made(run, **asked):
    """Report on a run, and return the page."""
    out = run.parent / "report.html"
    asked = {"calibration": run.parent / "calibration", "out": out, **asked}
    report(ReportRequest(run, **asked), made=MADE)
    return Page(out.read_text())
