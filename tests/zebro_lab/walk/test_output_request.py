# SPDX-License-Identifier: MIT
"""Options of bands, pictures and contacts: a band that can be drawn, and no option in vain."""

import pytest
import typer

from zebro_lab.files.errors import SettingsError
from zebro_lab.terminal.picture_options import parse_instants
from zebro_lab.walk.output_request import BandRequest, PictureRequest
from zebro_lab.workers import WorkersRequest


def test_a_band_has_two_draws_or_none_and_no_negative_standard_deviation():
    assert BandRequest().draws == 0
    with pytest.raises(SettingsError, match="expected 2 or more, or 0"):
        BandRequest(1)
    with pytest.raises(SettingsError, match="--offset-sd-deg: expected 0 or more"):
        BandRequest(2, offset_sd_deg=-1.0)


def test_a_scheduler_without_draws_to_share_is_wrong_usage():
    address = "tcp://127.0.0.1:8786"
    assert BandRequest(2, scheduler=address).workers == WorkersRequest(scheduler=address)
    with pytest.raises(SettingsError, match="--scheduler: hands the draws of a band"):
        BandRequest(scheduler=address)


def test_times_of_snapshots_without_figures_are_refused():
    with pytest.raises(typer.BadParameter, match="--figures too"):
        PictureRequest(at=parse_instants("1,2"))
    assert PictureRequest(True, parse_instants("1,2")).snapshots == (1.0, 2.0)
