# SPDX-License-Identifier: MIT
"""Parse the address of a Dask scheduler, and keep unencrypted ones within a network of one's own.

Whoever can speak to a Dask scheduler can run any program on its workers, and who answers in its
place can run any on this machine: results are pickles. `tcp` neither encrypts nor asks who is
there.
"""

import ipaddress
import re
import socket
from dataclasses import dataclass
from typing import Final

from zebro_lab.files.errors import SettingsError

OPTION: Final = "--scheduler"
_ADDRESS: Final = re.compile(r"(tcp|tls)://(\[[0-9a-fA-F:.]+\]|[^\s:/\[\]]+):(\d{1,5})")


@dataclass(frozen=True)
class SchedulerAddress:
    """Address of a scheduler.

    Attributes:
        text: The address as given.
        protocol: `tcp`, or `tls` with certificates.
        host: Name or address of the host, without brackets.
        port: Port, 1 to 65535.
    """

    text: str
    protocol: str
    host: str
    port: int


def parse_address(text: str) -> SchedulerAddress:
    """Parse `tcp://HOST:PORT` or `tls://HOST:PORT`.

    Raises:
        SettingsError: The text has another form.

    >>> parse_address("tcp://127.0.0.1:8786").port
    8786
    """
    found = _ADDRESS.fullmatch(text)
    if found is None or not 0 < int(found[3]) < 65536:
        raise SettingsError(
            f"found '{text}'; expected tcp://HOST:PORT or tls://HOST:PORT, as dask scheduler "
            "prints it, such as tcp://127.0.0.1:8786",
            key=OPTION,
        )
    return SchedulerAddress(text, found[1], found[2].strip("[]"), int(found[3]))


def require_own_network(address: SchedulerAddress) -> None:
    """Check that an unencrypted scheduler is on this machine or in a private network.

    Raises:
        SettingsError: It is elsewhere, or its host is unknown.
    """
    if address.protocol == "tls":
        return
    try:
        found = socket.getaddrinfo(address.host, address.port, type=socket.SOCK_STREAM)
    except (OSError, UnicodeError) as error:
        raise SettingsError(
            f"the host '{address.host}' is unknown ({error}); check its name, or give its number",
            key=OPTION,
        ) from error
    for each in found:
        place = ipaddress.ip_address(str(each[4][0]).partition("%")[0])
        if not (place.is_private or place.is_loopback or place.is_link_local):
            raise SettingsError(
                f"{address.text} is {place}, outside of this machine and of private networks; tcp "
                "is open to everybody on the way: use tls:// with certificates, or a tunnel to "
                "127.0.0.1",
                key=OPTION,
            )
