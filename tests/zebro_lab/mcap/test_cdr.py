# SPDX-License-Identifier: MIT
"""Messages of a log as bytes."""

from zebro_lab.mcap.cdr import CdrWriter


def test_a_text_with_bytes_of_a_foreign_encoding_is_written_as_escapes():
    assert CdrWriter().text("caf\udce9").message().endswith(rb"caf\udce9" + b"\0")
