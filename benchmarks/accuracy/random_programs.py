# SPDX-License-Identifier: MIT
"""Random walking programs of gaits, curves, turns on the spot, stands and walks backwards."""

from dataclasses import dataclass

import numpy as np

GAITS = (
    "tripod",
    "tetrapod",
    "{1,4,5} < {2,3,6}",
    "{1,4} < {2,5} < {3,6}",
    "{1,6} < {2,5} < {3,4}",
)
FRICTIONS = (0.2, 0.38, 0.7)


@dataclass(frozen=True)
class Segment:
    """A segment of a program.

    Attributes:
        text: Its keys but the steering, in TOML.
        steering: Stance angle of inner over outer legs; 1 is straight [-].
    """

    text: str
    steering: float = 1.0

    def toml(self, share: float = 1.0) -> str:
        """Write the segment; a curve or a turn with a share of its steering term."""
        steered = 1 - share * (1 - self.steering)
        steering = "" if self.steering == 1 else f"\nsteering = {steered:.4f}"
        return f"[[segment]]\n{self.text}{steering}\n"


@dataclass(frozen=True)
class Program:
    """A random program.

    Attributes:
        number: Its number.
        segments: Its segments.
        friction: Friction coefficient of the floor [-].
    """

    number: int
    segments: tuple[Segment, ...]
    friction: float

    def toml(self, share: float = 1.0) -> str:
        """Write program.toml; curves and turns with a share of their steering term."""
        return "\n".join(segment.toml(share) for segment in self.segments)


def random_program(number: int, seed: int) -> Program:
    """Draw a program: a turn on the spot, a curve, a stand and two more segments, in any order."""
    rng = np.random.default_rng([seed, number])
    kinds = ["spot", "curve", "stand", *rng.choice(["straight", "curve", "backwards", "spot"], 2)]
    rng.shuffle(kinds)
    segments = tuple(_segment(str(kind), rng) for kind in kinds)
    return Program(number, segments, float(rng.choice(FRICTIONS)))


def _segment(kind: str, rng: np.random.Generator) -> Segment:
    """Draw a segment of a kind."""
    if kind == "stand":
        return Segment(f"stand = {rng.uniform(0.3, 1.5):.2f}")
    gait = str(rng.choice(GAITS))
    cycle = rng.uniform(1.2, 2.4) * (1.0 if gait in GAITS[::2][:2] else 1.4)
    keys = [f'gait = "{gait}"', f"cycle = {cycle:.3f}"]
    keys.append(f'direction = "{rng.choice(["left", "right"])}"')
    if kind == "spot":
        keys.append(f"until = {{ heading_deg = {rng.uniform(40.0, 110.0):.1f} }}")
        return Segment("\n".join(keys), -1.0)
    if kind == "backwards":
        keys.append("reverse = true")
    keys.append(f"until = {{ strides = {rng.integers(2, 4)} }}")
    steering = 1.0 if kind == "straight" else rng.uniform(0.3, 0.9)
    return Segment("\n".join(keys), float(steering))
