# SPDX-License-Identifier: MIT
"""Rig tables in the forms in which people publish them: from `init` to samples."""

import re
import shutil
from pathlib import Path

import numpy as np
import pytest

from zebro_lab.calibration.rig_data import RigData, read_rig_data
from zebro_lab.exchange.init_stage import write_columns_template

RADII = {
    '# radius_leg = "35 mm"': 'radius_leg = "35 mm"',
    '# radius_ground = "120 mm"': 'radius_ground = "120 mm"',
}
MATERIAL = {'definition = "?"': 'definition = "material"'}
TRIALS = {'each_row = "?"': "each_row = true"}


@pytest.fixture
def whole_way(tmp_path, shared):
    """Return a function that copies a table, fills in what `init` asks, and reads the samples."""

    def read(name: str, filled_in: dict[str, str], *, asked: str = "") -> RigData:
        folder = tmp_path / Path(name).stem
        folder.mkdir()
        file = Path(shutil.copy(shared / name, folder))
        columns = write_columns_template(file).file
        text = columns.read_text(encoding="utf-8")
        assert asked in text
        for question, answer in filled_in.items():
            assert question in text
            text = text.replace(question, answer)
        columns.write_text(text.replace('?"', '"'), encoding="utf-8")
        return read_rig_data([file])

    return read


def test_a_dead_weight_is_stated_once(whole_way):
    load = {'normal_force = "?"': 'normal_force = "6.6 N"'}
    data = whole_way("strangers/calibration/constant-load/table.csv", load | MATERIAL | TRIALS)
    np.testing.assert_allclose(data.samples.normal_force, 6.6)
    assert data.samples.n_runs == len(data.samples) == 20


def test_the_unit_of_forces_with_subscripts_is_asked_for(whole_way):
    name = "strangers/calibration/force-subscript-n/rig.csv"
    data = whole_way(name, RADII | {'unit = "N?"': 'unit = "lbf"'})
    assert data.samples.normal_force[0] == pytest.approx(0.8896 * 4.4482216)
    assert data.samples.traction_force[0] == pytest.approx(0.3092 * 4.4482216)


def test_labview_without_times(whole_way):
    data = whole_way("strangers/calibration/labview-no-x-column/rig.lvm", RADII)
    np.testing.assert_allclose(np.diff(data.samples.time), 0.05)
    assert data.samples.n_runs == 32


def test_an_export_of_national_instruments(whole_way):
    data = whole_way("strangers/calibration/ni-channel-unit-rows/rig.csv", RADII)
    assert data.samples.normal_force[0] == 8.0034
    assert data.samples.slip[0] == pytest.approx(1 - 27.167 * 120 / (95.493 * 35))


def test_a_slide_to_roll_ratio(whole_way):
    name = "strangers/calibration/srr-definition/mtm.csv"
    data = whole_way(name, TRIALS, asked='definition = "mean?"')
    assert data.notes[0] == "slip as given in 'SRR (%)', definition mean, converted to material"
    ends = [data.samples.slip.min(), data.samples.slip.max()]
    np.testing.assert_allclose(ends, [-0.6 / 0.7, 0.6 / 1.3])


def test_times_rounded_to_milliseconds(whole_way):
    data = whole_way("strangers/calibration/time-rounded-to-ms/rig.csv", RADII)
    steps = np.diff(data.samples.time)[np.diff(data.samples.run) == 0]
    np.testing.assert_allclose(steps, 0.0005, rtol=0.01)
    assert sum("times repeat" in note for note in data.notes) == 1


def test_the_order_of_trials_does_not_matter_without_times(whole_way):
    read = [
        whole_way(f"strangers/calibration/sorted-table/table-{order}.csv", MATERIAL | TRIALS)
        for order in ("sorted", "shuffled")
    ]
    assert not any(re.search(r"\btime\b", note) for data in read for note in data.notes)
    rows = [np.column_stack((each.samples.slip, each.samples.traction_force)) for each in read]
    np.testing.assert_array_equal(*(each[np.lexsort(each.T)] for each in rows))


def test_means_with_standard_deviations(whole_way):
    data = whole_way("strangers/calibration/drawbar-table/swt.csv", MATERIAL | TRIALS)
    np.testing.assert_array_equal(data.samples.force_sd, np.ones(11))


def test_speeds_of_surfaces_in_millimetres_a_second(whole_way):
    data = whole_way("realdata/ball-on-disc/sweeps.csv", {}, asked='unit = "mm/s"')
    assert data.samples.n_runs == 44
    assert data.samples.slip[0] == pytest.approx(1 - 22.57 / 27.05)
