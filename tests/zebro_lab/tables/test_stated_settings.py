# SPDX-License-Identifier: MIT
"""Units come from the settings of LabVIEW and Motive, and from no others."""

import pytest

from zebro_lab.tables.stated_settings import SeveralSegments, after_lvm_header, stated_units


@pytest.mark.parametrize(
    ("settings", "names", "units"),
    [
        ([["Y_Unit_Label", "N", "", "V"]], ["X_Value", "a", "b", "c"], {"a": "N", "c": "V"}),
        ([["Y_Unit_Label", "N", "", "rpm"], ["X_Dimension", "Time", "", "Time"]],
         ["X_Value", "a", "X_Value (2)", "b"],
         {"X_Value": "s", "X_Value (2)": "s", "a": "N", "b": "rpm"}),
        ([["Y_Unit_Label", "N"], ["X_Dimension", "Frequency"]], ["X_Value", "a"], {"a": "N"}),
        ([["Format Version", "1.2", "Length Units", "Centimeters"]],
         ["Time", "Position X", "Rotation X"], {"Position X": "centimeters"}),
        ([["Format Version", "1.2", "Length Units"]], ["Position X"], {}),
        ([["Length Units", "Millimeters"]], ["Position X"], {}),
        ([], ["t"], {}),
    ],
)  # fmt: skip
def test_settings_state_units_of_channels_or_positions(settings, names, units):
    assert stated_units(settings, names) == units


def test_only_what_is_below_the_last_header_of_labview_is_left():
    end = "***End_of_Header***\t"
    lines = list(enumerate(["LabVIEW Measurement", end, "Channels\t1", end, "X_Value\ta"]))
    assert after_lvm_header(lines) == [(4, "X_Value\ta")]
    assert after_lvm_header(lines[4:]) == [(4, "X_Value\ta")]


def test_a_second_segment_of_labview_is_not_taken_for_the_whole_file():
    end = "***End_of_Header***\t"
    lines = list(
        enumerate(["LabVIEW Measurement", end, end, "X_Value\ta", "0\t1", end, "X_Value\ta"], 1)
    )
    with pytest.raises(SeveralSegments, match="that of the second ends in line 6: make a file of"):
        after_lvm_header(lines)
