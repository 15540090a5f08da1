# SPDX-License-Identifier: MIT
"""How a command ends."""

import subprocess
import sys
from pathlib import Path

import pytest
import typer

from model.errors import FitError
from rig.errors import WrongDevice
from zebro_lab.files.errors import DataError
from zebro_lab.terminal.ending import run
from zebro_lab.terminal.stopping import StoppedBySignal


def app_that_raises(error: Exception) -> typer.Typer:
    app = typer.Typer()

    @app.command()
    def command() -> None:
        raise error

    return app


@pytest.fixture(autouse=True)
def no_arguments(monkeypatch):
    monkeypatch.setattr("sys.argv", ["command"])


@pytest.mark.parametrize("error", [DataError("is empty", file="a.csv"), FitError("no start")])
def test_known_error_is_one_line_and_exit_1(error, capsys):
    with pytest.raises(SystemExit) as ended:
        run(app_that_raises(error))
    assert ended.value.code == 1
    assert ended.value.__suppress_context__
    assert capsys.readouterr() == ("", f"error: {error}\n")


@pytest.mark.parametrize(
    ("found", "end"),
    [("imu", "'legs'; this profile belongs to --imu or sim imu\n"), ("camera", "'legs'\n")],
)
def test_a_profile_of_another_device_says_on_which_option_it_belongs(found, end, capsys):
    with pytest.raises(SystemExit):
        run(app_that_raises(WrongDevice(found, expected="legs", file="a.toml")))
    assert capsys.readouterr().err.endswith(end)


def test_unknown_error_keeps_its_traceback():
    with pytest.raises(ZeroDivisionError) as caught:
        run(app_that_raises(ZeroDivisionError("a bug")))
    assert caught.traceback[-1].name == "command"


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (FileNotFoundError(2, "No such file", "a\nb"), r"a\nb: No such file"),
        (OSError(36, "File name too long", b"x\xff"), r"x\udcff: File name too long"),
        (FileExistsError(17, "File exists", "a", None, "b"), "a: File exists"),
    ],
)
def test_what_the_file_system_says_of_a_file_is_one_line_and_exit_1(error, said, capsys):
    with pytest.raises(SystemExit) as ended:
        run(app_that_raises(error))
    assert ended.value.code == 1
    assert capsys.readouterr() == ("", f"error: {said}\n")


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (MemoryError("Unable to allocate 41.6 MiB"), "memory is full"),
        (ImportError("libx.so: failed to map segment from shared object"), "memory is full"),
        (RecursionError("maximum recursion depth exceeded"), "nested too deep"),
    ],
)
def test_what_the_machine_or_the_data_are_too_small_or_deep_for_is_one_line(error, said, capsys):
    with pytest.raises(SystemExit) as ended:
        run(app_that_raises(error))
    assert ended.value.code == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="only Linux has /dev/full")
def test_a_full_stdout_is_one_line_and_exit_1():
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-c", "from zebro_lab.main import main; main()", "--version"],
            stdout=full, stderr=subprocess.PIPE, text=True, check=False,
        )  # fmt: skip
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    assert "No space left on device" in line


def test_a_stop_that_an_import_turned_into_its_own_error_is_a_stop():
    """As extension modules do whose initialisation a signal interrupts."""

    def importing():
        raise ImportError("initialization failed") from StoppedBySignal(15)

    with pytest.raises(StoppedBySignal):
        run(importing)
