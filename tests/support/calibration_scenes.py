# SPDX-License-Identifier: MIT
"""Simulated calibrations with posterior draws whose truth is known, and their figures."""

from dataclasses import dataclass

import numpy as np
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from model.arrays import Array
from model.slip import MagicFormula, SlipDefinition
from zebro_lab.plots import (
    corner,
    parameter_labels,
    residuals,
    slip_curves,
    slip_surface,
    traces,
)

RIG_LOADS = np.array([2.13, 6.63, 8.13, 12.75])


@dataclass(frozen=True)
class Blocks:
    """Block means with the attributes that plots need."""

    slip: Array
    normal_force: Array
    traction_force: Array
    run: NDArray[np.intp]
    definition: str

    @property
    def run_names(self) -> tuple[str, ...]:
        return tuple(f"run {index}" for index in range(int(self.run[-1]) + 1))


@dataclass(frozen=True)
class Scene:
    """A simulated calibration, complete with posterior draws whose truth is known."""

    blocks: Blocks
    law: MagicFormula
    truth: Array
    draws: Array
    load_levels: Array

    def picture(self, name: str, *, simulated: bool = True) -> Figure:
        rng = np.random.default_rng(1)
        labels = parameter_labels(self.law.parameters)
        marks = {"simulated": simulated}
        match name:
            case "curves":
                return self.curves(simulated=simulated)
            case "surface":
                return slip_surface(self.blocks, self.law, values=self.truth, **marks)
            case "corner":
                return corner(self.draws, labels=labels, **marks)
            case "traces":
                return traces(self.draws.reshape(4, 50, -1), labels=labels, **marks)
        whitened, run_score = (
            rng.normal(size=count) for count in (len(self.blocks.slip), self.blocks.run[-1] + 1)
        )
        return residuals(self.blocks, whitened=whitened, run_score=run_score, **marks)

    def curves(self, *, simulated: bool = True) -> Figure:
        return slip_curves(
            self.blocks, self.law, draws=self.draws, load_levels=self.load_levels,
            simulated=simulated,
        )  # fmt: skip


def scene(
    law: MagicFormula,
    truth: list[float],
    slip: Array,
    load_levels: Array,
    noise: float,
    definition: str = SlipDefinition.MATERIAL,
) -> Scene:
    """Test every slip at every load, three blocks a run."""
    rng = np.random.default_rng(0)
    kappa, load = np.tile(slip, len(load_levels)), np.repeat(load_levels, len(slip))
    load = load * (1 + 0.01 * rng.normal(size=len(load)))
    force = law.force(kappa, load, truth) + noise * rng.normal(size=len(kappa))
    blocks = Blocks(kappa, load, force, np.arange(len(kappa)) // 3, definition)
    draws = np.array(truth) * (1 + 0.01 * rng.normal(size=(200, len(truth))))
    return Scene(blocks, law, np.array(truth), draws, load_levels)


def labelled_lines(figure: Figure, label: str) -> list:
    """Return the lines of a figure with a label."""
    return [line for axes in figure.axes for line in axes.lines if line.get_label() == label]


def scatters(axes) -> list[PathCollection]:
    """Return the clouds of points of a panel."""
    return [each for each in axes.collections if isinstance(each, PathCollection)]
