# SPDX-License-Identifier: MIT
"""Gaits: leg angles, touchdown and lift-off over time."""

from model.gait.buehler import buehler_clock, buehler_reference
from model.gait.cyclic import CyclicReference
from model.gait.direction import Direction, inner_legs
from model.gait.events import EventSystem, EventTimes, scheduled_reference
from model.gait.notation import TETRAPOD, TRIPOD, Gait, parse_gait
from model.gait.reference import LegReference, SampledReference
from model.gait.scheduler import straight_system
from model.gait.stance import stance_intervals
from model.gait.steering import TripodAngles, ideal_liftoff, tripod_angles, tripod_reference
from model.gait.suriana import suriana_reference
from model.gait.tetrapod import tetrapod_reference
from model.gait.turning import turning_system

__all__ = [
    "TETRAPOD",
    "TRIPOD",
    "CyclicReference",
    "Direction",
    "EventSystem",
    "EventTimes",
    "Gait",
    "LegReference",
    "SampledReference",
    "TripodAngles",
    "buehler_clock",
    "buehler_reference",
    "ideal_liftoff",
    "inner_legs",
    "parse_gait",
    "scheduled_reference",
    "stance_intervals",
    "straight_system",
    "suriana_reference",
    "tetrapod_reference",
    "tripod_angles",
    "tripod_reference",
    "turning_system",
]
