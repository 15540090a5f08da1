# SPDX-License-Identifier: MIT
"""What a report shows is found beside its run, and what is missing is named."""

import json

import pytest

from support.report_pages import made, write_json
from zebro_lab.files.errors import DataError
from zebro_lab.report.sources import find_sources


def test_missing_parts_are_named_with_the_command_that_makes_them(walk):
    for name in ("track", "prediction"):
        (walk / name / "manifest.json").unlink()
    page = made(walk, calibration=walk.parent / "nowhere")
    for command in ("zebro-lab track", "zebro-lab predict", "zebro-lab calibrate"):
        assert command in page.text
    assert "zebro-lab validate" not in page.text


TRACK_ALONE = {"kind": "walk", "label": "ours", "exit_status": "imported", "streams": {}}


@pytest.mark.parametrize("of_folder", [False, True])
def test_a_track_alone_is_compared_with_trajectories_and_needs_nothing_else(
    walk, tmp_path, of_folder
):
    run = tmp_path / "data" / "alone"
    write_json(run / "run.json", TRACK_ALONE)
    (walk / "track").rename(run / "track")
    page = made(run.parent if of_folder else run, calibration=tmp_path / "nowhere")
    assert f"zebro-lab validate {run}/track/track.tum ESTIMATE" in page.text
    assert "zebro-lab import --legs" in page.text
    for useless in ("predict", "calibrate", "validate data", f"validate {run} ", "track PHOTOS"):
        assert f"zebro-lab {useless}" not in page.text
    assert "none needs a slip curve" in page.text


def test_a_folder_of_runs_is_one_page(walk, tmp_path):
    data = tmp_path / "data"
    data.mkdir()
    walk.rename(data / "a")
    write_json(data / "b" / "run.json", {"kind": "slip-rig", "label": "sweep", "streams": {}})
    page = made(data, calibration=tmp_path / "calibration")
    sections = [attrs["id"] for attrs in page.all("section")]
    assert sections == ["run", "slip", "walk-1", "together", "provenance"]
    assert "sweep" in page.text


def test_parts_are_found_with_their_documents_and_pictures_in_order(walk):
    found = find_sources(walk, calibration=walk.parent / "calibration")
    (run,) = found.runs
    assert (run.name, list(run.parts)) == ("run", ["track", "prediction", "validation"])
    assert not any(part.missing for part in found.parts)
    assert set(found.calibration.documents) == {"manifest.json", "slip.toml", "summary.csv"}
    assert found.calibration.documents["summary.csv"]["shape"]["r_hat"] == 1.0007
    assert [file.name for file in found.calibration.pictures] == ["curves.png", "corner.png"]
    assert found.simulated == ["sim:rig", "sim:robot", "sim:test"]
    assert (found.together, found.walks) == (None, None)


def test_a_picture_from_elsewhere_is_not_shown_and_one_that_is_gone_is_left_out(walk):
    file = walk / "track" / "manifest.json"
    manifest = json.loads(file.read_text())
    manifest["outputs"] |= {"../x.png": "0", "gone.png": "0"}
    write_json(file, manifest)
    track = find_sources(walk, calibration=walk).runs[0].parts["track"]
    assert [each.name for each in track.pictures] == ["map.png"]
    assert track.not_shown == ("../x.png",)


@pytest.mark.parametrize(
    ("file", "text", "message"),
    [
        ("summary.csv", None, r"summary\.csv: is missing; run the command that writes it again"),
        (
            "manifest.json",
            "[]",
            r"manifest\.json: is not a JSON object; restore it",
        ),
        ("slip.toml", "[", r"slip\.toml: cannot be read as TOML.*delete it and run the command"),
    ],
)
def test_a_part_that_cannot_be_read_is_named(walk, file, text, message):
    calibration = walk.parent / "calibration"
    (calibration / file).unlink()
    if text is not None:
        (calibration / file).write_text(text)
    with pytest.raises(DataError, match=message):
        find_sources(walk, calibration=calibration)
