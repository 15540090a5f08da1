# SPDX-License-Identifier: MIT
"""Errors of devices, their ports and their profiles; each message is one line."""

from os import PathLike


class RigError(Exception):
    """Root of every error that `rig` raises on purpose."""


class LinkError(RigError, ConnectionError):
    """A port, bus or network device cannot be opened, or does not answer."""


class InUse(LinkError):
    """Another program has the lock of a device or folder that one program at a time can use."""


class PartFailed(RigError, RuntimeError):
    """A part of a running experiment failed: a thread, the keyboard, the control socket.

    Attributes:
        part: Name of the part.
    """

    def __init__(self, part: str, error: BaseException) -> None:
        super().__init__(" ".join(f"{part} failed: {type(error).__name__}: {error}".split()))
        self.part = part


class RigTimeout(RigError, TimeoutError):
    """A device did not respond, or did not do what was commanded, within its timeout.

    Attributes:
        waited: Time for which the device was waited for [s].
    """

    def __init__(self, problem: str, *, waited: float, advice: str = "") -> None:
        super().__init__(f"{problem} within {waited:.4g} s" + (f"; {advice}" if advice else ""))
        self.waited = waited


class ProtocolError(RigError, ValueError):
    """Bytes, or values to be encoded, violate the device's protocol."""


class DeviceMismatch(RigError, ValueError):
    """Another device is at the port than the profile describes, or than was there before."""


class DeviceFault(RigError, RuntimeError):
    """A device reports a fault, or does not do what was commanded.

    Attributes:
        status: Error or status word as the device sent it; for a leg the channel, from 0; for the
            load cell of an experiment 1.
    """

    def __init__(self, problem: str, *, status: int) -> None:
        super().__init__(problem)
        self.status = status


class LimitExceeded(RigError, ValueError):
    """A set-point or a measured value lies outside its limit.

    Attributes:
        value: Value that was found.
        limit: Largest magnitude allowed.
        unit: Unit of the value and the limit.

    >>> str(LimitExceeded("speed of the leg disc", value=31.0, limit=25.0, unit="rad/s"))
    'speed of the leg disc is 31 rad/s; its limit is 25 rad/s'
    """

    def __init__(self, quantity: str, *, value: float, limit: float, unit: str) -> None:
        super().__init__(f"{quantity} is {value:g} {unit}; its limit is {limit:g} {unit}")
        self.value = value
        self.limit = limit
        self.unit = unit


class StaleReading(LimitExceeded):
    """A reading is too old to describe the present state of the rig."""


class FrozenReading(RigError, ValueError):
    """A sensor gives the same value, bit for bit, while the measured quantity must change.

    Attributes:
        value: Time without any change [s].
        limit: Longest time allowed [s].

    >>> str(FrozenReading("speed of the leg disc", value=0.3, limit=0.25))
    'speed of the leg disc stayed the same, bit for bit, for 0.3 s; the limit is 0.25 s'
    """

    def __init__(self, what: str, *, value: float, limit: float) -> None:
        super().__init__(
            f"{what} stayed the same, bit for bit, for {value:.3g} s; the limit is {limit:g} s"
        )
        self.value = value
        self.limit = limit


class UnreliableRecords(RigError, ValueError):
    """A device's record numbers restart repeatedly, or most records are missing or rejected."""


class NotAtRest(RigError, TimeoutError):
    """Standstill of the discs could not be verified; the rig must not be touched.

    Attributes:
        limit: Largest speed of a disc that stands [rad/s].

    >>> str(NotAtRest("the disc turns", limit=0.1))
    'the disc turns; at rest its mean speed is at most 0.1 rad/s: do not touch the discs'
    """

    def __init__(self, problem: str, *, limit: float) -> None:
        super().__init__(f"{problem}; at rest its mean speed is at most {limit:g} rad/s: do not "
                         "touch the discs")  # fmt: skip
        self.limit = limit


class ProfileError(RigError, ValueError):
    """A device profile has an invalid or missing value.

    Attributes:
        problem: What was found, what was expected, what to try.
        file: Name or path of the profile; None where there is no file.
        key: Dotted key inside the file; None for the whole file.

    >>> str(ProfileError("expected a number", file="mine.toml", key="legs.sign"))
    'mine.toml, legs.sign: expected a number'
    """

    def __init__(
        self, problem: str, *, file: str | PathLike[str] | None = None, key: str | None = None
    ) -> None:
        place = ", ".join(str(part) for part in (file, key) if part is not None)
        super().__init__(" ".join(f"{place}: {problem}".split() if place else problem.split()))
        self.problem = problem
        self.file = file
        self.key = key


class WrongDevice(ProfileError):
    """A profile describes another kind of device than the one that is opened.

    Attributes:
        found: Kind of device that the profile describes.

    >>> str(WrongDevice("imu", expected="legs", file="mine.toml"))
    "mine.toml, device: found 'imu'; expected a profile of the device 'legs'"
    """

    def __init__(self, found: str, *, expected: str, file: str | PathLike[str]) -> None:
        super().__init__(
            f"found '{found}'; expected a profile of the device '{expected}'", file=file,
            key="device",
        )  # fmt: skip
        self.found = found
