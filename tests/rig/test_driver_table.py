# SPDX-License-Identifier: MIT
"""Every layout has a driver and a twin that can be imported, but that of a table."""

import pytest

from rig.driver_table import IMUS, LEGS, load_class
from rig.errors import ProfileError


@pytest.mark.parametrize("table", [LEGS, IMUS])
def test_every_layout_of_a_device_has_a_driver_and_a_twin(table):
    for layout, backend in table.items():
        for name in (backend.driver, backend.twin):
            if layout == "table":
                with pytest.raises(ProfileError, match="describes a file"):
                    load_class(name, profile="mine")
            else:
                assert load_class(name, profile="mine").__name__ == name.partition(":")[2]
