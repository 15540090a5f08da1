# SPDX-License-Identifier: MIT
"""The band of a finished walk, whether a log's or a gait's legs made it."""

from model.gait.quantised import QuantisedLog
from model.gait.reference import LegReference
from model.walk.ensemble import PathEnsemble
from model.walk.traction import ToeLaw
from zebro_lab.files.errors import SettingsError
from zebro_lab.terminal.watcher import Watcher
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
) -> PathEnsemble:
    """Walk an ensemble of what is not known about a walk, from time zero on.

    Args:
        request: What is asked of the band.
        walked: The finished single walk.
        legs: Its leg angles.
        duration: Time walked [s].
        toe: Traction of a leg on its toe.
        watcher: Who follows.

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
