# SPDX-License-Identifier: MIT
"""Read `plan.toml`, the plan of a rig experiment."""

from pathlib import Path

from rig.errors import LimitExceeded
from rig.experiment.plan import Plan
from rig.experiment.plan_reading import parse_plan
from rig.experiment.steps import require_allowed
from rig.slip_rig.profile import RigProfile
from zebro_lab.files.errors import SettingsError
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


def require_plan_allowed(file: Path, plan: Plan, profile: RigProfile) -> None:
    """Check a plan against its own limits and those of a rig.

    Args:
        file: File of the plan, for the message.
        plan: Its content.
        profile: Profile of the rig.

    Raises:
        SettingsError: A set-point exceeds a limit.
        RigError: The plan limits a quantity that the rig does not measure.
    """
    try:
        require_allowed(plan, profile)
    except LimitExceeded as error:
        raise SettingsError(
            f"{error}, the smaller of the plan's and that of the profile {profile.name}", file=file
        ) from error
