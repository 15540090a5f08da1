# SPDX-License-Identifier: MIT
r"""Leg angles of a walking program: cycles of different gaits, handed over by max-plus scheduling.

A program is a sequence of cycles, each by the event system of its own gait,

.. math::
    x(k) = A_0^{(k)} \otimes x(k) \oplus A_1^{(k)} \otimes x(k-1) .

Where the gait changes, or the robot stood before, the groups of the cycle before and after differ,
and the order of the new gait does not say whom its first group waits for. There every leg waits
until all legs are down. Legs turn at a constant speed between their events, forwards or backwards.
"""

from dataclasses import dataclass, replace

import numpy as np

from model.arrays import Array
from model.errors import DomainError
from model.gait.direction import Direction, is_inner
from model.gait.events import EventSystem
from model.gait.maxplus import oplus, otimes, solve_implicit
from model.gait.notation import Gait
from model.gait.reference import SampledReference
from model.gait.stance import Intervals, event_intervals
from model.gait.steering import ideal_liftoff, scaled_stance
from model.gait.swing import TURN, landing_angles, swing
from model.gait.turning import turning_system
from model.robot import N_LEGS

_SAME = 1e-9  # s or rad: times or angles nearer than this are equal


@dataclass(frozen=True, eq=False)
class CycleGait:
    """The gait of a program's cycles: when legs touch down and lift off, and at what angles.

    Attributes:
        system: Max-plus system of the event times.
        touchdown: Touchdown angles in the sense in which each leg turns, shape (6,) [rad].
        liftoff: Lift-off angles, shape (6,) [rad].
        sense: 1 for a leg that turns forwards, -1 backwards, shape (6,).
        leg_arc: Angle of the legs' arc [rad].
    """

    system: EventSystem
    touchdown: Array
    liftoff: Array
    sense: Array
    leg_arc: float = np.pi


def cycle_gait(
    gait: Gait,
    *,
    ground_time: float,
    flight_time: float,
    turn_time: float = 0.0,
    double_stance: float = 0.0,
    steering: float = 1.0,
    direction: Direction = "left",
    reverse: bool = False,
    touchdown: float = np.radians(50.0),
    liftoff: float | None = None,
    leg_arc: float = np.pi,
) -> CycleGait:
    """Construct the gait of a program's cycles from groups, times and steering.

    The outer legs stand from `touchdown` to `liftoff`. The inner legs' stance angle is the steering
    times theirs, between angles of equal hip height if the outer legs' are: at 1 the robot goes
    straight, at 0 the inner legs step on the spot, and at -1 they walk backwards as far as the
    outer legs walk forwards, so that the robot turns on the spot.

    Args:
        gait: Groups of legs.
        ground_time: tau_g [s].
        flight_time: tau_f [s].
        turn_time: tau_p, by which inner legs stand and outer legs fly longer [s].
        double_stance: tau_Delta [s].
        steering: Stance angle of the inner legs over that of the outer legs, from -1 to 1 [-].
        direction: Side of the inner legs, on which the centre of the circle is.
        reverse: Whether all legs turn the other way, so that the robot walks the same circle
            backwards; its heading then turns to the other side.
        touchdown: Touchdown angle of the outer legs walking forwards [rad].
        liftoff: Their lift-off angle; that of equal hip height when None [rad].
        leg_arc: Angle of the legs' arc [rad].

    Raises:
        DomainError: The steering is not from -1 to 1, the touchdown angle is not before that of the
            highest hip, or a time or another angle is impossible.
    """
    if not -1 <= steering <= 1:
        raise DomainError(
            f"steering is {steering:g}; expected from -1, a turn on the spot, to 1, straight; "
            "choose the side with direction"
        )
    inner = is_inner(direction)
    equally_high = float(ideal_liftoff(touchdown, leg_arc))
    outer_up = equally_high if liftoff is None else liftoff
    if not 0 < outer_up - touchdown < np.pi:
        raise DomainError(
            f"lift-off at {np.degrees(outer_up):g} degrees; expected beyond touchdown at "
            f"{np.degrees(touchdown):g}, by less than 180 degrees"
        )
    inner_down, inner_up = scaled_stance(touchdown, outer_up, abs(steering), leg_arc)
    down, up = np.where(inner, inner_down, touchdown), np.where(inner, inner_up, outer_up)
    sense = np.where(inner & (steering < 0), -1.0, 1.0) * (-1.0 if reverse else 1.0)
    system = turning_system(
        gait, inner=tuple(np.flatnonzero(inner).tolist()), ground_time=ground_time,
        flight_time=flight_time, turn_time=turn_time, double_stance=double_stance,
    )  # fmt: skip
    forwards = sense > 0
    return CycleGait(
        system, np.where(forwards, down, up), np.where(forwards, up, down), sense, leg_arc
    )


@dataclass(frozen=True, eq=False)
class _Cycle:
    """A cycle of a program: events and unwrapped angles of each leg, shape (6,) each.

    Attributes:
        gait: Its gait.
        liftoff: Lift-off times [s].
        touchdown: Touchdown times, which follow [s].
        lifted: Angles at lift-off; NaN of a leg that is stopped before, whose times are those of
            the cycle before [rad].
        landed: Angles at touchdown [rad].
        turned: Angles at which legs that swing to and fro turn round; NaN for others [rad].
        handed: Time when all legs were down before it, their angles there and how long they are
            held; None where the gait of the cycle before goes on.
        stopped: Time when legs on the ground were stopped, and the angles at which all legs stand
            then, those in flight once they are down; None for a whole cycle.
    """

    gait: CycleGait
    liftoff: Array
    touchdown: Array
    lifted: Array
    landed: Array
    turned: Array
    handed: tuple[float, Array, float] | None = None
    stopped: tuple[float, Array] | None = None

    @property
    def down(self) -> float:
        """When all legs are down [s]."""
        last = float(self.touchdown.max())
        return last if self.stopped is None else max(last, self.stopped[0])

    def knots(self, leg: int) -> list[tuple[float, float]]:
        """Return the knots of a leg's piecewise linear angle: times [s] and angles [rad]."""
        found = []
        if self.handed is not None:
            at, held, pause = self.handed
            found += [(at, held[leg]), (at + pause, held[leg])]
        up, down, lifted = self.liftoff[leg], self.touchdown[leg], self.lifted[leg]
        out, back = abs(self.turned[leg] - lifted), abs(self.landed[leg] - self.turned[leg])
        if np.isfinite(lifted):
            found.append((up, lifted))
            if np.isfinite(out):
                found.append((up + (down - up) * out / (out + back), self.turned[leg]))
            found.append((down, self.landed[leg]))
        if self.stopped is not None and (np.isnan(lifted) or down < self.stopped[0]):
            found.append((self.stopped[0], self.stopped[1][leg]))
        return found


@dataclass(frozen=True, eq=False)
class ProgramLegs:
    """The cycles of a program so far; `with_cycle` and `with_stand` return longer programs.

    Time zero is when all legs are down, in the rhythm of the first gait. What follows never changes
    the angles up to `end`.

    Attributes:
        cycles: The cycles, of which the first is the one that ends at time zero.
        standing: How long the robot stands after the last cycle [s].
    """

    cycles: tuple[_Cycle, ...]
    standing: float = 0.0

    @classmethod
    def beginning_with(cls, gait: CycleGait) -> "ProgramLegs":
        """Begin a program with all legs on the ground, in the rhythm of a gait."""
        steady = gait.system.steady_state
        last = steady.touchdown[0].max()
        down, up = steady.touchdown[0] - last, steady.liftoff[0] - last
        none = np.full(N_LEGS, np.nan)
        return cls((_Cycle(gait, up, down, gait.liftoff, gait.touchdown, none),))

    @property
    def end(self) -> float:
        """When all legs are down after the last cycle, and the standing after it is over [s]."""
        return self._down + self.standing

    @property
    def _down(self) -> float:
        """When all legs are down after the last cycle [s]."""
        return self.cycles[-1].down

    def with_cycle(self, gait: CycleGait) -> "ProgramLegs":
        """Return the program with one more cycle.

        Where the gait goes on, the scheduler alone says who waits for whom. Else all legs are down
        before one lifts off, and until it does a leg turns towards its new lift-off angle, no
        faster than on the ground in the faster of the two gaits: a leg that lifts off at once does
        so from where it is, to the side on which it leaves the ground.

        Args:
            gait: Gait of the cycle.
        """
        last = self.cycles[-1]
        if gait is last.gait and self.standing == 0 and last.stopped is None:
            up, down = self._events(gait, last.touchdown, last.liftoff)
            lifted, handed = last.landed + _nearest(gait.liftoff - last.landed), None
        else:
            angles = self._angles_at_end()
            shift = self.standing
            up, down = self._events(
                gait, last.touchdown + shift, last.liftoff + shift, all_down=self.end
            )
            fastest = np.maximum(_stance_speed(last.gait), _stance_speed(gait)) * (up - self.end)
            way = np.clip(_nearest(gait.liftoff - angles), -fastest, fastest)
            lifted = angles + way
            handed = self._down, angles, self.standing
        landed, turned = swing(
            lifted, gait.touchdown, gait.sense, leg_arc=gait.leg_arc, clear=handed is not None
        )
        cycle = _Cycle(gait, up, down, lifted, landed, turned, handed)
        return ProgramLegs((*self.cycles, cycle))

    def stopped_at(self, time: float) -> "ProgramLegs":
        """Return the program with its last cycle stopped: legs on the ground are held from a time.

        Legs in flight then still come down, at the angle at which they touch the ground beside the
        legs that stand, so that they do not move the robot; a leg past that angle is down at once,
        where it is. If no leg stands, they land as in the whole cycle. Others do not lift off any
        more.

        Args:
            time: From when all legs were down before the cycle to when they are after it [s].
        """
        last, before, gait = self.cycles[-1], self.cycles[-2], self.cycles[-1].gait
        angles = self.reference(before.down).angles(time)[0]
        flown = last.liftoff < time - _SAME
        flies = flown & (last.touchdown > time + _SAME)
        landed, down = last.landed, np.where(flown, last.touchdown, before.touchdown)
        if flies.any() and not flies.all():
            found = landing_angles(angles, flies, gait.sense, leg_arc=gait.leg_arc)
            touching = landed + _nearest(found - landed)
            past = gait.sense * (angles - touching) > 0  # pushes on the ground already
            landed = np.where(flies, np.where(past, angles, touching), landed)
            down = np.where(flies & past, time, down)
        cycle = replace(
            last,
            liftoff=np.where(flown, last.liftoff, before.liftoff),
            touchdown=down,
            lifted=np.where(flown, last.lifted, np.nan),
            landed=landed,
            stopped=(time, np.where(flies, landed, angles)),
        )
        return ProgramLegs((*self.cycles[:-1], cycle))

    def with_stand(self, duration: float) -> "ProgramLegs":
        """Return the program with all legs held, on the ground, for a time [s] at its end."""
        return ProgramLegs(self.cycles, self.standing + duration)

    def reference(self, begin: float = 0.0) -> SampledReference:
        """Compute the leg angles to `end`.

        Args:
            begin: Time from which they are needed, from zero to `end` [s].

        Raises:
            DomainError: The program has no time after `begin`.
        """
        cycles = self._cycles_from(begin)
        legs = [self._knots(cycles, leg) for leg in range(N_LEGS)]
        times = np.concatenate([[begin], *(t for t, _ in legs)])
        times = np.unique(times[(times >= begin) & (times <= self.end)])
        times = times[np.concatenate([[True], np.diff(times) > _SAME])]
        return SampledReference(
            times, np.column_stack([np.interp(times, t, angle) for t, angle in legs])
        )

    def stance_intervals(self) -> Intervals:
        """Compute when each leg stands, rows (touchdown, lift-off), from time zero to `end` [s]."""
        down = np.array([cycle.touchdown for cycle in self.cycles])
        up = np.array([cycle.liftoff for cycle in self.cycles[1:]] + [np.full(N_LEGS, self.end)])
        return event_intervals(down, up, (0.0, self.end))

    def _cycles_from(self, begin: float) -> tuple[_Cycle, ...]:
        """Return the last cycles, of which the first is over at or before a time [s]."""
        first = len(self.cycles) - 1
        while first > 0 and self.cycles[first].down > begin:
            first -= 1
        return self.cycles[first:]

    def _knots(self, cycles: tuple[_Cycle, ...], leg: int) -> tuple[Array, Array]:
        """Return the knots of a leg's piecewise linear angle in cycles: times [s], angles [rad]."""
        last = self._angles_at_end()[leg]
        found = [knot for cycle in cycles for knot in cycle.knots(leg)]
        times, angles = zip(*found, (self._down, last), (self.end, last), strict=True)
        return np.array(times), np.array(angles)

    def _angles_at_end(self) -> Array:
        """Return where legs are when all are down, if the last gait goes on until then, (6,)."""
        last = self.cycles[-1]
        if last.stopped is not None:
            return last.stopped[1]
        up, _ = self._events(last.gait, last.touchdown, last.liftoff)
        share = (self._down - last.touchdown) / (up - last.touchdown)
        return last.landed + share * _nearest(last.gait.liftoff - last.landed)

    @staticmethod
    def _events(
        gait: CycleGait, touchdown: Array, liftoff: Array, *, all_down: float = -np.inf
    ) -> tuple[Array, Array]:
        """Return lift-offs and touchdowns, (6,) each, of the cycle after one with given events [s].

        They follow by the gait's max-plus system; no leg lifts off before the time `all_down`.
        """
        n = N_LEGS
        before = otimes(gait.system.A1, np.concatenate([touchdown, liftoff]))
        before[n:] = oplus(before[n:], all_down)
        x = solve_implicit(gait.system.A0, before)
        return x[n:], x[:n]


def _nearest(angle: Array) -> Array:
    """Return angles modulo a turn, from -180 to below 180 degrees [rad]."""
    return (angle + np.pi) % TURN - np.pi


def _stance_speed(gait: CycleGait) -> Array:
    """Return the speed of each leg on the ground, without its sign, shape (6,) [rad/s]."""
    system = gait.system
    stands = system.cycle_time - (system.steady_state.touchdown - system.steady_state.liftoff)[0]
    return np.abs(_nearest(gait.liftoff - gait.touchdown)) / stands
