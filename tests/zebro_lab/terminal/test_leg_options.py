# SPDX-License-Identifier: MIT
"""Six different names, or none, are the joints of the legs."""

import pytest

from zebro_lab.files.errors import SettingsError
from zebro_lab.terminal.leg_options import joint_names


def test_names_are_separated_by_commas():
    assert joint_names(None) == ()
    assert joint_names(" a,b, c,d,e,leg 6") == ("a", "b", "c", "d", "e", "leg 6")


@pytest.mark.parametrize(
    "text", ["", "a", "a,b,c,d,e", "a,b,c,d,e,f,g", "a,b,c,d,e,a", "a,b,c,d,e,"]
)
def test_other_than_six_different_names_are_refused(text):
    with pytest.raises(SettingsError, match=r"--joints: found \d different names"):
        joint_names(text)
