# SPDX-License-Identifier: MIT
"""Texts without what changes with every run: dates, places, versions, durations, hashes."""

import getpass
import re
import socket
from pathlib import Path

_RULES = (
    (r"data:[\w/+.-]+;base64,[A-Za-z0-9+/=]+", "EMBEDDED"),
    (r"(127\.0\.0\.1|localhost):\d+", "HOST:PORT"),
    (r"\b\d{8}T\d{6}(\.\d+)?Z", "TIME"),
    (r"\b\d{4}-\d\d-\d\d[T ]\d\d:\d\d(:\d\d)?(\.\d+)?( ?(Z|UTC|[+-]\d\d:?\d\d))?", "TIME"),
    (r"\b\d{4}-\d\d-\d\d\b", "DATE"),
    (r"\b[0-9a-f]{64}\b", "HASH"),
    (r"\b[0-9a-f]{40}\b", "COMMIT"),
    (r"\b\d+\.\d+\.\d+([.+-]?(dev|rc|post|a|b|g)\w*)*(\+\w+(\.\w+)*)?\b", "VERSION"),
    (r"(?<![.\w])(?=\d*[a-f])(?=[a-f]*\d)[0-9a-f]{7,12}\b(?![-+.]\d)", "COMMIT"),
    (r"\b(in|took) \d+(\.\d+)? ?(s|ms|min|h)\b", r"\1 DURATION"),
    (r"\b\d+:\d\d(:\d\d)?\b", "CLOCK"),
    (r"/tmp/[^\s'\",)]+", "SCRATCH"),  # noqa: S108 - it is looked for, not used
)  # fmt: skip
RULES = tuple((re.compile(pattern), instead) for pattern, instead in _RULES)


class Normaliser:
    """Takes out what the run, the machine and the place put into a text.

    Args:
        places: Folders whose absolute paths are replaced, by what they are called instead.
    """

    def __init__(self, places: dict[str, Path]) -> None:
        paths = [(str(form), name) for name, path in places.items()
                 for form in {path, path.absolute(), path.resolve()}]  # fmt: skip
        self._paths = sorted(paths, key=lambda each: -len(each[0]))
        names = {socket.gethostname(): "HOST", getpass.getuser(): "USER"}
        self._names = [(name, what) for name, what in names.items() if name != "root"]

    def text(self, text: str) -> str:
        """Return a text without them."""
        for path, name in self._paths:
            text = text.replace(path, name)
        for name, what in self._names:
            text = re.sub(rf"\b{re.escape(name)}\b", what, text)
        for rule, instead in RULES:
            text = rule.sub(instead, text)
        return text

    def name(self, name: str) -> str:
        """Return the name of a file without the time in it."""
        return re.sub(r"\d{8}T\d{6}(\.\d+)?Z", "TIME", name)
