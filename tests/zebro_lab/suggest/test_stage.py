# SPDX-License-Identifier: MIT
"""The stage reports its steps, and takes rates from profiles."""

import numpy as np
import pytest

from rig.slip_rig.profile import load_rig_profile
from support.short_calibration import calibration_folder
from support.suggestions import write_plan
from support.watchers import Nobody
from zebro_lab.files.errors import AlreadyExists
from zebro_lab.suggest import stage
from zebro_lab.suggest.folder import points_of
from zebro_lab.suggest.request import SuggestRequest
from zebro_lab.suggest.stage import suggest

pytestmark = pytest.mark.usefixtures("blank_pictures")


def test_a_suggestion_reports_its_steps_and_its_points(tmp_path):
    request = SuggestRequest(
        write_plan(tmp_path), calibration_folder(tmp_path / "mine"), ("friction",), rate=40.0,
        out=tmp_path / "out",
    )  # fmt: skip
    watcher = Nobody()
    found = suggest(request, watcher)
    steps = [what for what, _ in watcher.seen]
    assert steps[:2] == ["reading", "weighing the calibration's data"]
    assert ("choosing points", 0.0) in watcher.seen
    assert found.proposal.seconds <= found.plan_seconds
    assert found.calibration == "mine"
    numbers = points_of(found)
    assert numbers["plan_duration_s"] == found.plan_seconds
    assert sum(each["points"] for each in numbers["slips"]) == found.proposal.counts.sum()


def test_nothing_is_computed_where_the_result_cannot_be_written(tmp_path, monkeypatch):
    monkeypatch.setattr(stage, "foresee", lambda *_: pytest.fail("read"))
    (tmp_path / "out").write_text("a file")
    request = SuggestRequest(tmp_path / "p", tmp_path / "c", ("friction",), out=tmp_path / "out")
    with pytest.raises(AlreadyExists, match="is a file"):
        suggest(request, Nobody())


@pytest.mark.parametrize(
    ("name", "rate"), [("rig-board-serial", 1000.0), ("rig-odrive-netft", 7000.0)]
)
def test_the_rate_is_that_of_the_profile(name, rate):
    assert stage._rate(load_rig_profile(name)) == rate


def test_the_expected_sds_are_of_the_calibration_now(tmp_path):
    request = SuggestRequest(
        write_plan(tmp_path), calibration_folder(tmp_path / "mine"), ("friction",), rate=40.0,
        out=tmp_path / "out",
    )  # fmt: skip
    found = suggest(request, Nobody())
    z = stage._draws(request.calibration / "posterior.nc", found.knowledge.posterior, seed=1)
    values = found.knowledge.posterior.values(z)
    names = [p.name for p in found.knowledge.posterior.parameters]
    spread = np.std(values[:, names.index("friction")])
    assert 0.3 < found.expected[0].sd_now / spread < 3  # the chains are far from converged
