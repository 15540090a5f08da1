# SPDX-License-Identifier: MIT
"""Check a plan and list its steps and duration, without motion."""

from dataclasses import dataclass
from pathlib import Path

from rig.experiment.plan import Plan
from rig.experiment.steps import DurationEstimate, Step, estimate, spell_out
from rig.openers import resolve
from rig.slip_rig.profile import RigProfile, load_rig_profile
from zebro_lab.experiment.plan_file import read_plan, require_plan_allowed
from zebro_lab.experiment.rig_at_hand import TWIN_PROFILE


@dataclass(frozen=True)
class Foreseen:
    """Steps and estimated duration of a plan.

    Attributes:
        plan: The plan.
        profile: Profile of the rig that it was checked against.
        steps: Steps of the plan in order: points and measurements of the zero offset.
        estimate: Estimated duration of the steps.
    """

    plan: Plan
    profile: RigProfile
    steps: tuple[Step, ...]
    estimate: DurationEstimate


def foresee(file: Path, rig: str) -> Foreseen:
    """Check a plan against its own limits and the rig's; list its steps and their duration.

    Args:
        file: Plan file (TOML).
        rig: Name of the rig's profile, with or without `@PORT`; `sim` means `TWIN_PROFILE`.

    Raises:
        ZebroLabError: The plan cannot be read, or a set-point exceeds a limit.
        RigError: The profile is missing or invalid, or the plan limits a quantity that the rig does
            not measure.
    """
    plan = read_plan(file)
    name = resolve(rig, default=TWIN_PROFILE)[0] if "@" in rig or rig == "sim" else rig
    profile = load_rig_profile(name)
    require_plan_allowed(file, plan, profile)
    steps = spell_out(plan)
    return Foreseen(plan, profile, steps, estimate(plan, steps))
