# SPDX-License-Identifier: MIT
"""Profiles with a fault in one place, which their reader must name."""

from collections.abc import Callable
from pathlib import Path

import pytest

from rig.errors import ProfileError
from rig.profile import shipped_file


def require_refused(
    load: Callable[[str], object], folder: Path, name: str, old: str, new: str, said: str
) -> None:
    """Replace a text of a shipped profile; check that one line names file and place."""
    text = shipped_file(f"{name}.toml").read_text()
    assert old in text
    path = folder / "mine.toml"
    path.write_text(text.replace(old, new))
    with pytest.raises(ProfileError, match=r"mine\.toml") as error:
        load(str(path))
    assert said in str(error.value)
    assert "\n" not in str(error.value)
