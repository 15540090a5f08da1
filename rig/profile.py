# SPDX-License-Identifier: MIT
"""Find device profiles (TOML) by name or path, and split addresses into profile and port."""

from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Final

from model.similar_name import nearest
from model.toml_table import MOST_BYTES, TomlTable, parse_toml
from rig.errors import ProfileError, WrongDevice

SCHEMA: Final = 1
"""Version of the layout of profiles; a file with another one is an error."""


class ProfileTable(TomlTable):
    """Table of a device profile; errors are `ProfileError`."""

    error = ProfileError


def open_profile(name: str, *, device: str) -> TomlTable:
    """Open a device profile by name or path as a validated TOML table.

    Args:
        name: Path of a TOML file, or name of a shipped profile where there is no such file.
        device: Kind of device that the profile must describe: `legs`, `imu` or `slip-rig`.

    Returns:
        The whole file as a table; `schema` and `device` are already read.

    Raises:
        ProfileError: There is no such profile, or it is not TOML or of another schema.
        WrongDevice: It describes another kind of device.
    """
    source = _find(name)
    try:
        with source.open("rb") as file:
            entries = parse_toml(file.read(MOST_BYTES + 1))
    except (OSError, ValueError) as problem:
        raise ProfileError(f"cannot be read as TOML: {problem}", file=str(source)) from problem
    table = ProfileTable(entries, file=source.name)
    table.whole("schema", least=SCHEMA, most=SCHEMA)
    found = table.text("device")
    if found != device:
        raise WrongDevice(found, expected=device, file=source.name)
    return table


def shipped_profiles() -> tuple[str, ...]:
    """List the names of the device profiles (legs, IMU, slip rig) in the package, sorted."""
    files = resources.files("rig").joinpath("profiles").iterdir()
    return tuple(sorted(f.name.removesuffix(".toml") for f in files if f.name.endswith(".toml")))


def shipped_file(name: str) -> Traversable:
    """Return the location of a file among the shipped profiles, such as a DBC; it may not exist."""
    return resources.files("rig").joinpath("profiles", name)


def split_address(address: str) -> tuple[str, str]:
    """Split `PROFILE@PORT` at the first `@`.

    Args:
        address: Address as typed by a person; the port may hold any character, `@` included.

    Returns:
        Name or path of the profile, and port.

    Raises:
        ProfileError: Profile or port is empty, or there is no `@`.

    >>> split_address("zebro-100-serial@socket://127.0.0.1:7001")
    ('zebro-100-serial', 'socket://127.0.0.1:7001')
    """
    profile, _, port = address.partition("@")
    if not profile or not port:
        raise ProfileError(
            f"found '{address}'; expected PROFILE@PORT with a profile of this device, such as for "
            "the legs zebro-100-serial@/dev/ttyUSB0"
        )
    return profile, port


def require_device(link: str, profile: str) -> None:
    """Raise where a profile's link or layout is `table`, an imported file.

    Args:
        link: Link of the profile, for a leg stream its layout.
        profile: Name of the profile, for the message.

    Raises:
        ProfileError: There is no device to open.
    """
    if link == "table":
        raise ProfileError("describes a file, not a device; use a device's profile", file=profile)


def _find(name: str) -> Traversable:
    """Find a profile by path or, where there is no such file, among the shipped ones by name.

    Raises:
        ProfileError: There is neither; the message suggests shipped ones.
    """
    path = Path(name)
    if path.is_file():
        return path
    known = shipped_profiles()
    if name in known:
        return shipped_file(f"{name}.toml")
    raise ProfileError(
        f"found neither a file '{name}' nor a shipped profile of that name; {nearest(name, known)}"
    )
