# SPDX-License-Identifier: MIT
"""Measure the gain of the load cell with known weights, as the gain prior of a fit."""

import math
from collections.abc import Callable
from pathlib import Path

from rig.experiment.control import Control
from rig.experiment.plan import LoadSetting
from rig.experiment.weigh import GainCheck, Weighing, check_gain, weigh
from zebro_lab.experiment.opened_rig import opened_rig
from zebro_lab.experiment.request import WeighRequest
from zebro_lab.files.atomic import atomic_write_text
from zebro_lab.files.errors import AlreadyExists, SettingsError
from zebro_lab.tables.columns import COLUMNS_FILE


def _require_finite(request: WeighRequest) -> None:
    """Raise `SettingsError` for a mass or gravity that is NaN or infinite."""
    given = {"--masses": request.masses, "--gravity": [request.gravity]}
    for option, numbers in given.items():
        for number in numbers:
            if not math.isfinite(number):
                raise SettingsError(f"found {number:g}; expected a finite number", key=option)


def weigh_masses(
    request: WeighRequest, prompt: Callable[[str, float], None], control: Control
) -> tuple[Weighing, GainCheck, Path | None]:
    """Measure the load cell's gain with known weights, and write the gain prior for the fit.

    Args:
        request: Options of `zebro-lab rig weigh`.
        prompt: Called repeatedly with the operator's instruction and the present normal force [N].
        control: Mailbox that receives the operator's confirmation.

    Returns:
        The readings, the line through them, and the written file; None without `--data`.

    Raises:
        SettingsError: A mass is missing, not positive or too heavy for the rig, a number is not
            finite, or `--fast` is given for a rig that cannot run in simulated time.
        AlreadyExists: The folder has a `columns.toml` already; nothing was measured.
        RigError: The address or profile is invalid, a disc
            turns, the load cell sends too few samples, or a device failed.
        OSError: The file cannot be written.
    """
    _require_finite(request)
    if not request.masses or min(request.masses) <= 0:
        raise SettingsError("expected masses above 0 kg, such as 0.2,0.5,1", key="--masses")
    target = None if request.data is None else request.data / COLUMNS_FILE
    if target is not None and target.exists():
        raise AlreadyExists(f"{target} exists; omit --data and copy the printed [load_cell]")
    forces = [mass * request.gravity for mass in request.masses]
    with opened_rig(request.rig, seed=request.seed, fast=request.fast) as rig:
        _require_hangable(request, rig.bench.profile.limits.normal_force)
        # No tolerance: the check is to find the error of the reading.
        load = rig.load_setter(LoadSetting("hand", math.inf, patience=0.0), control)
        with rig.bench:
            weighing = weigh(
                rig.bench, forces, load=load, prompt=prompt, clock=rig.clock, period=rig.period
            )
    check = check_gain(weighing)
    if target is not None:
        target.parent.mkdir(parents=True, exist_ok=True)
        atomic_write_text(target, render_load_cell(check))
    return weighing, check, target


def _require_hangable(request: WeighRequest, limit: float) -> None:
    """Raise `SettingsError` for a mass whose weight is beyond the rig's limit [N]."""
    for mass in request.masses:
        weight = mass * request.gravity
        if weight > limit:
            raise SettingsError(
                f"a mass of {mass:g} kg weighs {weight:.4g} N, beyond the rig's limit of "
                f"{limit:g} N; masses are in kg: {mass:g} g is {mass / 1000:g}",
                key="--masses",
            )


def render_load_cell(check: GainCheck) -> str:
    """Format a load cell check as the text of `columns.toml`: `[load_cell]` gain_sd, bias_sd."""
    return (
        "# From a check of the load cell with known weights.\n"
        "[load_cell]\n"
        f"gain_sd = {check.gain_sd:.3g}\n"
        f'bias_sd = "{check.bias_sd:.3g} N"\n'
    )


def in_words(weighing: Weighing, check: GainCheck, written: Path | None) -> list[str]:
    """Return lines with the readings, the line through them, and the prior or where it is written.

    A slope that differs from 1 by over two standard deviations is followed by what to correct.

    Args:
        weighing: The readings.
        check: The line through them.
        written: The written file; None where there is none.
    """
    lines = []
    for force, reading, error in zip(
        weighing.forces, weighing.readings, weighing.errors, strict=True
    ):
        lines.append(
            f"weight of {force:8.3f} N: the load cell reads {reading:8.4f} +/- {error:.4f} N"
        )
    lines.append(
        f"reading per force {check.slope:.5f} +/- {check.slope_sd:.5f} (expected 1), unloaded "
        f"{check.zero:.4f} +/- {check.zero_sd:.4f} N, largest residual {check.misfit:.4f} N"
    )
    if abs(check.slope - 1) > 2 * check.slope_sd:
        lines.append(
            "the gain is wrong: in the rig's profile (a copy, if it is a shipped one) multiply "
            f"counts_per_force by {abs(check.slope):.5f}"
            f"{', reverse the sign of the normal force' if check.slope < 0 else ''}, then run "
            "`zebro-lab rig weigh` again with it"
        )
    return lines + (
        render_load_cell(check).splitlines() if written is None else [f"wrote {written}"]
    )
