# SPDX-License-Identifier: MIT
"""Read and check a plan of a rig experiment; list its steps and duration, without motion."""

from dataclasses import dataclass
from pathlib import Path

from model.counted import counted
from rig.errors import LimitExceeded
from rig.experiment.plan import LIMIT_UNITS, Plan
from rig.experiment.plan_reading import parse_plan
from rig.experiment.steps import DurationEstimate, Point, Step, estimate, require_allowed, spell_out
from rig.openers import resolve
from rig.slip_rig.profile import RigProfile, load_rig_profile
from zebro_lab.experiment.opened_rig import TWIN_PROFILE
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


def in_words(foreseen: Foreseen, *, steps: bool) -> list[str]:
    """Return lines with points, duration and limits of a plan.

    Args:
        foreseen: The plan with its steps and duration.
        steps: Whether to list every step.
    """
    plan, points, lines = foreseen.plan, foreseen.plan.points, []
    minutes, seconds = divmod(round(foreseen.estimate.seconds), 60)
    lines.append(
        f"plan '{plan.name}', material {plan.material}, rig profile {foreseen.profile.name}"
    )
    lines.append(
        f"{counted(foreseen.estimate.points, 'point')} in all, check points included: "
        f"{counted(len(points.loads), 'load')} x {counted(len(points.slips), 'slip ratio')}, "
        f"gone through {counted(points.repeats, 'time')}, "
        f"order {points.order}{', slip ratios as one sweep' if points.sweep else ''}"
    )
    lines.append(
        f"the load is set {counted(foreseen.estimate.loads, 'time')}, 0 N included, by "
        f"{plan.load.set_by}"
    )
    lines.append(f"the plan takes about {minutes} min {seconds} s if every point is good at once")
    lines.append("limits of the plan, which all set-points keep, as those of the profile:")
    for name, unit in LIMIT_UNITS.items():
        value = getattr(plan.limits, name)
        limit = "the profile's, if any" if value is None else f"{value:g} {unit}"
        lines.append(f"  {name:<20}{limit:>24}")
    if plan.limits.guards_off:
        lines.append(f"guards switched off by the plan: {plan.limits.guards_off_text}")
    if steps:
        lines += [
            step.label if isinstance(step, Point) else f"zero-{step.number:04d}"
            for step in foreseen.steps
        ]
    return lines
