# SPDX-License-Identifier: MIT
"""Compute the band of a finished walk, from a leg log or a gait."""

from model.gait.quantised import QuantisedLog
from model.gait.reference import LegReference
from model.poses import Poses
from model.progress import Watcher
from model.walk.traction import ToeLaw
from zebro_lab.files.errors import SettingsError
from zebro_lab.walk.path_band import BandRequest, predict_band
from zebro_lab.walk.walking import Walked


def band_of(
    request: BandRequest,
    walked: Walked,
    legs: LegReference | QuantisedLog,
    *,
    duration: float,
    toe: ToeLaw,
    watcher: Watcher,
) -> Poses:
    """Compute paths of a walk with its unknown parameters drawn, from time zero on.

    Args:
        request: Settings of the band.
        walked: The finished single walk.
        legs: Its leg angles.
        duration: Duration of the walk [s].
        toe: Traction of a leg on its toe.
        watcher: Receives progress.

    Raises:
        SettingsError: The model has no band.
    """
    if walked.model != "dynamics" or walked.slip is None:
        raise SettingsError(
            f"a band is predicted by the model 'dynamics' only, not by '{walked.model}'",
            key="--draws",
        )
    return predict_band(
        request, walked.described.robot, legs, walked.slip,
        duration=duration, toe=toe, informed=walked.informed, watcher=watcher,
    )  # fmt: skip
