# SPDX-License-Identifier: MIT
"""What the whole ways share: commands alone, each of which must end as it is told to."""

from collections.abc import Callable

import pytest

from support.commands import within_process


@pytest.fixture
def command(monkeypatch, capsys) -> Callable[..., str]:
    """Return what runs `zebro-lab`, must end with an exit code, and returns what it printed."""
    run = within_process(monkeypatch, capsys)

    def checked(*arguments: object, code: int = 0) -> str:
        ended = run(*arguments)
        assert ended.code == code, ended
        return ended.out + ended.err

    return checked
