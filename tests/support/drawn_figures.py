# SPDX-License-Identifier: MIT
"""Figures as they are handed over to be saved."""

from pathlib import Path

import pytest
from matplotlib.figure import Figure


def figures_saved(monkeypatch: pytest.MonkeyPatch) -> dict[str, Figure]:
    """Collect figures by file name in place of saving them; saving takes most of the time.

    Args:
        monkeypatch: Replaces what saves a figure until the test ends.
    """
    saved: dict[str, Figure] = {}

    def keep(figure: Figure, path: Path, **_options: object) -> None:
        saved[path.name] = figure

    monkeypatch.setattr(Figure, "savefig", keep)
    return saved
