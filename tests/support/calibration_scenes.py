# SPDX-License-Identifier: MIT
"""Simulated calibrations with posterior draws whose truth is known, and their figures."""

from dataclasses import dataclass, replace

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from model.arrays import Array
from model.slip import MagicFormula, SlipDefinition
from zebro_lab.plots.noise import residuals
from zebro_lab.plots.posterior import corner, traces
from zebro_lab.plots.sheet import Page, parameter_labels
from zebro_lab.plots.slip import slip_curves
from zebro_lab.plots.slip_law import slip_surface

SCREEN = Page(simulated=True)
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

    def picture(self, name: str, page: Page = SCREEN) -> Figure:
        rng = np.random.default_rng(1)
        labels = parameter_labels(self.law.parameters)
        marks = {"page": page}
        match name:
            case "curves":
                return self.curves(page)
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

    @property
    def corrected(self) -> Blocks:
        return replace(
            self.blocks, slip=self.blocks.slip - 0.001,
            traction_force=self.blocks.traction_force + 0.02 * self.blocks.normal_force,
        )  # fmt: skip

    def curves(self, page: Page = SCREEN, *, of_runs: bool = False) -> Figure:
        slip = self.law.peak_slip(self.load_levels, self.truth)
        force = self.law.force(slip, self.load_levels, self.truth)
        driving = np.stack(np.broadcast_arrays(slip, force), axis=1)
        return slip_curves(
            self.blocks, self.corrected, self.law, draws=self.draws, plain=0.9 * self.truth,
            loads=self.load_levels, peaks=np.stack([driving, -driving], axis=1),
            of_runs=of_runs, page=page,
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
