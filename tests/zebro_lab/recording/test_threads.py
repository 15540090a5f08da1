# SPDX-License-Identifier: MIT
"""A thread that the system refuses is one line that says what to do."""

import pytest

from zebro_lab.files.errors import RecordingError
from zebro_lab.recording.threads import needing_threads


def test_a_refused_thread_says_what_to_do():
    with pytest.raises(RecordingError, match=r"can't start new thread: .*ulimit") as caught:  # noqa: SIM117
        with needing_threads():
            raise RuntimeError("can't start new thread")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("error", [RuntimeError("torn"), ValueError("can't start new thread")])
def test_other_errors_pass_unchanged(error):
    with pytest.raises(type(error)) as caught, needing_threads():
        raise error
    assert caught.value is error
