# SPDX-License-Identifier: MIT
"""The bundled, simulated walk, and somebody who follows its tracking without a word."""

import sys
from pathlib import Path

import pandas as pd

COMMAND = str(Path(sys.executable).with_name("zebro-lab"))
WALK = Path(__file__).parents[2] / "datasets/walk-sim"
PHOTOS = WALK / "photos"
COMPOSITE = WALK / "composite/simulated_pasted.jpg"
SOME = ("00", "02", "03", "04", "05", "06")


class Nobody:
    """Follows without a word, and asks to stop where told to."""

    def __init__(self, stops: bool = False) -> None:
        self.stops = stops

    def step(self, what: str, fraction: float | None) -> None:
        """Hear nothing."""

    def stop_requested(self) -> bool:
        """Ask to stop."""
        return self.stops


def truth(photos) -> pd.DataFrame:
    """Return where the robot was in photographs."""
    return pd.read_csv(WALK / "photos.csv").set_index("photo").loc[list(photos)]
