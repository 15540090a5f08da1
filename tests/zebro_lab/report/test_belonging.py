# SPDX-License-Identifier: MIT
"""Results that were not made from one another are named, and nothing else is."""

import hashlib
import json

import pytest

from support.report_pages import made, write_json
from zebro_lab.files.provenance import file_hash
from zebro_lab.report.belonging import belonging
from zebro_lab.report.sources import find_sources

HEADLINE = "Slip curve: weak"


def digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def edit(file, **change):
    write_json(file, {**json.loads(file.read_text()), **change})


def inputs_of(part) -> dict:
    return json.loads((part / "manifest.json").read_text())["inputs"]


@pytest.fixture
def whole(walk):
    """Return a run whose results were all made from one another."""
    law = inputs_of(walk / "prediction")["slip.toml"]
    for name in ("log.mcap", "profiles/legs.toml", "prediction/path.csv", "track/track.csv"):
        (walk / name).parent.mkdir(exist_ok=True)
        (walk / name).write_text(name)
    edit(walk / "run.json", log_sha256=digest("log.mcap"), inputs={"t.csv": digest("table")})
    edit(walk / "prediction/manifest.json", inputs={
        "demo/slip.toml": law, "log.mcap": digest("log.mcap"),
        "legs.toml": digest("profiles/legs.toml"),
    })  # fmt: skip
    edit(walk / "track/manifest.json", settings={"imported": "t.csv"},
         inputs={"t.csv": digest("table")})  # fmt: skip
    judged = ("prediction/path.csv", "track/track.csv")
    edit(walk / "validation/manifest.json", inputs={name: digest(name) for name in judged})
    return walk


def notices(run) -> tuple[str, ...]:
    return belonging(find_sources(run, calibration=run.parent / "calibration")).notices


def test_results_made_from_one_another_have_no_notice(whole):
    assert notices(whole) == ()
    assert HEADLINE in made(whole).text


def test_a_manifest_that_states_nothing_is_not_judged(walk):
    assert notices(walk) == ()


def another_log(run):
    edit(run / "run.json", log_sha256=digest("another"))
    return "the prediction was not made from log.mcap as it is now"


def another_profile(run):
    (run / "profiles/legs.toml").write_text("mended")
    return "the prediction was not made from legs.toml as it is now"


def another_prediction(run):
    (run / "prediction/path.csv").write_text("predicted again")
    return "the validation in "


def another_track(run):
    (run / "track/track.csv").write_text("tracked again")
    return "the validation in "


def a_track_of_another_run(run):
    edit(run / "track/manifest.json", inputs={"t.csv": digest("another table")})
    return "the track was imported from other files than the run"


def another_calibration(run):
    slip = run.parent / "calibration/slip.toml"
    slip.write_text(slip.read_text() + "# fitted again")
    return "the prediction was made with slip 'calibration', not with the calibration in"


@pytest.mark.parametrize(
    "change",
    [another_log, another_profile, another_prediction, another_track, a_track_of_another_run,
     another_calibration],
)  # fmt: skip
def test_each_result_that_is_not_of_the_others_is_named_on_page_and_line(
    change, whole, tmp_path, run_command
):
    problem = change(whole)
    (notice,) = notices(whole)
    assert notice.startswith("run: ")
    assert problem in notice
    ended = run_command("report", whole, "--calibration", tmp_path / "calibration", "--out",
                        tmp_path / "page.html")  # fmt: skip
    assert ended.out.startswith(f"does not belong together: {notice}\n")
    page = made(whole)
    assert "These results do not belong together" in page.text
    assert notice in page.text


def test_a_result_that_was_edited_by_hand_is_named(whole):
    manifest, file = whole / "prediction/manifest.json", whole / "prediction/path.csv"
    edit(manifest, outputs={"path.csv": file_hash(file)})
    assert notices(whole) == ()
    edit(manifest, outputs={"path.csv": digest("before")})
    assert notices(whole)[-1].startswith(f"{file} was changed after it was written")


def test_a_prediction_from_the_table_that_was_imported_is_of_the_run(whole):
    inputs = inputs_of(whole / "prediction")
    del inputs["log.mcap"], inputs["legs.toml"]
    edit(whole / "prediction/manifest.json", inputs=inputs | {"t.csv": digest("table")})
    assert notices(whole) == ()
    # A robot.toml that two runs share does not make a prediction of the one that of the other.
    edit(whole / "run.json", inputs={"t.csv": digest("table"), "robot.toml": digest("robot")})
    edit(whole / "prediction/manifest.json", inputs=inputs | {"robot.toml": digest("robot")})
    assert len(notices(whole)) == 2


@pytest.mark.parametrize("slip", [{"named": "coulomb:0.38", "source": "assumed"}, None])
def test_a_calibration_that_the_prediction_did_not_use_is_no_headline(slip, whole):
    inputs = inputs_of(whole / "prediction")
    del inputs["demo/slip.toml"]
    edit(whole / "prediction/manifest.json", inputs=inputs,
         settings={"model": "dynamics", "slip": slip})  # fmt: skip
    page = made(whole)
    assert HEADLINE not in page.text
    assert "No prediction on this page was made with this calibration" in page.text
    named = "slip 'coulomb:0.38'" if slip else "no slip law"
    assert f"the prediction was made with {named}, not with the calibration in" in page.text


def test_a_fit_of_walks_that_a_prediction_did_not_use_is_named(whole, tmp_path):
    walks = tmp_path / "calibration/walks"
    law = inputs_of(whole / "prediction")["demo/slip.toml"]
    write_json(walks / "manifest.json", {"schema": 2, "kind": "walks", "inputs": {"s": law}})
    (walks / "walks.toml").write_text("")
    (notice,) = notices(whole)
    assert "made without the fit of walks in" in notice
    used = inputs_of(whole / "prediction") | {"walks.toml": digest("")}
    edit(whole / "prediction/manifest.json", inputs=used)
    assert notices(whole) == ()
    edit(walks / "manifest.json", inputs={"s": digest("another law")})
    (notice,) = notices(whole)
    assert "the fit of walks was not made from" in notice
    (walks / "manifest.json").unlink()
    (notice,) = notices(whole)
    assert "used a fit of walks that" in notice
