# SPDX-License-Identifier: MIT
"""Advice of a verdict that can be followed to the letter: lines of a plan, commands, options."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from model.slip.definition import SlipDefinition, convert_slip
from model.slip.law import Array
from model.slip.laws import LAWS
from model.slip.magic_formula import MagicFormula

SECONDS: Final = 2.0
"""Time of each further slip ratio [s]."""
ZERO_SECONDS: Final = 10.0
"""Time of a zero: noise that remembers 0.05 s leaves a tenth of itself in it [s]."""
SHORT: Final = 0.5
"""Time of a run that forces hardly drift in [s]."""
SHORT_ZERO: Final = 2.0
"""Time of the zero before each of these runs [s]."""
PASSES: Final = 4
"""Such runs of each slip ratio."""

_MEASURABLE = {
    SlipDefinition.MATERIAL: (-np.inf, 1.0),
    SlipDefinition.TRAVEL: (-0.9, np.inf),
    SlipDefinition.LARGER: (-0.9, 0.9),
}
"""Slip ratios that a rig can hold, without those where the leg disc would have to stand [-]."""


def measure_slips(reason: str, *, loads: Array, slips: Array, definition: SlipDefinition) -> str:
    """Format advice to measure further slip ratios at every load, and to fit them with the others.

    Args:
        reason: What the data lack, the first words of the advice.
        loads: Loads, shape (m,) [N].
        slips: Slip ratios, shape (n,) [-].
        definition: Definition of the slip ratios; those of a plan are material.
    """
    possible = np.clip(slips, *_MEASURABLE[definition])
    material = convert_slip(possible, definition, SlipDefinition.MATERIAL)
    numbers = list(dict.fromkeys(f"{slip:.2g}" for slip in material))
    lines = {
        "points": {
            "loads": f"[{', '.join(f'{load:.3g}' for load in loads)}]",
            "slips": f"[{', '.join(numbers)}]",
            "length": '"duration"',
            "duration": f"{SECONDS:.1f}",
        },
        "controls": {"tare_every": f"{len(numbers)}", "tare_duration": f"{ZERO_SECONDS:.1f}"},
    }
    return _plan(
        f"{reason}: measure {len(numbers)} more slip ratios (material definition), {SECONDS:g} s "
        f"each, at {len(loads)} load(s), the load cell zeroed for {ZERO_SECONDS:g} s before each "
        "load",
        lines,
        "then fit both (calibrate-slip DATA FURTHER)",
    )


def zero_before_each(reason: str) -> str:
    """Format advice to measure again in short runs with a zero of their own, and to fit only these.

    Args:
        reason: What the data show, the first words of the advice.
    """
    lines = {
        "points": {"length": '"duration"', "duration": f"{SHORT:.1f}", "repeats": f"{PASSES}"},
        "controls": {"tare_every": "1", "tare_duration": f"{SHORT_ZERO:.1f}"},
    }
    return _plan(
        f"{reason}: measure again in runs of {SHORT:g} s, the load cell zeroed for {SHORT_ZERO:g} s"
        " before each",
        lines,
        "then fit it alone (calibrate-slip FURTHER); if it says the same, forces drift too fast: "
        "let the load cell warm up, or mend it",
    )


def _plan(what: str, tables: dict[str, dict[str, str]], fit: str) -> str:
    """Format lines of a plan by table and key, and the commands that run and fit it."""
    heads = (f"[{table}]\n" + "\n".join(f"{key} = {value}" for key, value in keys.items())
             for table, keys in tables.items())  # fmt: skip
    return (
        f"{what}. In a copy of the plan, set these:\n"
        + "\n".join(heads)
        + "\nRun the copy into another folder, with the other options as before "
        f"(zebro-lab rig run COPY --rig RIG --data FURTHER), {fit}"
    )


def try_laws(reason: str, law: str, *, both_signs: bool) -> str:
    """Format advice to fit the same data with the other laws.

    Args:
        reason: What the data show, the first words of the advice.
        law: Name of the fitted law.
        both_signs: Whether slip is driving and braking, which may differ.
    """
    options = [f"--law {name}" for name in LAWS if name != law]
    if law == MagicFormula.name:
        options.append("--load-sensitivity")
    apart = "; else fit driving and braking apart ([rows] keep in columns.toml)"
    return (
        f"{reason}: give the same command with {', with '.join(options)}, each with an --out of "
        f"its own, and use the result that is trustworthy{apart if both_signs else ''}; if none "
        "is, check the slip definition (--slip-definition) and see residuals.png"
    )


def exclude_runs(reason: str, names: Sequence[str]) -> str:
    """Format advice to leave out runs that do not belong to the others, and to fit again.

    Args:
        reason: What the data show, the first words of the advice.
        names: Names of the runs, at least one.
    """
    commands = "\n".join(f"zebro-lab exclude DATA/{name} --why REASON" for name in names)
    return (
        f"{reason}: where the lab notes tell why (another material, a lost zero), leave these runs "
        "out, each with its reason, rows of a table by [rows] keep in columns.toml, and give the "
        f"same command again:\n{commands}"
    )


def beyond_the_peak(peaks: Array, slip: Array) -> Array:
    """Space slip ratios from the smallest peak's slip to four times the largest.

    They have the larger sign of the tested slips.

    Args:
        peaks: Slip of the peak at each load; infinite where there is none, which counts as the
            largest tested slip, shape (m,) [-].
        slip: Tested slip ratios, shape (n,) [-].
    """
    tested = np.minimum(peaks, np.abs(slip).max())
    side = 1.0 if slip.max() >= -slip.min() else -1.0
    return side * np.geomspace(float(tested.min()), 4 * float(tested.max()), 8)
