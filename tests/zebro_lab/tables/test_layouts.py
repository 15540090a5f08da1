# SPDX-License-Identifier: MIT
"""Tables as other programs write them are read as they mean, marked where unsure, or refused.

Each file in `layouts/` has an entry in `layouts/meaning.toml`.
"""

import re
import shutil
import tomllib
from pathlib import Path

import numpy as np
import pytest

from support.bounded_reading import LONGEST_MESSAGE
from zebro_lab.exchange.column_guesses import UNITS
from zebro_lab.exchange.init_stage import WrittenColumns, write_columns_template
from zebro_lab.files.errors import SettingsError, ZebroLabError
from zebro_lab.tables.columns_file import read_columns, read_mapped_columns
from zebro_lab.tables.rig_columns import CANONICAL
from zebro_lab.tables.rig_table import RigTable
from zebro_lab.tables.table_files import read_table_file

FOLDER = Path(__file__).parent / "layouts"
MEANINGS = tomllib.loads((FOLDER / "meaning.toml").read_text(encoding="utf-8"))
REFUSED = {name for name, meaning in MEANINGS.items() if "refused" in meaning}


def test_every_layout_has_a_meaning():
    assert {file.name for file in FOLDER.iterdir()} - {"meaning.toml"} == set(MEANINGS)
    assert len(MEANINGS) > 25


@pytest.fixture
def file(request, tmp_path) -> Path:
    if request.param.endswith((".xlsx", ".xlsx.gz")):
        pytest.importorskip("openpyxl")
    return Path(shutil.copy(FOLDER / request.param, tmp_path))


def numbers(file: Path, kind: str) -> dict[str, np.ndarray]:
    """Numbers of each mapped column in SI."""
    raw = read_table_file(file)
    if kind == "rig":
        table = RigTable(raw, read_columns(file.parent / "columns.toml"), np.arange(len(raw)))
        names = [name for name, column in CANONICAL.items() if column.unit]
        found = {name: table.source_of(name) for name in names}
        return {name: column.in_si(raw) for name, column in found.items() if column}
    columns = read_mapped_columns(kind, file, None, UNITS[kind])[0]
    return {
        name: mapped.in_unit_of(raw, columns.units[name]).in_si(raw)
        for name, mapped in columns.mapped.items() if columns.has(raw, name)
    }  # fmt: skip


def accepted(written: WrittenColumns) -> str:
    """Accept every guess, and return the kind of the table."""
    text = written.file.read_text(encoding="utf-8")
    text = text.replace('each_row = "?"', "each_row = true").replace('= "?"', '= "travel"')
    written.file.write_text(text.replace('?"', '"'), "utf-8")
    return written.kind


@pytest.mark.parametrize("file", sorted(set(MEANINGS) - REFUSED), indirect=True)
def test_a_layout_means_what_its_program_says(file):
    meaning = MEANINGS[file.name]
    kind = meaning["kind"]
    written = write_columns_template(file, kind=kind if meaning.get("given") else None)
    doubts = {name: " ".join(guess.doubts) for name, guess in written.guesses.items()}
    assert written.kind == kind
    assert {name: doubt for name, doubt in doubts.items() if doubt} == meaning.get("doubts", {})
    if any(doubts.values()):
        with pytest.raises(SettingsError, match="nobody has checked"):
            numbers(file, kind)
    found = numbers(file, accepted(written))
    ends = {name: [values[0], values[-1]] for name, values in found.items()}
    assert set(ends) == set(meaning["si"])
    for name, expected in meaning["si"].items():
        np.testing.assert_allclose(ends[name], expected, rtol=1e-9, err_msg=name)


@pytest.mark.parametrize("file", sorted(REFUSED), indirect=True)
def test_a_layout_that_is_not_clear_is_refused_in_one_line(file):
    with pytest.raises(ZebroLabError) as raised:
        numbers(file, accepted(write_columns_template(file)))
    message = str(raised.value)
    assert MEANINGS[file.name]["refused"] in message
    assert file.name in message
    assert "\n" not in message
    assert len(message) < LONGEST_MESSAGE


REFERENCE: dict[str, tuple[str | None, dict[str, str] | str]] = {
    "realdata/tyre-bench/drivebrake_pure_slip.csv": (None, {
        "t": "unit", "slip_ratio": "column unit sign", "normal_force": "unit sign",
        "traction_force": "column unit sign",
    }),
    "realdata/single-wheel-sand/smooth.csv": (None, {
        "slip_ratio": "unit sign", "normal_force": "unit sign",
        "traction_force": "column unit sign", "traction_force_sd": "unit",
    }),
    "realdata/single-wheel-sand/grouser.csv": (None, {
        "slip_ratio": "unit sign", "normal_force": "unit sign",
        "traction_force": "column unit sign", "traction_force_sd": "unit",
    }),
    "realdata/omni-wheels/exp00.csv": (None, {
        "t_s": "", "x_m": "unit", "y_m": "unit sign", "yaw_rad": "column sign",
    }),
    "realdata/wheel-odometry/Indoor_UWB_GT.txt": (None, "has no header: the first line is 'point2"),
    "realdata/wheel-odometry/Indoor_UWB_Input.txt": (None, "has no header: the first line is '"),
    "realdata/aruco-photos/gold_choriginal.csv": (None, "fits no kind of table, by its headers id"),
    "virtual-world/rig/rig_law_noisy_Fn6.63.csv.gz": (None, {
        "t": "unit", "omega_leg": "unit", "omega_ground": "unit", "slip_ratio": "unit sign",
        "normal_force": "unit", "traction_force": "unit sign",
    }),
    "virtual-world/walks/tetrapod_mu0.20_tc3.csv.gz": (None, "may be of the kinds legs or imu or"),
    "virtual-world/photos/s1.10_C/truth.csv": (
        "track",
        {"t_s": "unit", "x_m": "unit", "y_m": "unit sign", "yaw_rad": "unit sign", "z_m": "unit"},
    ),
}  # fmt: skip


@pytest.mark.reference
@pytest.mark.parametrize("name", REFERENCE)
def test_a_table_of_the_reference_data_is_marked_or_refused(name, shared, tmp_path):
    kind, expected = REFERENCE[name]
    file = Path(shutil.copy(shared / name, tmp_path))
    if isinstance(expected, str):
        with pytest.raises(ZebroLabError, match=re.escape(expected)):
            write_columns_template(file, kind=kind)
        return
    written = write_columns_template(file, kind=kind)
    doubts = {name: " ".join(each.doubts) for name, each in written.guesses.items()}
    assert {name: doubts[name] for name in doubts if not name.startswith("q")} == expected
    found = numbers(file, accepted(written))
    assert all(np.isfinite(values).all() for values in found.values())
