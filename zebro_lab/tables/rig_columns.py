# SPDX-License-Identifier: MIT
"""Canonical columns of a rig's table, and what a `columns.toml` states of the rig, as values."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

from model.similar_name import nearest
from model.slip.definition import SlipDefinition
from model.slip.rig_errors import (
    RADIUS_TOLERANCE,
    ROLLING_RESISTANCE,
    RUN_OUT,
    UNKNOWN_RATIO,
    UNKNOWN_SCATTER,
    RigErrors,
    radius_ratio_sd,
    run_out_scatter,
)
from zebro_lab.files.errors import SettingsError
from zebro_lab.tables.columns import Columns


@dataclass(frozen=True)
class CanonicalColumn:
    """A column that a calibration uses.

    Attributes:
        unit: SI unit of the column; None if its cells are text.
        meaning: Description in one line, with the sign convention.
    """

    unit: str | None
    meaning: str


CANONICAL: Mapping[str, CanonicalColumn] = MappingProxyType({
    "t": CanonicalColumn("s", "time, increasing within a run"),
    "omega_leg": CanonicalColumn("rad/s", "angular speed of the leg disc"),
    "omega_ground": CanonicalColumn("rad/s", "angular speed of the ground disc"),
    "speed_leg": CanonicalColumn("m/s", "speed of the leg's surface, in place of omega_leg"),
    "speed_ground": CanonicalColumn("m/s", "speed of the ground's surface"),
    "angle_leg": CanonicalColumn("rad", "angle of the leg disc, of one zero; for its run-out"),
    "angle_ground": CanonicalColumn("rad", "angle of the ground disc, of one zero"),
    "radius_leg": CanonicalColumn("m", "radius of the leg disc at the contact"),
    "radius_ground": CanonicalColumn("m", "radius of the ground disc at the contact"),
    "slip_ratio": CanonicalColumn("dimensionless", "slip ratio, with its definition"),
    "normal_force": CanonicalColumn("N", "normal force, positive when pressed together"),
    "traction_force": CanonicalColumn("N", "traction force, positive when driving"),
    "traction_coefficient": CanonicalColumn("dimensionless", "traction force over normal force"),
    "traction_force_sd": CanonicalColumn("N", "standard deviation of a row's traction force"),
    "traction_coefficient_sd": CanonicalColumn("dimensionless", "standard deviation of that"),
    "lateral_force": CanonicalColumn("N", "force across the discs, if the cell measures it"),
    "run": CanonicalColumn(None, "name or number of the run"),
    "slip_definition": CanonicalColumn(None, "material, travel, larger or mean; one in each file"),
})  # fmt: skip
RIG_UNITS: Mapping[str, str | None] = {name: column.unit for name, column in CANONICAL.items()}


@dataclass(frozen=True)
class RunRule:
    """Rule that separates the rows of one file into runs; at most one of the first three is given.

    Without a rule, a change in the `run` column starts a run; without that, the file is one run.

    Attributes:
        by: Columns, by their headers in the file; a change of value in one starts a new run.
        gap: Interval between samples beyond which a new run starts [s]; None if not given.
        each_row: Whether every row is the mean of one trial, and therefore a run.
        leave_out: Numbers of runs of each file that are left out, counted from 1.
    """

    by: tuple[str, ...] = ()
    gap: float | None = None
    each_row: bool = False
    leave_out: tuple[int, ...] = ()


@dataclass(frozen=True)
class RigErrorsStated:
    """Standard deviations of errors of the rig, as a `columns.toml` states them.

    Attributes:
        radius: Of each disc's radius [m].
        radius_ratio: Of the relative error of the ratio of the radii, instead of `radius` [-]; None
            if not given.
        rolling_resistance: Of the rolling resistance over the load, the scale of Student's t [-].
        run_out: Amplitude by which each disc's radius at the contact varies once a turn, and the
            standard deviation of each coefficient of a disc whose angle is recorded [m].
    """

    radius: float = RADIUS_TOLERANCE
    radius_ratio: float | None = None
    rolling_resistance: float = ROLLING_RESISTANCE
    run_out: float = RUN_OUT

    def resolved(self, radii: Mapping[str, float]) -> RigErrors:
        """Return the standard deviations that a fit takes.

        Args:
            radii: `radius_leg` and `radius_ground` [m], those that are known. Unless both are, the
                standard deviation of their ratio is `UNKNOWN_RATIO` if `radius_ratio` is not
                stated, and that of the slip which the speeds do not show is `UNKNOWN_SCATTER`.
        """
        ratio, scatter = UNKNOWN_RATIO, UNKNOWN_SCATTER
        if {"radius_leg", "radius_ground"} <= radii.keys():
            both = radii["radius_leg"], radii["radius_ground"]
            ratio = radius_ratio_sd(*both, self.radius)
            scatter = run_out_scatter(*both, self.run_out)
        ratio = ratio if self.radius_ratio is None else self.radius_ratio
        return RigErrors(ratio, self.rolling_resistance, scatter, self.run_out)


@dataclass(frozen=True)
class RigColumns(Columns):
    """Content of a `columns.toml` of a rig.

    Attributes:
        units: SI unit of each of the columns `CANONICAL`.
        constants: What is the same in all rows, by name: the radii of the discs, `radius_leg` and
            `radius_ground` [m], and `normal_force` [N]; only those given.
        runs: Rule that separates rows into runs.
        load_cell: Given standard deviations from the load cell's certificate by name, SI:
            `zero_stability`, `gain_sd`, `bias_sd`, `crosstalk_sd`.
        priors: What is known of parameters beforehand, as texts such as "friction = 0.4 ± 0.05".
        rig_errors: Standard deviations of errors of the rig.
    """

    units: Mapping[str, str | None] = field(default_factory=lambda: RIG_UNITS)
    constants: Mapping[str, float] = field(default_factory=dict)
    runs: RunRule = RunRule()
    load_cell: Mapping[str, float] = field(default_factory=dict)
    priors: tuple[str, ...] = ()
    rig_errors: RigErrorsStated = field(default_factory=lambda: RigErrorsStated())


def parse_definition(text: object, *, file: Path | None, key: str) -> SlipDefinition:
    """Parse the name of a slip definition.

    Args:
        text: Name of the definition.
        file: File that it was read from, for the error message.
        key: Key or column that it was read from, for the error message.

    Raises:
        SettingsError: There is no definition of this name.
    """
    try:
        return SlipDefinition(str(text))
    except ValueError as error:
        advice = nearest(str(text), list(SlipDefinition))
        raise SettingsError(
            f"unknown slip definition '{text}'; {advice}", file=file, key=key
        ) from error
