# SPDX-License-Identifier: MIT
"""Measure how a six-legged robot's feet slip, and predict where it walks.

>>> import zebro_lab as zl
>>> zl.walk_gait("tripod", slip="coulomb:0.4", duration=2.0).path.length > 0.1
True
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    __version__: str
    from zebro_lab.front.calibrations import (
        CalibrationResult,
        calibrate,
        read_rig_data,
        read_slip_curve,
    )
    from zebro_lab.front.runs import Run, open_devices, open_run, write_report
    from zebro_lab.front.tracks import read_track, track_photos, validate_walks
    from zebro_lab.front.walks import WalkResult, predict_walk, read_legs, walk_gait

_FRONT = ("calibrations", "walks", "tracks", "runs")

__all__ = [
    "CalibrationResult",
    "Run",
    "WalkResult",
    "__version__",
    "calibrate",
    "open_devices",
    "open_run",
    "predict_walk",
    "read_legs",
    "read_rig_data",
    "read_slip_curve",
    "read_track",
    "track_photos",
    "validate_walks",
    "walk_gait",
    "write_report",
]


def __getattr__(name: str) -> Any:
    """Return a name of `__all__`, imported only when it is used, so that commands start fast.

    Raises:
        AttributeError: The name is not in `__all__`.
        ImportError: zebro-lab is not installed, for its version; for the other names a package of
            zebro-lab is missing or shadowed by another file.
    """
    if name == "__version__":
        from importlib.metadata import version

        return version("zebro-lab")
    if name in __all__:
        import_module("zebro_lab.start").require_own_packages()
        rooms = (import_module(f"zebro_lab.front.{each}") for each in _FRONT)
        return next(getattr(room, name) for room in rooms if hasattr(room, name))
    raise AttributeError(f"module 'zebro_lab' has no attribute '{name}'")


def __dir__() -> list[str]:
    """Return the public names, `__all__`, sorted."""
    return sorted(__all__)
