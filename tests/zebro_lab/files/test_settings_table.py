# SPDX-License-Identifier: MIT
"""Settings with units; every fault is a `SettingsError` that names file and key."""

from pathlib import Path

import pytest

from zebro_lab.files.errors import NotFound, SettingsError
from zebro_lab.files.settings_table import SettingsTable, read_settings

FILE = Path("mine.toml")


def table(**entries) -> SettingsTable:
    return SettingsTable(entries, file=FILE)


def test_texts_with_units_and_numbers_become_si():
    found = table(a="35 mm", b=0.035, c=["1 m", 2])
    assert found.quantity("a", "m") == pytest.approx(found.quantity("b", "m"))
    assert found.quantities("c", 2, "m") == (1.0, 2.0)
    found.finish()


def test_a_unit_gives_its_factor_and_the_si_unit_is_the_default():
    assert table(unit="mm").factor("unit", "m") == ("mm", pytest.approx(1e-3))
    assert table().factor("unit", "m") == ("m", 1.0)


def test_an_inner_table_is_of_the_same_kind():
    with pytest.raises(SettingsError, match=r"legs\.radios: unknown key") as caught:
        _with_inner().finish()
    assert (caught.value.file, caught.value.key) == (FILE, "legs.radios")


def _with_inner() -> SettingsTable:
    found = table(legs={"radios": 1})
    assert "radius" not in found.table("legs")
    return found


@pytest.mark.parametrize(
    ("take", "value", "message"),
    [
        (lambda t: t.quantity("k", "m"), True, "found True; expected a number in m or a text"),
        (lambda t: t.quantity("k", "dimensionless"), [], r"found \[\]; expected a number$"),
        (lambda t: t.quantity("k", "m"), "1 kg", "'kg' cannot be converted to m"),
        (lambda t: t.quantity("k", "m", above=0.0), 0, "is 0 m; expected more than 0"),
        (lambda t: t.quantity("k", "m", least=0.0), -1, "is -1 m; expected 0 or more"),
        (lambda t: t.quantities("k", 2, "m"), [1, "x"], r"k\[1\]: 'x' is not a number"),
        (lambda t: t.factor("k", "m"), "frobs", "unknown unit 'frobs'"),
    ],
)
def test_a_quantity_that_does_not_fit_is_named(take, value, message):
    with pytest.raises(SettingsError, match=message):
        take(table(k=value))


def test_a_file_that_is_not_there_or_no_toml_is_named(tmp_path):
    with pytest.raises(NotFound, match="write one"):
        read_settings(tmp_path / "absent.toml", advice="write one")
    (tmp_path / "bad.toml").write_text("a =")
    with pytest.raises(SettingsError, match=r"bad\.toml: cannot be read as TOML"):
        read_settings(tmp_path / "bad.toml", advice="")
