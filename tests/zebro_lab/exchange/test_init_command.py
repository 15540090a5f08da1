# SPDX-License-Identifier: MIT
"""`zebro-lab init FILE`."""

import typer
from typer.testing import CliRunner

from zebro_lab.exchange.init_command import init

app = typer.Typer()
app.command()(init)


def test_init_says_what_it_guessed_and_what_to_check(tmp_path):
    file = tmp_path / "rig.csv"
    file.write_text("t,FZ [N],FX,omega_l,omega_g\n0,-5,1,12,3\n0.1,-5,1,12,3\n")
    result = CliRunner().invoke(app, [str(file)])
    assert result.exit_code == 0, result.output
    assert f"wrote {tmp_path / 'columns.toml'}" in result.output
    assert "normal_force    from 'FZ [N]' in N, sign reversed; CHECK sign" in result.output
    assert "traction_force  from 'FX' in N; CHECK unit, sign" in result.output
    assert 'values that end in "?" in columns.toml, 6: correct each' in result.output
    assert "radii in [constants]" in result.output


def test_init_counts_every_value_to_check_also_those_of_no_column(tmp_path):
    file = tmp_path / "rig.csv"
    file.write_text("slip,normal_force [N],traction_force [N]\n0.1,5,1\n")
    result = CliRunner().invoke(app, [str(file)])
    assert 'definition = "?"' in (tmp_path / "columns.toml").read_text()
    assert 'values that end in "?" in columns.toml, 5: correct each' in result.output


def test_init_lists_the_units_of_columns_that_it_does_not_use_and_every_column_of_an_imu(tmp_path):
    (tmp_path / "imu.csv").write_text("t [ms],Temp [°C]\n0,20\n10,20\n")
    CliRunner().invoke(app, [str(tmp_path / "imu.csv"), "--kind", "imu"])
    text = (tmp_path / "columns.toml").read_text()
    assert '#   "Temp [°C]": first 20, from 20 to 20, in °C' in text
    for name in ("qw", "rate_z", "force_x", "roll"):
        assert f"# [imu.columns.{name}]" in text
