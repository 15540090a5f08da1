# SPDX-License-Identifier: MIT
"""Half widths of the 90 % intervals of targets, from draws of the law."""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from typer import BadParameter

from model.arrays import Array
from model.similar_name import similar_name
from model.slip.law import SlipLaw
from zebro_lab.adaptive.wanted import HINT, Wanted
from zebro_lab.suggest.target_text import EXPECTED, ForceText, ParameterText, TargetText, WalkText

PROBABILITY: Final = 0.9
"""Probability of the interval whose half width is wanted."""


def require_parameters(wanted: Sequence[Wanted], laws: Sequence[SlipLaw]) -> None:
    """Raise `BadParameter` for a parameter that no law has; before anything is measured."""
    names = list(dict.fromkeys(p.name for law in laws for p in law.parameters))
    for each in wanted:
        target = each.target
        if isinstance(target, ParameterText) and target.name not in names:
            near = similar_name(target.name, names)
            hint = f"; did you mean '{near}'?" if near else ""
            raise BadParameter(
                f"'{target.name}' is no parameter of the Magic Formula, which has "
                f"{', '.join(names)}; expected {EXPECTED}{hint}",
                param_hint=HINT,
            )


def half_width(target: TargetText, law: SlipLaw, values: Array, loads: Sequence[float]) -> float:
    """Compute the half width of a target's 90 % interval; of several forces, the widest.

    Args:
        target: The target; not a walk, whose end has three parts.
        law: The law, of k parameters.
        values: Draws of its parameters, shape (w, k).
        loads: Loads of the plan [N].

    Returns:
        Half width, in the parameter's unit or relative to the force; NaN for a walk, and for a
        parameter that the law lacks.
    """
    if isinstance(target, ForceText):
        at = np.array(loads if target.load is None else [target.load])
        slip, load = np.meshgrid(np.array(target.slips), at)
        force = law.force(slip.ravel(), load.ravel(), values.T[:, :, None])
        return float(np.max(_half_widths(force / np.abs(np.median(force, axis=0)))))
    names = [parameter.name for parameter in law.parameters]
    if isinstance(target, WalkText) or target.name not in names:
        return math.nan
    return float(_half_widths(values[:, [names.index(target.name)]])[0])


def _half_widths(draws: Array) -> Array:
    """Compute the half widths of the 90 % intervals of columns of draws (w, m), shape (m,)."""
    tail = (1 - PROBABILITY) / 2
    low, high = np.quantile(draws, [tail, 1 - tail], axis=0)
    return np.asarray((high - low) / 2)
