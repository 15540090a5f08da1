# SPDX-License-Identifier: MIT
"""Texts that a file in UTF-8 can hold: names and arguments may come with bytes that are none."""

from collections.abc import Mapping


def encodable(value: object) -> object:
    r"""Turn what is no character into an escape, in every text of a JSON document.

    Python keeps such bytes, of a foreign encoding, as halves of surrogate pairs.

    Args:
        value: A text, or mappings and sequences of texts; anything else stays.

    >>> encodable({"label": "caf\udce9", "n": 1})
    {'label': 'caf\\udce9', 'n': 1}
    """
    if isinstance(value, str):
        return value.encode("utf-8", "backslashreplace").decode("utf-8")
    if isinstance(value, Mapping):
        return {encodable(key): encodable(each) for key, each in value.items()}
    return [encodable(each) for each in value] if isinstance(value, list | tuple) else value
