# SPDX-License-Identifier: MIT
"""`zebro-lab plot` says what it draws, and where."""

from support.written_runs import make_run


def test_panels_are_listed_with_their_samples_and_what_is_simulated(tmp_path, run_command):
    made = make_run(tmp_path, 50, source="real"), make_run(tmp_path, 60, label="b")
    for folder, n, simulated in zip(made, (50, 60), ("", "SIMULATED "), strict=True):
        out = tmp_path / f"{n}.png"
        ended = run_command("plot", folder, "--out", out)
        assert (ended.code, ended.err) == (0, "")
        assert ended.out.splitlines() == [
            f"{simulated}board: forces: {n} samples",
            f"{simulated}board: speeds of the discs: {n} samples",
            f"wrote {out}",
        ]
        assert out.is_file()


def test_what_is_no_run_is_one_line(tmp_path, run_command):
    ended = run_command("plot", tmp_path)
    assert (ended.code, ended.out) == (1, "")
    assert ended.err.startswith("error: ")
    assert "is not a run folder" in ended.err
