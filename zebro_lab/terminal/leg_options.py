# SPDX-License-Identifier: MIT
"""Options that several commands have for leg logs: their help, and names of joints."""

from typing import Final

from zebro_lab.files.errors import SettingsError

JOINTS: Final = "Columns or joints of legs 1 to 6, in this order, where their names do not tell."
TOPIC: Final = "Topic of a ROS log, where it has several of a kind; may be repeated."
_LEGS: Final = 6


def joint_names(text: str | None) -> tuple[str, ...]:
    """Return the names of `--joints`, separated by commas; none where the option is not given.

    Raises:
        SettingsError: There are not six names, or two are equal.

    >>> joint_names("a, b,c,d,e,f")
    ('a', 'b', 'c', 'd', 'e', 'f')
    """
    if text is None:
        return ()
    names = tuple(name.strip() for name in text.split(","))
    different = set(names) - {""}
    if len(names) != _LEGS or len(different) != _LEGS:
        raise SettingsError(
            f"found {len(different)} different names in '{text}'; expected the columns or joints "
            f"of legs 1 to {_LEGS}, separated by commas",
            key="--joints",
        )
    return names
