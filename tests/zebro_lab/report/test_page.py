# SPDX-License-Identifier: MIT
"""A page is escaped, says what is simulated, and tells its parts to every reader."""

import base64
import csv
import hashlib
import json
import re
import tomllib
from pathlib import Path

import pytest

from support.report_pages import MADE, change_manifest, made, write_json
from zebro_lab.report.page import ABSENT, number, out_of_range, render_report
from zebro_lab.report.sources import find_sources

WALKS = """
effective_draws = 900.0
reliable = true
not_informed = ["offset_1"]
walk = [{name = "one"}]
[[parameter]]
name = "offset_1"
unit = "rad"
prior_sd = 0.1
mean = 0.01
sd = 0.1
informed = -0.01
[[parameter]]
name = "fall"
unit = "-"
prior_sd = 0.3
mean = 0.2
sd = 0.2
informed = 0.5
[[case]]
name = "leg 1 wrong"
probability = 0.001
[[case]]
name = "leg 2 wrong"
probability = 0.5
"""


def test_coverage_out_of_its_range_stands_in_the_headline_with_what_is_expected(walk):
    file = walk / "validation/manifest.json"
    manifest = json.loads(file.read_text())
    row = manifest["runs"]["run"]["prediction"]
    states = [f"coverage{level}_{state}" for level in (50, 90, 95) for state in ("x", "y", "yaw")]
    row.update({name: int(name[8:10]) / 100 for name in states}, poses=100.0, nees_p=0.3)
    file.write_text(json.dumps(manifest))
    assert "out of range" not in made(walk).text
    row["coverage90_y"] = 0.7
    file.write_text(json.dumps(manifest))
    text = " ".join(made(walk).text.split())
    assert "the 90 % band holds 70 % of y, expected 84 to 95 %. This range is that of 100" in text
    assert "the band is consistent with the track (p 0.3)" in text


def test_simulated_sources_stand_in_the_title_and_on_top(walk):
    page = made(walk)
    title = (walk.parent / "report.html").read_text().split("<title>")[1]
    assert title.startswith("SIMULATED")
    assert "SIMULATED: sim:rig, sim:robot, sim:test" in page.text


@pytest.mark.parametrize("rig", ["real", "sim:rig"])
def test_a_prediction_from_measured_data_is_simulated_only_where_data_are(walk, rig):
    for name in ("track", "validation", "../calibration"):
        change_manifest(walk / name, source="real")
    slip = {"named": "calibration", "source": rig}
    settings = {"model": "dynamics", "slip": slip, "leg_angles": "real"}
    change_manifest(walk / "prediction", source="sim:dynamics", settings=settings)
    write_json(walk / "run.json", {"kind": "walk", "source": "real", "streams": {}})
    page = made(walk)
    assert ("SIMULATED: sim:rig. " in page.text) == (rig == "sim:rig")
    assert ("SIMULATED" in page.text) == (rig == "sim:rig")


def test_a_doubt_of_what_a_prediction_used_stands_beside_it(walk):
    doubt = "WARNING: the fit of walks in c/walks is not reliable: 2 effective draws"
    change_manifest(walk / "prediction", settings={"model": "dynamics", "doubts": [doubt]})
    assert doubt in made(walk).text


def test_pages_tell_their_parts_to_readers_and_screen_readers(walk):
    page = made(walk)
    assert page.all("html")[0]["lang"] == "en"
    assert "width=device-width" in str(page.all("meta"))
    ids = {attrs["id"] for _, attrs in page.tags if "id" in attrs}
    assert {attrs["href"][1:] for attrs in page.all("a")} <= ids
    assert {attrs["aria-labelledby"] for attrs in page.all("section")} <= ids
    assert all(attrs.get("scope") in ("col", "row") for attrs in page.all("th"))


def test_the_page_is_the_same_whenever_it_is_made_but_for_its_date(walk):
    sources = find_sources(walk, calibration=walk.parent / "calibration")
    first, second = (
        render_report(sources, title="A walk", made=MADE.replace(year=year))
        for year in (2026, 2027)
    )
    assert first != second
    assert first.replace("2026-01-02", "2027-01-02") == second
    assert "<h1" in first
    assert "A walk" in first


def test_the_policy_allows_the_pages_own_style_and_no_other(walk):
    (style,) = re.findall(r"<style>(.*?)</style>", html_of(walk), re.DOTALL)
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    policy = next(meta["content"] for meta in made(walk).all("meta") if "http-equiv" in meta)
    assert f"style-src 'sha256-{digest}'" in policy
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy


def html_of(walk) -> str:
    sources = find_sources(walk, calibration=walk.parent / "calibration")
    return render_report(sources, title="A walk", made=MADE)


def test_legs_and_floor_have_the_units_and_shares_of_the_printed_table(walk):
    walks = walk.parent / "calibration/walks"
    write_json(walks / "manifest.json", {
        "schema": 2, "kind": "walks", "source": "sim:test", "settings": {}, "left_out": {},
    })  # fmt: skip
    (walks / "walks.toml").write_text(WALKS)
    page = made(walk)
    found = {
        attrs["data-key"]: text for attrs, text in page.numbers if "walks" in attrs["data-file"]
    }
    assert found["/parameter/0/sd"] == "5.73"  # degrees
    assert found["/parameter/1/mean"] == "20"  # per cent
    assert (found["/parameter/0/informed"], found["/parameter/1/informed"]) == ("0", "50")
    assert {"/case/1/probability"} == {key for key in found if key.endswith("probability")}
    words = " ".join(page.text.split())
    assert "Mounted wrong: leg 2 wrong" in words


def test_what_a_run_lost_and_dropped_stands_beside_its_samples(walk):
    found = {attrs["data-key"]: text for attrs, text in made(walk).numbers}
    assert found["/streams/~1legs~1raw"] == "1234"
    assert (found["/counters/legs/lost"], found["/counters/legs/dropped"]) == ("56", "7")


WITHIN = {"poses": 14.0, "coverage50_x": 0.5, "coverage90_x": 1.0, "coverage95_yaw": 13 / 14}


@pytest.mark.parametrize(
    ("key", "share"),
    [("coverage90_x", 9 / 14), ("coverage50_y", 1.0), ("coverage50_yaw", 0.0)],
)
def test_bands_too_narrow_and_too_wide_are_out_of_range(key, share):
    (found,) = out_of_range({**WITHIN, key: share})
    assert found.key == key
    assert not found.low <= 100 * share <= found.high


def value_in(file, key):
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
        value = value_in(attrs["data-file"], attrs["data-key"])
        assert float(attrs["value"]) == value
        assert any(
            float(text) == pytest.approx(value * scale, rel=0.006) for scale in (1, 100, 1000)
        ), (attrs, text)


CONTENT = {
    "runs": {"a/b~c": [0.0123]},
    "count": 62_001,
    "poses": 2315.0,
    "true": True,
    "nan": float("nan"),
    "t": "x",
}


def test_a_number_is_marked_with_its_value_file_and_key():
    found = number(CONTENT, "runs", "a/b~c", 0, file='a"b.json', scale=1000.0)
    assert found == (
        '<data value="0.0123" data-file="a&#34;b.json" data-key="/runs/a~1b~0c/0">12.3</data>'
    )


def test_counts_are_shown_whole_also_those_stored_with_a_point():
    assert ">62001<" in number(CONTENT, "count", file="x", digits=2)
    assert ">2315<" in number(CONTENT, "poses", file="x", rule=round)
    assert ">124000<" in number(CONTENT, "count", file="x", scale=2.0)


@pytest.mark.parametrize("keys", [("none",), ("runs", "a/b~c", 1), ("true",), ("nan",), ("t", "x")])
def test_what_is_no_number_is_a_dash(keys):
    assert number(CONTENT, *keys, file="x") == ABSENT
