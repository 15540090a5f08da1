# SPDX-License-Identifier: MIT
"""The quantity that runs were made at, such as the pressure of a tyre: `[covariates]`."""

from dataclasses import dataclass

from zebro_lab.files.settings_table import SettingsTable


@dataclass(frozen=True)
class StatedCovariate:
    """A covariate as a `columns.toml` states it.

    Attributes:
        name: Its name.
        header: Header of its column; None where one value holds for all runs.
        value: That value; None where it has a column.
        unit: Unit of its values, a label.
        reference: Value at which the law has its parameters' values; None for the geometric mean.
    """

    name: str
    header: str | None
    value: float | None
    unit: str
    reference: float | None


def parse_covariate(table: SettingsTable) -> StatedCovariate | None:
    """Parse `[covariates]`: one entry, by its name; None without an entry.

    Args:
        table: Content of the section.

    Raises:
        SettingsError: There are several entries, or one has no or both of `name` and `value`, an
            unknown key, a name that is no word, or a number that is not above 0.
    """
    names = list(table.left)
    if not names:
        return None
    if len(names) > 1:
        raise table.fault(
            f"found {', '.join(names)}; expected one covariate: the law follows one quantity",
            names[1],
        )
    name = names[0]
    if not name.isidentifier():
        raise table.fault(f"found '{name}'; expected a word of letters, such as pressure", name)
    entry = table.table(name)
    header = entry.text("name", least=1) if "name" in entry else None
    value = entry.quantity("value", "dimensionless", above=0.0) if "value" in entry else None
    if (header is None) == (value is None):
        raise entry.fault(
            "expected either the header of its column, name, or one value for all runs, value"
        )
    reference = None
    if "reference" in entry:
        reference = entry.quantity("reference", "dimensionless", above=0.0)
    unit = entry.text("unit") if "unit" in entry else ""
    return StatedCovariate(name, header, value, unit, reference)
