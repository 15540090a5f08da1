# SPDX-License-Identifier: MIT
"""The rig message of earlier versions is read, whoever wrote it."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from zebro_lab.mcap.cdr import CdrWriter
from zebro_lab.mcap.slip_rig_log import (
    SCHEMA_NAME,
    SCHEMA_TEXT,
    TOPIC,
    SlipRigTable,
    decode_block,
)

FIELDS = ("t", "omega_leg", "omega_ground", "normal_force", "traction_force")


def make_table(n: int) -> SlipRigTable:
    measured = np.random.default_rng(0).normal(size=(4, n))
    return SlipRigTable(np.arange(n) * 1e-3, *measured)


@given(st.integers(1, 70).flatmap(lambda n: arrays("f8", (n, 5))))
def test_block_round_trips_every_double(rows):
    message = CdrWriter()
    for column in rows.T:
        message.array(column)
    np.testing.assert_array_equal(decode_block(message.message()), rows)


def test_we_read_what_the_general_ros2_writer_writes(tmp_path):
    from mcap_ros2.writer import Writer

    from zebro_lab.mcap.slip_rig_log import read_log

    table = make_table(7)
    with (tmp_path / "log.mcap").open("wb") as file, Writer(file) as writer:
        schema = writer.register_msgdef(SCHEMA_NAME, SCHEMA_TEXT)
        message = SimpleNamespace(**{name: getattr(table, name).tolist() for name in FIELDS})
        writer.write_message(TOPIC, schema, message, log_time=0)
    read = read_log(tmp_path / "log.mcap")
    assert read.damage is None
    np.testing.assert_array_equal(read.table.rows(), table.rows())


@pytest.mark.parametrize("data", [b"", b"\0\1\0\0", b"\0\0\0\0" + bytes(44), bytes(48)])
def test_foreign_message_is_refused(data):
    with pytest.raises(ValueError, match="a message"):
        decode_block(data)
