# SPDX-License-Identifier: MIT
"""Device profiles: TOML found by name or path, read once, every key checked."""

import difflib
import math
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any, Final, TypeVar

from rig.errors import ProfileError
from rig.toml_text import MOST_BYTES, parse_toml

SCHEMA: Final = 1
Choice = TypeVar("Choice", bound=str)


class Table:
    """One table of a profile, out of which each key is taken exactly once.

    Args:
        entries: The table.
        file: Where it stands, for messages.
        path: Dotted name of the table inside the file; empty for the whole file.
    """

    def __init__(self, entries: dict[str, Any], *, file: str, path: str = "") -> None:
        self.file = file
        self._entries = dict(entries)
        self._path = path
        self._known: list[str] = []

    @property
    def empty(self) -> bool:
        """Tell whether nothing is left to take."""
        return not self._entries

    def fault(self, problem: str, key: str | None = None) -> ProfileError:
        """Make an error that names the place."""
        dotted = ".".join(part for part in (self._path, key) if part)
        return ProfileError(problem, file=self.file, key=dotted or None)

    def table(self, key: str) -> "Table":
        """Take a table; an absent one is empty."""
        value = self._take(key, {})
        if not isinstance(value, dict):
            raise self.fault(f"found {value!r}; expected a table", key)
        return Table(value, file=self.file, path=f"{self._path}.{key}".strip("."))

    def text(self, key: str, default: str | None = None) -> str:
        """Take a text."""
        value = self._take(key, default)
        if not isinstance(value, str):
            raise self.fault(f"found {value!r}; expected a text", key)
        return value

    def choice(self, key: str, choices: tuple[Choice, ...]) -> Choice:
        """Take one of several texts."""
        value = self._take(key, None)
        for choice in choices:
            if value == choice:
                return choice
        raise self.fault(f"found {value!r}; expected one of {', '.join(choices)}", key)

    def whole(self, key: str, default: int | None = None, *, least: int = 0, most: int) -> int:
        """Take a whole number in a range, both ends included."""
        value = self._take(key, default)
        if not isinstance(value, int) or isinstance(value, bool) or not least <= value <= most:
            raise self.fault(f"found {value!r}; expected a whole number, {least} to {most}", key)
        return value

    def number(self, key: str, default: float | None = None) -> float:
        """Take a finite number."""
        return self._finite(self._take(key, default), key)

    def positive(self, key: str, default: float | None = None) -> float:
        """Take a number above 0."""
        value = self.number(key, default)
        if value <= 0:
            raise self.fault(f"found {value:g}; expected a number above 0", key)
        return value

    def positive_or_none(self, key: str) -> float | None:
        """Take a number above 0; None where it is absent."""
        if key in self._entries:
            return self.positive(key)
        self._known.append(key)
        return None

    def numbers(self, key: str, count: int) -> tuple[float, ...]:
        """Take so many finite numbers."""
        value = self._take(key, None)
        if not isinstance(value, list) or len(value) != count:
            raise self.fault(f"found {value!r}; expected {count} numbers", key)
        return tuple(self._finite(item, key) for item in value)

    def wholes(self, key: str, *, most: int) -> tuple[int, ...]:
        """Take a list of whole numbers from 0 to `most`."""
        value = self._take(key, None)
        items: list[Any] = value if isinstance(value, list) else [None]
        if any(type(item) is not int or not 0 <= item <= most for item in items):
            raise self.fault(f"found {value!r}; expected whole numbers, 0 to {most}", key)
        return tuple(items)

    def signs(self, key: str, count: int) -> tuple[int, ...]:
        """Take so many signs, each 1 or -1."""
        values = self.numbers(key, count)
        if any(value not in (-1, 1) for value in values):
            raise self.fault(f"found {list(values)}; expected {count} times 1 or -1", key)
        return tuple(int(value) for value in values)

    def sign(self, key: str, default: int = 1) -> int:
        """Take a sign, 1 or -1."""
        value = self._take(key, default)
        if value not in (-1, 1):
            raise self.fault(f"found {value!r}; expected 1 or -1", key)
        return int(value)

    def finish(self) -> None:
        """Refuse keys that nobody took.

        Raises:
            ProfileError: There is one; the nearest known key is named.
        """
        for key in self._entries:
            near = difflib.get_close_matches(key, self._known, n=1)
            hint = f"did you mean '{near[0]}'?" if near else f"known: {', '.join(self._known)}"
            raise self.fault(f"unknown key; {hint}", key)

    def _take(self, key: str, default: object) -> Any:
        self._known.append(key)
        if key not in self._entries and default is None:
            near = difflib.get_close_matches(key, self._entries, n=1, cutoff=0.8)
            hint = f"; found '{near[0]}': did you mean '{key}'?" if near else ""
            raise self.fault(f"is missing{hint}", key)
        return self._entries.pop(key, default)

    def _finite(self, value: object, key: str) -> float:
        if isinstance(value, int | float) and not isinstance(value, bool):
            number = float(value)
            if math.isfinite(number):
                return number
        raise self.fault(f"found {value!r}; expected a finite number", key)


def open_profile(name: str, *, device: str) -> Table:
    """Find a profile and begin to read it.

    Args:
        name: Name of a shipped profile, or path of a TOML file.
        device: Kind of device that the profile must be of.

    Returns:
        The whole file as a table, `schema` and `device` taken.

    Raises:
        ProfileError: There is none, it is not TOML, or it is another device's.
    """
    source = _find(name)
    try:
        with source.open("rb") as file:
            entries = parse_toml(file.read(MOST_BYTES + 1))
    except (OSError, ValueError) as problem:
        raise ProfileError(f"cannot be read as TOML: {problem}", file=str(source)) from problem
    table = Table(entries, file=source.name)
    table.whole("schema", least=SCHEMA, most=SCHEMA)
    found = table.text("device")
    if found != device:
        raise table.fault(f"describes '{found}'; expected a profile of '{device}'", "device")
    return table


def shipped_profiles() -> tuple[str, ...]:
    """List the names of the profiles that come with the package, sorted."""
    files = resources.files("rig").joinpath("profiles").iterdir()
    return tuple(sorted(f.name.removesuffix(".toml") for f in files if f.name.endswith(".toml")))


def shipped_file(name: str) -> Traversable:
    """Return a file that comes with the profiles, such as a DBC."""
    return resources.files("rig").joinpath("profiles", name)


def split_address(address: str) -> tuple[str, str]:
    """Split `PROFILE@PORT`.

    Args:
        address: As a person types it; the port may hold anything, another `@` too.

    Returns:
        Profile and port.

    Raises:
        ProfileError: One of them is missing.

    >>> split_address("zebro-100-serial@socket://127.0.0.1:7001")
    ('zebro-100-serial', 'socket://127.0.0.1:7001')
    """
    profile, _, port = address.partition("@")
    if not profile or not port:
        raise ProfileError(
            f"found '{address}'; expected PROFILE@PORT, such as zebro-100-serial@/dev/ttyUSB0"
        )
    return profile, port


def _find(name: str) -> Traversable:
    path = Path(name)
    if path.is_file():
        return path
    known = shipped_profiles()
    if name in known:
        return shipped_file(f"{name}.toml")
    near = difflib.get_close_matches(name, known, n=1)
    hint = f"did you mean '{near[0]}'?" if near else f"shipped are {', '.join(known)}"
    raise ProfileError(f"no profile '{name}' is shipped and no such file exists; {hint}")
