# SPDX-License-Identifier: MIT
"""The bundled simulated walk, and a silent progress reporter."""

from pathlib import Path

import pandas as pd

WALK = Path(__file__).parents[2] / "datasets/walk-sim"
PHOTOS = WALK / "photos"
COMPOSITE = WALK / "composite/simulated_pasted.jpg"
SOME = ("00", "02", "03", "04", "05", "06")


class Nobody:
    """Progress that displays nothing, and requests a stop if `stops` is true."""

    def __init__(self, stops: bool = False) -> None:
        self.stops = stops

    def step(self, what: str, fraction: float | None) -> None:
        """Ignore the progress."""

    def stop_requested(self) -> bool:
        """Return whether a stop was requested."""
        return self.stops


def truth(photos) -> pd.DataFrame:
    """Return the true poses of the robot in photographs."""
    return pd.read_csv(WALK / "photos.csv").set_index("photo").loc[list(photos)]
