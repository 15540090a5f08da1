# SPDX-License-Identifier: MIT
"""Small inputs that unpack to much, or that take long to parse."""

import gzip

DEEP_TOML = b"a = " + b"[" * 200_000
_BOMBS_TOML = (
    DEEP_TOML,
    b"a = " + b"[" * 5000 + b"]" * 5000,
    b".".join([b"a"] * 200_000) + b" = 1\n",
    (b"[" + b".".join([b"a"] * 30) + b"]\n") + b"b=1\n" * 1,
    b"".join(b"[a%d]\n" % k for k in range(90_000)),
    b"a = " + b"9" * 400_000,
    b'a = "' + b"\\n" * 500_000 + b'"',
    b"x" * (5 << 20),
    b"[[a]]\n" * 170_000,
    b"\xff\xfe" + b"a\0" * 1000,
    b"a = [" + b"{}," * 340_000 + b"]",
    b"a" * 600_000 + b" = 1\n" + b"." * 400_000,
)
_BOMBS_JSON = (
    b"[" * 300_000,
    b'{"a":' * 100_000 + b"1" + b"}" * 100_000,
    b'{"kind": ' + b"9" * 3_000_000 + b"}",
    b"[" + b"[]," * 2_700_000 + b"[]]",
    b'{"a": "' + b"x" * (20 << 20) + b'"}',
    b'{"schema_version": 1e400, "kind": "\\ud800"}',
)


def toml_bombs() -> tuple[bytes, ...]:
    """Return TOML that is deep, long or slow to parse."""
    return _BOMBS_TOML


def json_bombs() -> tuple[bytes, ...]:
    """Return JSON that is deep, long or large in memory."""
    return _BOMBS_JSON


def csv_bombs() -> tuple[bytes, ...]:
    """Return tables that unpack to much more than they are."""
    head = gzip.compress(b"a,b,c,d,e,f,g,h\n")  # members of an archive follow each other
    many = head + gzip.compress(b"1,2,3,4,5,6,7,8\n" * 65536) * 300
    line = head + gzip.compress(b"1," * (1 << 20)) * 300
    text = gzip.compress(b"a,b\n" + b"".join(b"%x,z\n" % k for k in range(500_000))) * 12
    quote = gzip.compress(b'a,b\n"') + gzip.compress(b"x\n" * (1 << 20)) * 150
    return many, line, text, quote
