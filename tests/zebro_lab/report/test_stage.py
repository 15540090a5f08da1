# SPDX-License-Identifier: MIT
"""Reports: whole in themselves, escaped, and with the numbers of the files they are from."""

import base64
import csv
import json
import tomllib
from datetime import UTC, datetime
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from zebro_lab.files.errors import AlreadyExists, DataError, NotFound
from zebro_lab.report.numbers import spelled
from zebro_lab.report.request import ReportRequest
from zebro_lab.report.stage import report

MADE = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)
VOID = {"meta", "img", "br", "link", "input", "hr"}
HOSTILE = '<script>alert("x")</script> & "quotes"'


SLIP = """
slip_definition = "material"
[verdict]
headline = "weak: <shape>"
next_steps = ["slip more"]
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


def metrics(rng):
    names = ["ate_m", "ate_of_length", "x_rms_m", "y_rms_m", "along_rms_m", "cross_rms_m",
             "yaw_rms_deg", "final_m", "ate_aligned_m", "radius_m", "radius_tracked_m", "length_m",
             "yaw_rate_deg_s", "crps_x_m", "crps_y_m", "energy_m", "nees", "nees_low", "nees_high",
             "nees_p", "along_p", "cross_p", "yaw_p"]  # fmt: skip
    names += [f"coverage{level}_{s}" for level in (50, 90, 95) for s in ("x", "y", "yaw")]
    names += [f"width{level}_{s}" for level in (50, 90, 95) for s in ("x_m", "y_m", "yaw_deg")]
    return {name: float(rng.uniform(0.001, 9)) for name in names}


@pytest.fixture
def walk(tmp_path) -> Path:
    """Return a folder with every part of a walk and a calibration, all numbers random."""
    rng = np.random.default_rng(7)
    run = tmp_path / "run"
    write_json(run / "run.json", {
        "kind": "walk", "label": HOSTILE, "source": "sim:robot", "streams": {"/legs/raw": 1234},
    })  # fmt: skip
    rows = {"prediction": metrics(rng), "stand still": {**metrics(rng), "radius_m": None}}
    imu = {f"{a}_{k}_deg": float(rng.uniform(0, 1)) for a in ("roll", "pitch")
           for k in ("bias", "rms", "rms_unbiased", "swing")}  # fmt: skip
    part(run / "validation", "validation", rng, pictures=["run.png", "run.photos.png"],
         runs={"run": rows}, imu={"run": imu})  # fmt: skip
    part(run / "track", "track", rng, pictures=["map.png"], photos=16, tracked=15,
         left_out={"p<3>.jpg": "no marker"}, floor_misfit_px=0.02, times="EXIF")  # fmt: skip
    part(run / "prediction", "predict", rng, pictures=["band.png"],
         settings={"model": "dynamics", "slip": {"named": "calibration", "source": "sim:rig"},
                   "leg_angles": "sim:robot", "band": {"draws": 300}})  # fmt: skip
    calibration = tmp_path / "calibration"
    part(calibration, "calibration", rng, pictures=["curves.png", "corner.png"])
    (calibration / "slip.toml").write_text(SLIP)
    (calibration / "summary.csv").write_text(
        'parameter,contraction,r_hat,ess_bulk,prior\nshape,0.9911,1.0007,9796,"uniform(1, 2)"\n'
    )
    return run


def made(run, **asked):
    out = run.parent / "report.html"
    asked = {"calibration": run.parent / "calibration", "out": out, **asked}
    report(ReportRequest(run, **asked), made=MADE)
    return Page(out.read_text())


def test_the_page_needs_no_other_file_and_no_network(walk):
    page = made(walk)
    assert not page.all("script")
    assert not page.all("link")
    addresses = [
        attrs[key] for _, attrs in page.tags for key in ("src", "href", "srcset") if key in attrs
    ]
    assert addresses
    assert all(each.startswith(("data:image/png;base64,", "#")) for each in addresses)
    style = (walk.parent / "report.html").read_text().split("</style>")[0]
    assert "url(" not in style
    assert "@import" not in style


def test_every_picture_is_embedded_as_it_is_and_described(walk):
    page = made(walk)
    shown = [base64.b64decode(img["src"].partition(",")[2]) for img in page.all("img")]
    expected = [file.read_bytes() for file in walk.parent.rglob("*.png")]
    assert sorted(shown) == sorted(expected)
    assert all(len(img["alt"]) > 20 and "simulated" in img["alt"] for img in page.all("img"))


def look_up(file, key):
    path = Path(file)
    text = path.read_text()
    if path.suffix == ".csv":
        content = {row["parameter"]: row for row in csv.DictReader(text.splitlines())}
    else:
        content = tomllib.loads(text) if path.suffix == ".toml" else json.loads(text)
    for step in key.split("/")[1:]:
        step = step.replace("~1", "/").replace("~0", "~")
        content = content[int(step)] if isinstance(content, list) else content[step]
    return float(content)


def test_every_number_is_that_of_the_file_it_names(walk):
    page = made(walk)
    assert len(page.numbers) > 80
    for attrs, text in page.numbers:
        value = look_up(attrs["data-file"], attrs["data-key"])
        assert float(attrs["value"]) == value
        ratio = float(text) / value
        assert min(abs(ratio / scale - 1) for scale in (1, 100, 1000)) < 0.006, (attrs, text)


def test_errors_and_bands_of_every_model_are_in_the_tables(walk):
    rows = json.loads((walk / "validation/manifest.json").read_text())["runs"]["run"]
    keys = {attrs["data-key"] for attrs, _ in made(walk).numbers}
    for model in rows:
        assert {
            f"/runs/run/{model}/{name}" for name in ("ate_m", "yaw_rms_deg", "energy_m")
        } <= keys
    assert "/runs/run/prediction/coverage90_yaw" in keys
    assert "/imu/run/pitch_rms_unbiased_deg" in keys


def test_what_operators_write_is_text_and_never_markup(walk):
    page = made(walk, title=HOSTILE)
    assert HOSTILE in page.text
    assert "p<3>.jpg" in page.text
    assert not page.all("script")


def test_simulated_sources_stand_in_the_title_and_on_top(walk):
    page = made(walk)
    title = (walk.parent / "report.html").read_text().split("<title>")[1]
    assert title.startswith("SIMULATED")
    assert "SIMULATED: sim:robot, sim:test" in page.text


def test_missing_parts_are_named_with_the_command_that_makes_them(walk):
    for name in ("track", "prediction"):
        (walk / name / "manifest.json").unlink()
    page = made(walk, calibration=walk.parent / "nowhere")
    for command in ("zebro-lab track", "zebro-lab predict", "zebro-lab calibrate"):
        assert command in page.text
    assert "zebro-lab validate" not in page.text


def test_a_folder_of_runs_is_one_page(walk, tmp_path):
    data = tmp_path / "data"
    data.mkdir()
    walk.rename(data / "a")
    write_json(data / "b" / "run.json", {"kind": "slip-rig", "label": "sweep", "streams": {}})
    page = made(data, calibration=tmp_path / "calibration")
    sections = [attrs["id"] for attrs in page.all("section")]
    assert sections == ["run", "slip", "walk-1", "together", "provenance"]
    assert "sweep" in page.text


def test_pages_tell_their_parts_to_readers_and_screen_readers(walk):
    page = made(walk)
    assert page.all("html")[0]["lang"] == "en"
    assert "width=device-width" in str(page.all("meta"))
    ids = {attrs["id"] for _, attrs in page.tags if "id" in attrs}
    assert {attrs["href"][1:] for attrs in page.all("a")} <= ids
    assert {attrs["aria-labelledby"] for attrs in page.all("section")} <= ids
    assert all(attrs.get("scope") in ("col", "row") for attrs in page.all("th"))


def test_bad_input_leaves_no_page(walk, tmp_path):
    empty = tmp_path / "empty"
    empty.mkdir()
    with pytest.raises(NotFound, match=r"run\.json"):
        made(empty, out=tmp_path / "r.html")
    (walk / "track/manifest.json").write_text("{")
    with pytest.raises(DataError, match="make it again"):
        made(walk, out=tmp_path / "r.html")
    with pytest.raises(AlreadyExists, match="is a folder"):
        made(walk, out=empty)
    with pytest.raises(NotFound, match="--out"):
        made(walk, out=tmp_path / "no" / "r.html")
    assert not (tmp_path / "r.html").exists()


def test_a_foreign_manifest_is_refused(walk):
    write_json(walk / "track/manifest.json", {"kind": "predict"})
    with pytest.raises(DataError, match="another command"):
        made(walk)


def test_counts_are_spelled_whole_and_other_numbers_rounded():
    assert (spelled(62000), spelled(0.012345), spelled(-1234.5, 2)) == ("62000", "0.0123", "-1200")
