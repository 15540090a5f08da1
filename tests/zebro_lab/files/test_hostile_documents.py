# SPDX-License-Identifier: MIT
"""Whatever stands in a TOML or JSON file of a user, a reader ends with one line, and soon."""

import json
import os
import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from rig.errors import ProfileError, RigError
from rig.zebro.profile import load_leg_profile
from zebro_lab.calibration.folder import read_slip
from zebro_lab.calibration.slip_argument import parse_slip
from zebro_lab.experiment.plan_file import read_plan
from zebro_lab.files.errors import ZebroLabError
from zebro_lab.robot.robot_file import read_robot_file
from zebro_lab.runs.manifest import read_manifest
from zebro_lab.tables.columns import read_columns
from zebro_lab.track.annotations import read_annotations
from zebro_lab.track.camera_file import read_camera_file
from zebro_lab.track.floor_file import read_floor_file

SLIP = """
schema = 1
source = "real"
slip_definition = "material"
{more}
[law]
name = "brush"
[tested]
normal_force = [1.0, 2.0]
slip_ratio = [0.0, 1.0]
[parameters.slip_stiffness]
mean = 5.0
[parameters.friction]
mean = 0.4
[covariance]
matrix = [[0.01, 0.0], [0.0, 0.01]]
"""
RUN = {
    "schema_version": 1, "kind": "walk", "label": "x", "material": "x", "operator": "x",
    "source": "real", "start": "2026-01-01T00:00:00+00:00", "exit_status": "completed",
    "software": {"version": "1"}, "constants": {"radius_leg": 0.035}, "streams": {"/a/raw": 3},
    "stop": "2026-01-01T00:00:01+00:00",
}  # fmt: skip
TOML_READERS: dict[str, Callable[[Path], object]] = {
    "robot": read_robot_file,
    "columns": read_columns,
    "camera": read_camera_file,
    "floor": read_floor_file,
    "annotations": read_annotations,
    "plan": read_plan,
    "slip": read_slip,
    "profile": lambda file: load_leg_profile(str(file)),
}
DEEP = 100_000


def one_line(reader: Callable[[Path], object], file: Path) -> str:
    """Read a file that cannot be followed, and return the line that says so."""
    with pytest.raises((ZebroLabError, RigError)) as raised:
        reader(file)
    assert "\n" not in str(raised.value)
    assert len(str(raised.value)) < 2000
    return str(raised.value)


def toml(folder: Path, text: str) -> Path:
    file = folder / "x.toml"
    file.write_text(text)
    return file


def run_json(folder: Path, text: str) -> Path:
    (folder / "run.json").write_text(text)
    return folder


@pytest.mark.parametrize("name", TOML_READERS)
def test_deeply_nested_toml_is_refused(name, tmp_path):
    one_line(TOML_READERS[name], toml(tmp_path, "a = " + "[" * DEEP))


def test_deeply_nested_json_is_refused(tmp_path):
    text = json.dumps(RUN)[:-1] + ', "truth": {"a": ' + "[" * DEEP + "]" * DEEP + "}}"
    one_line(read_manifest, run_json(tmp_path, text))


@pytest.mark.parametrize("digits", ["9" * 400, "9" * 5000, "0x" + "f" * 6000])
@pytest.mark.parametrize(("reader", "key"), [(read_robot_file, "mass"), (read_camera_file, "size")])
def test_an_integer_that_toml_cannot_hold_is_refused(reader, key, digits, tmp_path):
    value = f"[{digits}, 5]" if key == "size" else digits
    focal = "focal = [1, 1]\ncentre = [1, 1]\n" if key == "size" else ""
    one_line(reader, toml(tmp_path, f"{key} = {value}\n{focal}"))


def test_an_integer_beyond_64_bits_in_json_is_refused(tmp_path):
    text = json.dumps(RUN).replace("0.035", "9" * 400)
    one_line(lambda folder: float(read_manifest(folder).constants["radius_leg"]),
             run_json(tmp_path, text))  # fmt: skip


@pytest.mark.parametrize(
    "start", ["yesterday", "", "2026-01-01", "2026-01-01T00:00:00", "9999-99-99T99:99:99+00:00"]
)
def test_a_start_that_is_no_moment_with_a_time_zone_is_refused(start, tmp_path):
    assert "'start'" in one_line(
        read_manifest, run_json(tmp_path, json.dumps(RUN | {"start": start}))
    )


@pytest.mark.parametrize(
    "change",
    [
        {"stop": "tomorrow"},
        {"streams": {"/a/raw": "many"}},
        {"streams": {"/a/raw": [1]}},
        {"excluded": {"why": ["x"]}},
        {"constants": {"radius_leg": "wide"}},
        {"profiles": {"legs": 3}},
        {"counters": {"legs": 3}},
        {"clocks": {"legs": {"offset": "x"}}},
    ],
    ids=lambda change: next(iter(change)),
)
def test_a_value_of_another_type_in_run_json_is_refused(change, tmp_path):
    assert f"'{next(iter(change))}'" in one_line(
        read_manifest, run_json(tmp_path, json.dumps(RUN | change))
    )


def test_half_a_pair_of_surrogates_is_refused(tmp_path):
    folder = run_json(tmp_path, json.dumps(RUN | {"label": "half \ud800"}))
    assert "unpaired surrogate" in one_line(read_manifest, folder)


@pytest.mark.parametrize(
    "more", ["verdict = 5", "verdict = [1]", 'verdict = "fine"', "verdict = { headline = [1] }"]
)
def test_a_verdict_that_is_no_table_is_refused(more, tmp_path):
    one_line(lambda file: parse_slip(str(file)), toml(tmp_path, SLIP.format(more=more)))


def test_slip_toml_is_read_once(tmp_path, monkeypatch):
    import tomllib

    parsed = []
    loads = tomllib.loads
    monkeypatch.setattr(tomllib, "loads", lambda text: parsed.append(text) or loads(text))
    parse_slip(str(toml(tmp_path, SLIP.format(more=""))))
    if len(parsed) != 1:
        pytest.fail(f"parsed {len(parsed)} times")


@pytest.mark.parametrize("name", TOML_READERS)
def test_a_fifo_named_as_a_settings_file_does_not_hang(name, tmp_path):
    fifo = tmp_path / "x.toml"
    os.mkfifo(fifo)
    said: list[object] = []

    def read() -> None:
        try:
            said.append(TOML_READERS[name](fifo))
        except (ZebroLabError, ProfileError) as error:
            said.append(error)

    thread = threading.Thread(target=read, daemon=True)
    thread.start()
    thread.join(2.0)
    if thread.is_alive():
        os.close(os.open(fifo, os.O_RDWR | os.O_NONBLOCK))  # lets the thread end
        pytest.fail("still waiting after 2 s")
    assert isinstance(said[0], Exception)


@pytest.mark.parametrize("name", TOML_READERS)
def test_a_settings_file_of_many_megabytes_is_refused_by_its_size(name, tmp_path):
    file = tmp_path / "x.toml"
    with file.open("wb") as sparse:
        sparse.truncate(64 << 20)
    assert "at most" in one_line(TOML_READERS[name], file)
