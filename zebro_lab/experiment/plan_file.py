# SPDX-License-Identifier: MIT
"""`plan.toml`: the plan of a rig experiment on disk."""

from pathlib import Path

from rig.errors import ProfileError
from rig.experiment.plan import Plan, parse_plan
from rig.experiment.plan_table import PlanTable
from zebro_lab.files.documents import read_toml_document
from zebro_lab.files.errors import SettingsError


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
    entries = read_toml_document(file, advice="examples/plan-source.toml is one")
    try:
        return parse_plan(PlanTable(entries, file=str(file)))
    except ProfileError as error:
        raise SettingsError(error.problem, file=error.file, key=error.key) from error
