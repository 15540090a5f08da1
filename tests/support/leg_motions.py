# SPDX-License-Identifier: MIT
"""Leg angles of walks of every kind, in which nothing is wrong."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from model.gait import (
    TETRAPOD,
    TRIPOD,
    CyclicReference,
    scheduled_reference,
    suriana_reference,
    tetrapod_reference,
    tripod_angles,
    tripod_reference,
    turning_system,
)

T = np.arange(0.0, 12.0, 0.02)


def tripod(steering: float = 1.0) -> CyclicReference:
    return tripod_reference(tripod_angles(np.radians(50), steering), 2.0, direction="right")


def gaits() -> Iterator[tuple[str, np.ndarray]]:
    """Yield name and unwrapped angles, shape (n, 6) [rad], of walks with this package's gaits."""
    straight = tripod().angles(T)
    for steering in np.arange(1.0, 3.96, 0.1):
        yield f"tripod, steering {steering:.1f}", tripod(float(steering)).angles(T)
    yield "tetrapod", tetrapod_reference(np.radians(45), np.radians(135), cycle_time=3.0).angles(T)
    times = {"ground_time": 0.8, "flight_time": 0.8}
    td, lo = np.radians(35), np.radians(130)
    for turn in (0.0, 0.3, 0.6):
        yield f"suriana {turn}", suriana_reference(td, lo, turn_time=turn, **times).angles(T)
        for name, gait in (("tripod", TRIPOD), ("tetrapod", TETRAPOD)):
            inner = (1, 3, 5)
            system = turning_system(gait, inner=inner, turn_time=turn, **times)
            gait = scheduled_reference(system, td, liftoff=lo, inner=inner if turn else ())
            yield f"max-plus {name} {turn}", gait.angles(T)
    for duty in (0.5, 0.6, 0.75, 0.9):
        for lag in (1 / 6, 0.2, 0.25, 1 / 3, 0.4, 0.5, -1 / 6, -1 / 3):
            yield f"wave, duty {duty}, lag {lag:.2f}", wave(duty, lag)
    yield "wave, legs of a row together", wave(0.6, 1 / 3, sides=0.0)
    yield "all legs together", wave(0.6, 0.0, sides=0.0)
    yield "waiting before lift-off", replace(tripod(), pause=0.1).angles(T)
    yield "backwards", tripod().angles(T[-1] - T)
    spot = straight.copy()
    spot[:, ::2] = tripod().angles(-T)[:, ::2]
    yield "on the spot", spot
    yield "a walk, then on the spot", np.concatenate([straight, straight[-1] + spot - spot[0]])
    yield "slow start", tripod().angles(np.where(T < 6, T**2 / 12, T - 3))
    yield "stand, walk, stand", tripod().angles(np.clip(T - 3, 0, 5))
    yield "there and back", tripod().angles(np.where(T < 6, T, 12 - T))
    rng = np.random.default_rng(1)
    yield "standing", np.tile(straight[10], (len(T), 1)) + rng.normal(0, 0.01, (len(T), 6))
    yield "noisy", straight + rng.normal(0, 0.05, straight.shape)
    for counts in (36, 100):
        step = 2 * np.pi / counts
        yield f"{counts} counts a turn", step * np.round(straight / step)
    yield "8 Hz", tripod().angles(np.arange(0.0, 12.0, 0.125))
    yield "leg offsets of 8 deg", straight + np.radians(rng.normal(0, 8, 6))
    yield "one cycle", tripod().angles(T[T < 2.5])


def wave(duty: float, lag: float, sides: float = 0.5) -> np.ndarray:
    """Return the angles of a wave gait: lag from row to row and side to side [cycles]."""
    phase = np.add.outer(lag * np.arange(3), sides * np.arange(2)).ravel()
    cycles = T[:, None] / 3.0 + phase
    turns, share = np.floor(cycles), cycles % 1
    ground, flight = np.radians([50.0, 120.0]), np.radians([120.0, 410.0])
    on = ground[0] + share / duty * np.ptp(ground)
    off = flight[0] + (share - duty) / (1 - duty) * np.ptp(flight)
    return np.where(share < duty, on, off) + 2 * np.pi * turns


def virtual_world(shared: Path) -> Iterator[tuple[str, np.ndarray]]:
    """Yield name and angles of each walk of the reference data."""
    for file in sorted((shared / "virtual-world" / "walks").glob("*.csv.gz")):
        yield file.name, pd.read_csv(file)[[f"th{leg}" for leg in range(1, 7)]].to_numpy()
