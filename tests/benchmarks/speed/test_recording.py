# SPDX-License-Identifier: MIT
from benchmarks.speed import recording


def test_a_second_of_all_three_devices_loses_nothing(rows):
    recording.main(["1"])
    table = {name: [int(cell) for cell in counts] for name, *counts in rows()}
    assert set(table) == {"legs", "imu", "load_cell"}
    assert all(received > 50 and dropped == 0 for received, _, _, dropped in table.values())
