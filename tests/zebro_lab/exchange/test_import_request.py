# SPDX-License-Identifier: MIT
"""Options of an import are checked before a file is opened."""

from datetime import datetime
from pathlib import Path

import pytest

from zebro_lab.exchange.import_request import ImportRequest
from zebro_lab.files.errors import SettingsError


@pytest.mark.parametrize(
    ("given", "option"),
    [
        ({"start": datetime(2026, 1, 1)}, "--start: .* no time zone"),
        *(({"start": datetime.fromisoformat(text)}, "--start: .* 1970 to 2038-01-19")
          for text in ("0001-01-01T00:00:00+14:00", "1969-12-31T23:59:59+00:00",
                       "9999-12-31T23:59:59-14:00", "2038-01-19T00:00:00+00:00")),
        ({"track_sd_yaw": "1 deg"}, "--track-sd: needs that of the position"),
        ({"track_sd": "0 mm"}, "--track-sd: found 0 mm; expected above 0"),
        ({"track_sd": "1 km"}, "--track-sd: found 1 km; .* at most 0.5 m"),
        ({"joints": "a,b"}, "--joints: found 2 different names"),
    ],
)  # fmt: skip
def test_what_no_import_can_take_is_wrong_usage(given, option):
    with pytest.raises(SettingsError, match=f"^{option}"):
        ImportRequest(Path("data"), **given)


def test_standard_deviations_are_in_si():
    found = ImportRequest(Path("data"), track_sd="2 mm", track_sd_yaw="0.1 rad").pose_sd
    assert found == pytest.approx((0.002, 0.1))
