# SPDX-License-Identifier: MIT
"""`columns.toml`: how a lab's own tables map to the canonical columns in SI.

The keys are described in docs/formats.md; `zebro-lab init FILE` writes a commented example.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any

from model.slip.definition import SlipDefinition
from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import SettingsError, UnitError
from zebro_lab.files.known_keys import nearest, require_known
from zebro_lab.files.units import factor_to_si, quantity_to_si
from zebro_lab.tables.row_conditions import RowCondition, parse_row_condition

COLUMNS_FILE = "columns.toml"


@dataclass(frozen=True)
class CanonicalColumn:
    """A column the calibration knows.

    Attributes:
        name: Its canonical name.
        unit: Its SI unit; None where it holds no number.
        meaning: One line, with the sign.
    """

    name: str
    unit: str | None
    meaning: str


CANONICAL: Mapping[str, CanonicalColumn] = MappingProxyType({
    column.name: column
    for column in (
        CanonicalColumn("t", "s", "time, increasing within a run"),
        CanonicalColumn("omega_leg", "rad/s", "angular speed of the leg disc"),
        CanonicalColumn("omega_ground", "rad/s", "angular speed of the ground disc"),
        CanonicalColumn("radius_leg", "m", "radius of the leg disc at the contact"),
        CanonicalColumn("radius_ground", "m", "radius of the ground disc at the contact"),
        CanonicalColumn("slip_ratio", "dimensionless", "slip, where it is given: with definition"),
        CanonicalColumn("normal_force", "N", "normal force, positive when pressed together"),
        CanonicalColumn("traction_force", "N", "traction force, positive when driving"),
        CanonicalColumn("run", None, "name or number of the run"),
        CanonicalColumn("slip_definition", None, "material, travel or larger; one a file"),
    )
})  # fmt: skip
_CONSTANTS = {"radius_leg": "m", "radius_ground": "m"}
_LOAD_CELL = {
    "zero_stability": "N",
    "gain_sd": "dimensionless",
    "bias_sd": "N",
    "crosstalk_sd": "dimensionless",
}
_SOURCES = ("real", "sim", "replay", "unknown")


@dataclass(frozen=True)
class MappedColumn:
    """Where a canonical column comes from.

    Attributes:
        name: Its header in the file.
        unit: Its unit in the file.
        factor: What takes the file's numbers to SI with the canonical sign; `unit` and sign.
        definition: Slip definition, for `slip_ratio` alone.
    """

    name: str
    unit: str = ""
    factor: float = 1.0
    definition: SlipDefinition | None = None


@dataclass(frozen=True)
class RunRule:
    """What separates the runs of one file; without any of them a `run` column, else the file.

    Attributes:
        by: Columns, by their names in the file, whose change starts a run.
        gap: Pause that starts a run when it is exceeded [s]; None for no such rule.
        each_row: Every row is the average of a trial and so a run of its own.
    """

    by: tuple[str, ...] = ()
    gap: float | None = None
    each_row: bool = False


@dataclass(frozen=True)
class Columns:
    """What a `columns.toml` says.

    Attributes:
        file: The file itself; None for the canonical names in SI, without a file.
        source: "real", "sim:what" or "replay:what"; None where it does not say.
        columns: Mapped columns by canonical name.
        constants: Canonical columns that are one number for the whole rig, SI.
        runs: What separates runs.
        keep: Conditions that every row must meet.
        load_cell: Standard deviations from the load cell's certificate, SI.
    """

    file: Path | None = None
    source: str | None = None
    columns: Mapping[str, MappedColumn] = field(default_factory=dict)
    constants: Mapping[str, float] = field(default_factory=dict)
    runs: RunRule = RunRule()
    keep: tuple[RowCondition, ...] = ()
    load_cell: Mapping[str, float] = field(default_factory=dict)


def read_columns(file: Path) -> Columns:
    """Read and check a `columns.toml`.

    Raises:
        NotFound: There is no such file.
        SettingsError: It is no TOML, or holds an unknown key, unit or value.
    """
    document = read_toml_document(file, advice=f"expected a {COLUMNS_FILE}")
    return parse_columns(document, file=file)


def parse_columns(document: Mapping[str, Any], *, file: Path, where: str = "") -> Columns:
    """Check what a `columns.toml` holds.

    Args:
        document: Its content, or a section of one.
        file: File that is named in errors.
        where: The section, with a final dot; "" for the whole file.

    Raises:
        SettingsError: It holds an unknown key, unit or value.
    """
    return _Reader(file, where).columns(document)


def parse_definition(text: object, *, file: Path | None, key: str) -> SlipDefinition:
    """Read the name of a slip definition.

    Raises:
        SettingsError: It is none.
    """
    try:
        return SlipDefinition(str(text))
    except ValueError as error:
        advice = nearest(str(text), list(SlipDefinition))
        raise SettingsError(
            f"unknown slip definition '{text}'; {advice}", file=file, key=key
        ) from error


@dataclass(frozen=True)
class _Reader:
    """Turns the tables of one document into values, naming the file in every error."""

    file: Path
    where: str = ""

    def columns(self, document: Mapping[str, Any]) -> Columns:
        known = ("source", "columns", "constants", "runs", "rows", "load_cell")
        self._require_known(document, known, "")
        tables = {
            name: self._typed(document.get(name, {}), dict, name, "a table") for name in known[1:]
        }
        self._require_known(tables["columns"], CANONICAL, "columns.")
        return Columns(
            file=self.file,
            source=self._source(document.get("source")),
            columns={name: self._column(name, t) for name, t in tables["columns"].items()},
            constants=self._quantities("constants", tables["constants"], _CONSTANTS),
            runs=self._runs(tables["runs"]),
            keep=self._keep(tables["rows"]),
            load_cell=self._quantities("load_cell", tables["load_cell"], _LOAD_CELL),
        )

    def _source(self, text: Any) -> str | None:
        if text is None:
            return None
        source = self._typed(text, str, "source", "a text")
        if source.split(":")[0] not in _SOURCES:
            raise self._error("source", f"'{source}' is none of 'real', 'sim:WHAT', 'replay:WHAT'")
        return source

    def _column(self, name: str, table: Any) -> MappedColumn:
        key = f"columns.{name}"
        if isinstance(table, str):  # t = "ET": a name alone, in SI
            table = {"name": table}
        table = self._typed(table, dict, key, "a table with name, unit, sign")
        si_unit = CANONICAL[name].unit
        known = ["name", *(["unit", "sign"] if si_unit else [])]
        known += ["definition"] if name == "slip_ratio" else []
        self._require_known(table, known, f"{key}.")
        unit = self._typed(table.get("unit", si_unit or ""), str, f"{key}.unit", "a text")
        sign = table.get("sign", 1)
        if sign not in (1, -1) or isinstance(sign, bool):
            raise self._error(f"{key}.sign", f"{sign!r} is neither 1 nor -1")
        definition = table.get("definition")
        if definition is not None:
            key_of_definition = f"{self.where}{key}.definition"
            definition = parse_definition(definition, file=self.file, key=key_of_definition)
        factor = sign * (self._factor(f"{key}.unit", unit, si_unit) if si_unit else 1.0)
        header = self._typed(table.get("name", name), str, f"{key}.name", "a text")
        return MappedColumn(header, unit, factor, definition)

    def _runs(self, table: Mapping[str, Any]) -> RunRule:
        self._require_known(table, ("by", "gap", "each_row"), "runs.")
        if len(table) > 1:
            raise self._error("runs", f"{' and '.join(table)} at once; give one of them")
        by, gap = self._texts("runs.by", table.get("by", [])), table.get("gap")
        if gap is not None and (gap := self._quantity("runs.gap", gap, "s")) <= 0:
            raise self._error("runs.gap", f"{gap:g} s is not a pause; expected more than 0 s")
        each_row = self._typed(table.get("each_row", False), bool, "runs.each_row", "true or false")
        return RunRule(by, gap, each_row)

    def _keep(self, table: Mapping[str, Any]) -> tuple[RowCondition, ...]:
        self._require_known(table, ("keep",), "rows.")
        try:
            return tuple(map(parse_row_condition, self._texts("rows.keep", table.get("keep", []))))
        except ValueError as error:
            raise self._error("rows.keep", str(error)) from error

    def _quantities(
        self, name: str, table: Mapping[str, Any], units: Mapping[str, str]
    ) -> dict[str, float]:
        self._require_known(table, units, f"{name}.")
        values = {
            key: self._quantity(f"{name}.{key}", value, units[key]) for key, value in table.items()
        }
        for key, value in values.items():
            if name == "load_cell" and value < 0:
                raise self._error(f"{name}.{key}", f"{value:g} is no standard deviation; >= 0")
        return values

    def _quantity(self, key: str, value: Any, si_unit: str) -> float:
        if isinstance(value, bool) or not isinstance(value, (int, float, str)):
            raise self._error(
                key, f"expected a number in {si_unit} or a text such as '1 {si_unit}'"
            )
        try:
            return quantity_to_si(value, si_unit)
        except UnitError as error:
            raise self._error(key, str(error)) from error

    def _factor(self, key: str, unit: str, si_unit: str) -> float:
        try:
            return factor_to_si(unit, si_unit)
        except UnitError as error:
            raise self._error(key, str(error)) from error

    def _texts(self, key: str, value: Any) -> tuple[str, ...]:
        texts = [value] if isinstance(value, str) else value
        if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts):
            raise self._error(key, f"expected a list of texts, found {value!r}")
        return tuple(texts)

    def _typed(self, value: Any, kind: type, key: str, expected: str) -> Any:
        if not isinstance(value, kind):
            raise self._error(key, f"expected {expected}, found {value!r}")
        return value

    def _require_known(self, found: Collection[str], known: Collection[str], where: str) -> None:
        require_known(found, known, file=self.file, where=f"{self.where}{where}")

    def _error(self, key: str, problem: str) -> SettingsError:
        return SettingsError(problem, file=self.file, key=f"{self.where}{key}")
