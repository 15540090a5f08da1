# SPDX-License-Identifier: MIT
"""Text goes to stdout, or beside a document to stderr, or nowhere."""

import io
import json
from pathlib import Path

import numpy as np
import pytest
import typer

from zebro_lab.files.errors import SettingsError
from zebro_lab.terminal.output import TEXT, Output


@pytest.mark.parametrize(
    ("output", "out", "err"),
    [(TEXT, "said", ""), (Output(as_json=True), "", "said"), (Output(quiet=True), "", ""),
     (Output(as_json=True, quiet=True), "", "")],
)  # fmt: skip
def test_text_goes_where_it_disturbs_no_document(output, out, err, capsys):
    output.say("said")
    output.console().print("said")
    assert output.say_in_time("said")
    captured = capsys.readouterr()
    assert captured.out.split() == [out] * 3 * bool(out)
    assert captured.err.split() == [err] * 3 * bool(err)


@pytest.mark.parametrize("output", [TEXT, Output(as_json=True, quiet=True)])
def test_questions_are_asked_on_stderr_also_if_quiet(output, capsys, monkeypatch):
    monkeypatch.setattr("sys.stdin", io.StringIO("4\n"))
    with output.asking():
        assert typer.prompt("which leg?", type=int) == 4
    out, err = capsys.readouterr()
    assert (out, err.rstrip()) == ("", "which leg?:")
    with pytest.raises(SettingsError, match="standard input has ended"), output.asking():
        typer.confirm("did it turn forward?")


@pytest.mark.parametrize("quiet", [False, True])
def test_a_document_is_json_whatever_is_in_it(quiet, capsys):
    content = {
        "radius_m": np.float64("inf"), "x_m": np.array([1.0, np.nan]), "folder": Path("a"),
        "n": np.int64(3), "label": "caf\udce9",
    }  # fmt: skip
    Output(as_json=True, quiet=quiet).document("walk", content, exit_code=3)
    captured = capsys.readouterr()
    assert json.loads(captured.out) == {
        "command": "walk", "exit_code": 3, "radius_m": None, "x_m": [1.0, None], "folder": "a",
        "n": 3, "label": "caf\\udce9",
    }  # fmt: skip
    assert captured.err == ""
