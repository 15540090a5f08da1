# SPDX-License-Identifier: MIT
"""`zebro-lab import` takes every file that is named, and says what became of it."""

from support.imported_files import COLUMNS
from zebro_lab.runs.legs import read_leg_log
from zebro_lab.runs.manifest import read_manifest
from zebro_lab.runs.signals import read_signals


def test_options_reach_the_run_and_it_is_named(files, tmp_path, run_command):
    data = tmp_path / "data"
    ended = run_command(
        "import", "--legs", files / "legs.csv", "--imu", files / "imu.csv", "--track",
        files / "track.csv", "--robot", files / "robot.toml", "--columns", files / "columns.toml",
        "--label", "circle", "--start", "2026-03-04T05:06:07+00:00", "--material", "PLA",
        "--operator", "a", "--data", data,
    )  # fmt: skip
    assert (ended.code, ended.err) == (0, "")
    folder = data / "20260304T050607Z_walk_circle"
    *notes, last = ended.out.splitlines()
    assert (
        last
        == f"SIMULATED source sim:other-lab, samples: 100 /legs/raw, 100 /imu/raw; wrote {folder}"
    )
    assert any("no column of yaw" in note for note in notes)
    manifest = read_manifest(folder)
    assert (manifest.material, manifest.operator, manifest.robot) == ("PLA", "a", "robot")
    assert (folder / "track" / "track.csv").is_file()
    assert len(read_leg_log(folder).reference.t) == 100


def test_a_run_of_real_legs_and_a_simulated_imu_is_called_simulated(files, tmp_path, run_command):
    mixed = COLUMNS.replace("[legs", '[legs]\nsource = "real"\n[legs', 1)
    (files / "columns.toml").write_text(mixed)
    ended = run_command(
        "import", "--legs", files / "legs.csv", "--imu", files / "imu.csv", "--columns",
        files / "columns.toml", "--robot", files / "robot.toml", "--data", tmp_path / "data",
    )  # fmt: skip
    assert ended.out.splitlines()[-1].startswith("SIMULATED source mixed:real,sim:other-lab,")
    (folder,) = (tmp_path / "data").iterdir()
    shown = {panel.title.split(":")[0]: panel.simulated for panel in read_signals(folder).panels}
    assert shown == {"legs": False, "imu": True}
