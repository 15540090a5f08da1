# SPDX-License-Identifier: MIT
"""Figures as they are handed over to be saved."""

from pathlib import Path

import pytest
from matplotlib.figure import Figure


def figures_saved(monkeypatch: pytest.MonkeyPatch) -> dict[str, Figure]:
    """Collect figures by file name in place of saving them; saving takes most of the time.

    Args:
        monkeypatch: Replaces `zebro_lab.plots.save` until the test ends.
    """
    saved: dict[str, Figure] = {}

    def keep(figure: Figure, path: Path) -> None:
        saved[path.name] = figure

    monkeypatch.setattr("zebro_lab.plots.save", keep)
    return saved
