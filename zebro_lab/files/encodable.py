# SPDX-License-Identifier: MIT
"""Make strings encodable as UTF-8: file names and arguments may contain invalid bytes."""

from collections.abc import Mapping


def encodable(value: object) -> object:
    r"""Replace lone surrogates by escapes such as `\udce9` in every string of a JSON document.

    Python represents bytes of file names that are not UTF-8 as lone surrogates.

    Args:
        value: A string, mapping (keys too), list or tuple (returned as list), nested; values of
            other types are kept.

    >>> encodable({"label": "caf\udce9", "n": 1})
    {'label': 'caf\\udce9', 'n': 1}
    """
    if isinstance(value, str):
        return value.encode("utf-8", "backslashreplace").decode("utf-8")
    if isinstance(value, Mapping):
        return {encodable(key): encodable(each) for key, each in value.items()}
    return [encodable(each) for each in value] if isinstance(value, list | tuple) else value
