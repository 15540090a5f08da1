# SPDX-License-Identifier: MIT
"""Read `plan.toml`, the plan of a rig experiment."""

from pathlib import Path

from rig.experiment.plan import Plan
from rig.experiment.plan_reading import parse_plan
from zebro_lab.files.settings_table import read_settings


def read_plan(file: Path) -> Plan:
    """Read and validate the plan of a rig experiment.

    Args:
        file: TOML file; `examples/plan-thesis.toml` shows every key.

    Returns:
        The plan.

    Raises:
        NotFound: The file does not exist.
        SettingsError: The file is not TOML, or a key is missing, unknown or impossible.
    """
    return parse_plan(read_settings(file, advice="expected a plan like examples/plan-thesis.toml"))
