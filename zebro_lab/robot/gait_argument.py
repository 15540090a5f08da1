# SPDX-License-Identifier: MIT
"""Parse gait options of a command line and construct the gait."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from model.errors import DomainError
from model.gait import (
    TETRAPOD,
    TRIPOD,
    CyclicReference,
    Direction,
    EventSystem,
    Gait,
    TripodAngles,
    buehler_reference,
    inner_legs,
    parse_gait,
    scheduled_reference,
    suriana_reference,
    tetrapod_reference,
    tripod_angles,
    tripod_reference,
    turning_system,
)
from model.robot import N_LEGS
from model.similar_name import nearest
from zebro_lab.files.errors import SettingsError
from zebro_lab.robot.gait_request import GaitRequest


@dataclass(frozen=True)
class NamedGait:
    """A constructed gait.

    Attributes:
        reference: Leg angles over time.
        what: Name of the gait with its main parameters, for titles.
        direction: Side that the gait turns to, if it turns: the one requested, "left" by default.
        schedule: The max-plus system that gave the times; None where none did.
    """

    reference: CyclicReference
    what: str
    direction: Direction = "left"
    schedule: EventSystem | None = None


@dataclass(frozen=True)
class _Kind:
    """Names of the options that a gait accepts, and its constructor, given the legs' arc [rad]."""

    options: tuple[str, ...]
    make: Callable[[GaitRequest, float], NamedGait]


def make_gait(request: GaitRequest, *, leg_arc: float) -> NamedGait:
    """Construct a gait from its parameters.

    Args:
        request: Name and parameters of the gait.
        leg_arc: Angle of the legs' arc [rad].

    Raises:
        SettingsError: The gait is unknown, its groups of legs cannot be parsed, or it lacks a given
            option; or an angle cannot be parsed, is other than 0 and below `LEAST_DEG`, or is two
            where the gait has one for all legs.
        DomainError: The gait is impossible with these parameters.

    >>> gait = make_gait(GaitRequest(steering=1.1, touchdown_deg="50"), leg_arc=np.pi)
    >>> gait.what, np.degrees(gait.reference.liftoff).round(1).tolist()[:2]
    ('tripod, s = 1.1, left', [118.0, 120.7])
    """
    kind = _GROUPS if "{" in request.name else GAITS.get(request.name)
    if kind is None:
        raise SettingsError(
            f"'{request.name}' is not a gait; {nearest(request.name, list(GAITS))}, or groups of "
            'legs such as "{1,4} < {2,5} < {3,6}"',
            key="--gait",
        )
    for option in request.given():
        if option not in kind.options:
            known = ", ".join(map(_flag, kind.options))
            raise SettingsError(
                f"does not apply to gait '{request.name}', which has {known}", key=_flag(option)
            )
    return kind.make(request, leg_arc)


def _tripod(request: GaitRequest, leg_arc: float) -> NamedGait:
    """Construct the tripod gait; touchdown is at 50 deg and a cycle takes 2 s by default.

    Angles that are not given follow from the steering factor and the legs' arc [rad].
    """
    inner_down, outer_down = _angles(request.touchdown_deg, "touchdown_deg", default=50.0)
    inner_up, outer_up = _angles(request.liftoff_deg, "liftoff_deg")
    if inner_down is None:
        raise _no_angle("touchdown_deg", request.touchdown_deg)
    angles = tripod_angles(
        inner_down,
        _or(request.steering, 1.0),
        leg_arc=leg_arc,
        inner_liftoff=inner_up,
        outer_touchdown=outer_down,
        outer_liftoff=outer_up,
    )
    reference = tripod_reference(angles, _or(request.cycle, 2.0), direction=request.side)
    return NamedGait(reference, _tripod_name(angles, request.side), request.side)


def _tripod_name(angles: TripodAngles, side: Direction) -> str:
    """Return the name of a tripod with its steering factor and side, or "tripod, straight".

    It is straight if the factor is within 5e-4 of 1, and inner and outer legs touch down at angles
    within 1e-3 rad.
    """
    factor = angles.steering_factor
    if np.isclose(factor, 1.0, atol=5e-4) and np.isclose(
        angles.inner_touchdown, angles.outer_touchdown, atol=1e-3
    ):
        return "tripod, straight"
    return f"tripod, s = {factor:.4g}, {side}"


def _suriana(request: GaitRequest, _: float) -> NamedGait:
    """Construct Suriana's tripod, which turns by its stance times, with the thesis's angles."""
    times = _turn_times(request)
    reference = suriana_reference(*_stance(request, *_THESIS_TURN), direction=request.side, **times)
    return NamedGait(reference, _turn_name("suriana", request, times), request.side)


def _maxplus(request: GaitRequest, _: float) -> NamedGait:
    """Construct the tripod whose times max-plus algebra schedules."""
    return _scheduled(request, TRIPOD, "max-plus", _stance(request, *_THESIS_TURN))


def _groups(request: GaitRequest, _: float) -> NamedGait:
    """Construct a gait given by groups of legs, such as "{1,4} < {2,5} < {3,6}".

    Raises `SettingsError` if they cannot be parsed.
    """
    try:
        gait = parse_gait(request.name, N_LEGS)
    except DomainError as error:
        raise SettingsError(str(error), key="--gait") from error
    return _scheduled(request, gait, str(gait), _stance(request, *_THESIS_TURN))


def _scheduled(
    request: GaitRequest, gait: Gait, name: str, stance: tuple[float, float], **defaults: float
) -> NamedGait:
    """Schedule a gait of any groups of legs by max-plus algebra.

    Args:
        request: Times that were given.
        gait: The groups of legs.
        name: Name of the gait, for titles.
        stance: Touchdown and lift-off angle [rad].
        defaults: Stance and flight time for `_turn_times`, if they are not given [s].
    """
    times, inner = _turn_times(request, **defaults), inner_legs(request.side)
    touchdown, liftoff = stance
    waits = _or(request.tau_double, 0.0)
    system = turning_system(gait, inner=inner, double_stance=waits, **times)
    reference = scheduled_reference(
        system, touchdown, liftoff=liftoff, inner=inner if times["turn_time"] else ()
    )
    return NamedGait(reference, _turn_name(name, request, times), request.side, system)


def _turn_times(
    request: GaitRequest, *, ground: float = 0.8, flight: float = 0.8
) -> dict[str, float]:
    """Return stance, flight and turn time as given, or by default `ground`, `flight` and 0 [s]."""
    return {
        "ground_time": _or(request.tau_ground, ground),
        "flight_time": _or(request.tau_flight, flight),
        "turn_time": _or(request.tau_turn, 0.0),
    }


def _turn_name(name: str, request: GaitRequest, times: Mapping[str, float]) -> str:
    """Return the name of a gait with its turn time and side, or straight where that time is 0."""
    turn = times["turn_time"]
    return f"{name}, tau_p = {turn:g} s, {request.side}" if turn else f"{name}, straight"


def _tetrapod(request: GaitRequest, _: float) -> NamedGait:
    """Construct the tetrapod of the thesis, by default from 45 to 135 deg in a cycle of 3 s.

    If an option of `_SCHEDULED` is given, max-plus algebra schedules its groups of legs instead,
    with two thirds of the cycle on the ground.
    """
    touchdown, liftoff = _stance(request, 45.0, 135.0)  # 5-5-1 of the thesis
    cycle = _or(request.cycle, 3.0)
    if any(option in _SCHEDULED for option in request.given()):
        return _scheduled(
            request, TETRAPOD, "tetrapod", (touchdown, liftoff),
            ground=2 * cycle / 3, flight=cycle / 3,
        )  # fmt: skip
    # Other angles than the thesis's put legs 2 and 5 out of rhythm if they start at 90 degrees.
    reference = tetrapod_reference(touchdown, liftoff, cycle_time=cycle, middle_start=None)
    return NamedGait(reference, "tetrapod")


def _buehler(request: GaitRequest, _: float) -> NamedGait:
    """Construct the Buehler clock, whose stance lasts half a cycle by default."""
    cycle = _or(request.cycle, 2.0)
    reference = buehler_reference(
        *_stance(request, 50.0, 118.0),
        ground_time=_or(request.tau_ground, cycle / 2),
        cycle_time=cycle,
    )
    return NamedGait(reference, "Buehler clock")


_THESIS_TURN = (35.0, 130.0)  # touchdown and lift-off of 5-2-4 [deg]
LEAST_DEG = 3.2  # in degrees a leg would touch down far ahead of the body, or lift off there
_ANGLES = ("touchdown_deg", "liftoff_deg")
_TIMES = ("tau_ground", "tau_flight", "tau_turn")
_SCHEDULED = (*_TIMES, "tau_double")  # any of them has the tetrapod scheduled
_SCHEDULE = ("direction", *_SCHEDULED)
GAITS: Mapping[str, _Kind] = MappingProxyType({
    "tripod": _Kind(("steering", "direction", *_ANGLES, "cycle"), _tripod),
    "suriana": _Kind(("direction", *_ANGLES, *_TIMES), _suriana),
    "maxplus": _Kind((*_SCHEDULE, *_ANGLES), _maxplus),
    "tetrapod": _Kind((*_SCHEDULE, *_ANGLES, "cycle"), _tetrapod),
    "buehler": _Kind((*_ANGLES, "cycle", "tau_ground"), _buehler),
})  # fmt: skip
"""Options and constructor of each gait, by its name on a command line."""
_GROUPS = _Kind((*_SCHEDULE, *_ANGLES), _groups)


def _or(value: float | None, default: float) -> float:
    """Return a value, or the default if it is None."""
    return default if value is None else value


def _stance(request: GaitRequest, touchdown: float, liftoff: float) -> tuple[float, float]:
    """Parse touchdown and lift-off angle, one each for all legs [rad]; defaults are in degrees."""
    return (
        _angle(request.touchdown_deg, "touchdown_deg", touchdown),
        _angle(request.liftoff_deg, "liftoff_deg", liftoff),
    )


def _angle(text: str | None, option: str, default: float) -> float:
    """Parse an angle in degrees, the same for all legs, to radians; `default` is in degrees.

    Raises `SettingsError` if it is no number, or two different ones.
    """
    first, second = _angles(text, option, default=default)
    if first is None:
        raise _no_angle(option, text)
    if second is not None and second != first:
        raise SettingsError(
            f"found two angles, '{text}'; this gait takes one, for all legs", key=_flag(option)
        )
    return first


def _angles(
    text: str | None, option: str, *, default: float | None = None
) -> tuple[float | None, float | None]:
    """Parse INNER[,OUTER] in degrees to radians, None for an angle that is not given.

    Without `text`, INNER is `default` [deg]. Raises `SettingsError` for any other text, and for
    angles other than 0 and below `LEAST_DEG`, which are probably in radians.
    """
    if text is None:
        return (None if default is None else float(np.radians(default))), None
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError as error:
        raise _no_angle(option, text) from error
    if len(numbers) > 2 or not np.isfinite(numbers).all():
        raise _no_angle(option, text)
    if any(0 < abs(number) < LEAST_DEG for number in numbers):
        in_degrees = ",".join(f"{np.degrees(number):.4g}" for number in numbers)
        raise SettingsError(
            f"found {text}, which is improbable in degrees; expected angles like 50, or 0: if it "
            f"is in radians, write {in_degrees}",
            key=_flag(option),
        )
    inner, outer = [*np.radians(numbers).tolist(), None][:2]
    return inner, outer


def _no_angle(option: str, text: str | None) -> SettingsError:
    """Return an error that the text of an option is no angle."""
    return SettingsError(
        f"'{text}' is not an angle; expected degrees like 50; tripod: or INNER,OUTER like 50,46",
        key=_flag(option),
    )


def _flag(option: str) -> str:
    """Return the option of a field as on a command line: `--tau-turn` of `tau_turn`."""
    return "--" + option.replace("_", "-")
