# SPDX-License-Identifier: MIT
"""`zebro-lab report` writes the page, and names what is missing with what makes it."""


def test_the_page_is_written_and_its_size_told(walk, tmp_path, run_command):
    out = tmp_path / "page.html"
    ended = run_command("report", walk, "--calibration", tmp_path / "calibration", "--out", out,
                        "--title", "Tiles, spring")  # fmt: skip
    assert (ended.code, ended.err) == (0, "")
    assert ended.out == f"wrote {out} (0.0 MB)\n"
    assert "Tiles, spring</title>" in out.read_text()


def test_a_folder_without_a_run_is_one_line(tmp_path, run_command):
    ended = run_command("report", tmp_path, "--out", tmp_path / "page.html")
    assert (ended.code, ended.out) == (1, "")
    assert len(ended.err.splitlines()) == 1
    assert not (tmp_path / "page.html").exists()
