# SPDX-License-Identifier: MIT
from benchmarks.speed import drivers


def test_every_driver_is_a_row(rows):
    drivers.serial_speed(2000)
    drivers.dump_speed(300)
    drivers.can_speed(300)
    drivers.load_cell_cpu(0.3)
    *fast, cell = rows()
    assert [row[0] for row in fast] == ["serial packets", "register dumps", "CAN frames"]
    assert all(float(row[1].split()[0].replace(",", "")) > 0 for row in fast)
    assert cell[2] == "0 lost"


def test_no_damaged_frame_is_handed_on_where_few_bits_flip(rows):
    drivers.damage(5000)
    table = rows()
    assert [row[1] for row in table] == ["5000"] * 5
    assert [row[3] for row in table[:3]] == ["0"] * 3
    assert [int(row[2]) for row in table] == sorted((int(row[2]) for row in table), reverse=True)
