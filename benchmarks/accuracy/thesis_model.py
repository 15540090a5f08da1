# SPDX-License-Identifier: MIT
"""Print the numbers that docs/thesis-model.md quotes.

Usage: python -m benchmarks.accuracy.thesis_model
"""

from typing import Any

import numpy as np

from benchmarks.accuracy.chatter import sign_changes_per_second
from model.contact.detection import DETECTIONS, detect_contacts
from model.contact.sequence import contact_cycle, contact_states
from model.gait.cyclic import CyclicReference
from model.gait.direction import Direction
from model.gait.reference import SampledReference
from model.gait.steering import tripod_angles, tripod_reference
from model.gait.tetrapod import tetrapod_reference
from model.robot import GRAVITY, Robot
from model.slip.magic_formula import curvature_from_peak
from model.walk.no_slip import walk_no_slip, walk_wheels
from model.walk.path import WalkPath, turning_radius
from model.walk.thesis import (
    THESIS_TRACTION,
    SwitchedLegs,
    ThesisOptions,
    walk_thesis,
)
from model.walk.thesis.traction import Traction

ROBOT = Robot()
WEIGHT = ROBOT.mass * GRAVITY
SLIPPERY = THESIS_TRACTION._replace(friction=THESIS_TRACTION.friction / 5)


def gait(
    steering: float, inner_deg: float = 50.0, cycle: float = 2.0, direction: Direction = "left"
) -> CyclicReference:
    """Return a steering-factor tripod with matched hip heights."""
    angles = tripod_angles(np.radians(inner_deg), steering)
    return tripod_reference(angles, cycle, direction=direction)


def walk(
    reference: CyclicReference,
    duration: float,
    *,
    traction: Traction = THESIS_TRACTION,
    **options: Any,
) -> WalkPath:
    """Walk by the thesis's model, kept at 1 ms."""
    settings = ThesisOptions(**options)
    legs = SwitchedLegs.of(reference)
    return walk_thesis(ROBOT, legs, duration=duration, traction=traction, options=settings)


def radius(path: WalkPath, cycle: float = 2.0) -> float:
    """Compute the radius of whole strides after the first [m]."""
    n = round(cycle / float(path.t[1] - path.t[0]))
    return turning_radius(path.position[n::n, :2], path.yaw[n::n])


def chatter() -> None:
    """Item 1: sign changes of the slip ratio against the step."""
    for dt in (0.001, 0.0005, 0.0002, 0.0001):
        rates = [sign_changes_per_second(walk(gait(s), 10.0, dt=dt)) for s in (1.1, 1.3)]
        print(f"sign changes per contact second, dt = {1000 * dt:g} ms: s = 1.1 {rates[0]:.0f}, "
              f"s = 1.3 {rates[1]:.0f}")  # fmt: skip


def radii() -> None:
    """Item 2: the models' turning radii, and what a fifth of the grip changes."""
    for s in (1.1, 1.2, 1.3, 1.5):
        reference = gait(s)
        rolling = radius(walk_no_slip(ROBOT, reference, duration=12.0))
        wheels = radius(walk_wheels(ROBOT, reference, duration=12.0))
        coarse = radius(walk(reference, 12.0))
        full, fifth = (
            walk(reference, 12.0, dt=0.0001, every=10, traction=traction)
            for traction in (THESIS_TRACTION, SLIPPERY)
        )
        change = 100 * (fifth.yaw[-1] / full.yaw[-1] - 1)
        print(f"s = {s}: wheels {wheels:.3f}, no-slip {rolling:.3f}, source {coarse:.3f} at 1 ms, "
              f"{radius(full):.3f} at 0.1 ms; a fifth of the grip {radius(fifth):.3f} m, "
              f"yaw {change:+.2f} %")  # fmt: skip


def compass() -> None:
    """Item 5: distance by heading, and how far the body sinks without reset."""
    lengths = [walk(gait(1.25, 45.0, 1.0), 4.0, heading=np.radians(h)).length
               for h in (0, 90, 180, 270)]  # fmt: skip
    print("metres in 4 s at yaw 0, 90, 180, 270:", " ".join(f"{x:.3f}" for x in lengths))
    for s in (1.0, 1.25):
        for dt in (0.001, 0.0001):
            path = walk(gait(s, 45.0, 1.0), 40.0, dt=dt, every=round(0.001 / dt),
                        reset_height=False)  # fmt: skip
            z = path.position[:, 2]
            print(f"height lost in 40 s without reset, s = {s}, dt = {1000 * dt:g} ms: "
                  f"{1000 * (z[:1000].mean() - z[-1000:].mean()):.1f} mm")  # fmt: skip


def right_turns() -> None:
    """Item 6: mean roll of left and right turns."""
    print(f"left: mean roll {mean_roll('left', mend=False):+.3f} degrees")
    for mend in (False, True):
        print(f"right, mended {mend}: mean roll {mean_roll('right', mend=mend):+.3f} degrees")


def mean_roll(direction: Direction, *, mend: bool) -> float:
    """Return the mean roll of a turn with s = 1.2 after half a second [degrees]."""
    path = walk(gait(1.2, 45.0, 1.0, direction), 4.0, direction=direction, mend_roll=mend)
    return float(np.degrees(path.orientation[500:, 0].mean()))


def switches() -> None:
    """Ten seconds of Table 5-2's gait as listed, and with one switch each."""
    mended = [walk(gait(1.25, 45.0, 1.0), 4.0, heading=np.radians(h), mend_heading=True).length
              for h in (0, 90, 180, 270)]  # fmt: skip
    print("metres in 4 s with the heading mended:", " ".join(f"{x:.3f}" for x in mended))
    for switch in ("as listed", "static_loads", "contact_slip_angle"):
        options: dict[str, Any] = {} if switch == "as listed" else {switch: True}
        path = walk(gait(1.25, 45.0, 1.0), 10.0, **options)
        print(f"yaw after 10 s, {switch}: {np.degrees(path.yaw[-1]):.1f} degrees, largest share of "
              f"the weight carried {path.normal_force.sum(axis=1).max() / WEIGHT:.2f}")  # fmt: skip


def standing() -> None:
    """Item 7: how far a robot goes that stands on legs turning back by a hair."""
    t = np.arange(0.0, 1.001, 0.02)
    legs = SampledReference(t, gait(1.2, 45.0, 1.0).angles(0.5)[0] - 1e-4 * t[:, None])
    for mend in (False, True):
        path = walk_thesis(ROBOT, legs, duration=1.0, options=ThesisOptions(mend_slip=mend))
        print(f"standing for a second, mended {mend}: "
              f"{np.linalg.norm(path.position[-1, :2]):.4f} m")  # fmt: skip


def automata() -> None:
    """Item 8: the listing's contact rule and Table 3-1's, with leg 5 some degrees behind."""
    for late_deg in (0.0, 3.0, 5.0):
        offset = np.zeros(6)
        offset[4] = -np.radians(late_deg)
        found = [
            radius(walk_thesis(Robot(leg_offset=offset), gait(1.1), duration=10.0,
                               options=ThesisOptions(automaton=rule)))
            for rule in ("listing", "table")
        ]  # fmt: skip
        print(f"leg 5 {late_deg:g} degrees behind: listing {found[0]:.3f}, "
              f"Table 3-1 {found[1]:.3f} m")  # fmt: skip


def curvature() -> None:
    """Item 9: E against load."""
    loads = np.array([0.1, 0.5, 2.13, 6.63, 12.75])
    values = curvature_from_peak(34.34, 1.564, 0.0066 * loads)
    print("E at", ", ".join(f"{n:g} N: {e:.3g}" for n, e in zip(loads, values, strict=True)))


def tetrapod() -> None:
    """Item 11: contact states of a cycle, Eq. (3-33), and with the test at every step."""
    reference = tetrapod_reference(np.radians(45.0), np.radians(135.0), cycle_time=3.0)
    t = np.arange(9001, dtype=float) * 0.001
    for detection in DETECTIONS:
        found = detect_contacts(ROBOT, reference.angles(t), detection=detection)
        sequence = contact_states(t, found.contact)
        print(f"{detection}:", contact_cycle(sequence, reference.period, tolerance=0.01))
        roll, pitch = (np.degrees(each[t >= 3.0]) for each in (found.roll, found.pitch))
        print(f"  roll {roll.min():.1f} to {roll.max():.1f}, "
              f"pitch {pitch.min():.1f} to {pitch.max():.1f} degrees")  # fmt: skip


if __name__ == "__main__":
    for show in (
        chatter,
        radii,
        compass,
        right_turns,
        switches,
        standing,
        automata,
        curvature,
        tetrapod,
    ):
        show()
