# SPDX-License-Identifier: MIT
"""`plan.toml`: the plan of a rig experiment on disk."""

from pathlib import Path

from rig.experiment.plan import Plan
from rig.experiment.plan_reading import parse_plan
from zebro_lab.files.settings_table import read_settings


def read_plan(file: Path) -> Plan:
    """Read a plan.

    Args:
        file: TOML; `examples/plan-thesis.toml` shows every key.

    Returns:
        The plan.

    Raises:
        NotFound: There is no such file.
        SettingsError: It is not TOML, or a key is missing, unknown or impossible.
    """
    return parse_plan(read_settings(file, advice="examples/plan-thesis.toml is one"))
