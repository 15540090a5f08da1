# SPDX-License-Identifier: MIT
"""Check the form of an address of a device that is given as an option."""

from rig.errors import ProfileError
from rig.profile import split_address
from zebro_lab.files.errors import SettingsError

_REPLAY = "replay:"


def require_address(address: str, *, key: str, replay: bool = False) -> None:
    """Check that an address is PROFILE@PORT or `sim`; the profile is not looked up.

    Args:
        address: The address, as given.
        key: The option, for the error.
        replay: Whether `replay:RUN` is an address as well.

    Raises:
        SettingsError: The address has another form.
    """
    is_replay = replay and address.startswith(_REPLAY) and address != _REPLAY
    if address == "sim" or is_replay:
        return
    try:
        split_address(address)
    except ProfileError as error:
        others = "sim or replay:RUN" if replay else "sim"
        raise SettingsError(f"{error}, or {others}", key=key) from error
