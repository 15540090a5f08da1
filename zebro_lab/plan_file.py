# SPDX-License-Identifier: MIT
"""`plan.toml`: the plan of a rig experiment on disk."""

import tomllib
from pathlib import Path

from rig.errors import ProfileError
from rig.experiment.plan import Plan, parse_plan
from rig.experiment.plan_table import PlanTable
from zebro_lab.errors import NotFound, SettingsError


def read_plan(file: Path) -> Plan:
    """Read a plan.

    Args:
        file: TOML; `examples/plan-source.toml` shows every key.

    Returns:
        The plan.

    Raises:
        NotFound: There is no such file.
        SettingsError: It is not TOML, or a key is missing, unknown or impossible.
    """
    try:
        entries = tomllib.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError as error:
        raise NotFound(f"{file}: no such file; examples/plan-source.toml is one") from error
    except (OSError, ValueError) as error:
        raise SettingsError(f"cannot be read as TOML: {error}", file=file) from error
    try:
        return parse_plan(PlanTable(entries, file=str(file)))
    except ProfileError as error:
        raise SettingsError(error.problem, file=error.file, key=error.key) from error
