# SPDX-License-Identifier: MIT
"""`zebro-lab report` writes the page, and names what is missing with what makes it."""

from support.report_pages import write_json


def test_the_page_is_written_and_its_size_told(walk, tmp_path, run_command):
    out = tmp_path / "page.html"
    ended = run_command("report", walk, "--calibration", tmp_path / "calibration", "--out", out,
                        "--title", "Tiles, spring")  # fmt: skip
    assert (ended.code, ended.err) == (0, "")
    assert ended.out == f"wrote {out} (0.0 MB)\n"
    assert "Tiles, spring</title>" in out.read_text()


def test_what_is_missing_is_named_with_the_command_that_makes_it(walk, tmp_path, run_command):
    (walk / "track" / "manifest.json").unlink()
    ended = run_command("report", walk, "--calibration", tmp_path / "none", "--out",
                        tmp_path / "page.html")  # fmt: skip
    calibration, track, written = ended.out.splitlines()
    assert calibration.startswith("missing: calibration; create it with: zebro-lab calibrate ")
    assert track == (
        "missing: track; create it with: zebro-lab track PHOTOS --camera camera.toml --floor "
        f"floor.toml --run {walk}"
    )
    assert written.startswith("wrote")


def test_a_folder_without_a_run_is_one_line(tmp_path, run_command):
    ended = run_command("report", tmp_path, "--out", tmp_path / "page.html")
    assert (ended.code, ended.out) == (1, "")
    assert len(ended.err.splitlines()) == 1
    assert not (tmp_path / "page.html").exists()


def test_a_track_alone_misses_nothing(walk, tmp_path, run_command):
    run = tmp_path / "alone"
    write_json(run / "run.json", {"kind": "walk", "exit_status": "imported", "streams": {}})
    (walk / "track").rename(run / "track")
    out = tmp_path / "page.html"
    ended = run_command("report", run, "--calibration", tmp_path / "none", "--out", out)
    assert ended.out == f"wrote {out} (0.0 MB)\n"
