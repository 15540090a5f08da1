# SPDX-License-Identifier: MIT
"""Open the rig that a command line names, real or simulated, for an experiment."""

import hashlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from rig.backends import board_devices, open_rig
from rig.clock import SYSTEM_CLOCK, Clock, ManualClock
from rig.experiment.acquire import PERIOD
from rig.experiment.bench import Bench, make_bench
from rig.experiment.control import Control
from rig.experiment.load import HandShaft, LoadSetter, SimulatedOperator
from rig.experiment.plan import LoadSetting
from rig.links.byte_link import MemoryLink
from rig.openers import SIMULATED, resolve
from rig.slip_rig.imperfections import draw_imperfections, with_load_noise
from rig.slip_rig.profile import RigProfile, load_rig_profile
from rig.slip_rig.simulated import RigDynamics, SimulatedRig
from rig.slip_rig.simulated_board import SimulatedBoard
from rig.slip_rig.sweep import SweepPlan
from rig.twins import simulated_rig_devices
from zebro_lab.files.errors import SettingsError
from zebro_lab.recording.devices import profile_text
from zebro_lab.runs.manifest import RIG

TWIN_PROFILE: Final = "rig-board-serial"
FAST_PERIOD: Final = 0.02
"""Polling period of a twin with simulated time: a tenth of its watchdog [s]."""


@dataclass(frozen=True)
class OpenedRig:
    """A rig, real or simulated, whose bench is not yet entered.

    Attributes:
        bench: Bench of the rig's devices, a context manager.
        profiles: Name and text of the rig's profile, by its role in a run folder.
        clock: Clock of host time.
        period: Polling period [s].
        twin: The simulated rig; None for a real one.
        fast: Whether the rig runs in simulated time instead of real time.
        truth: True parameters of the simulated rig, for the manifest; empty for a real one.
    """

    bench: Bench
    profiles: Mapping[str, tuple[str, str]]
    clock: Clock = SYSTEM_CLOCK
    period: float = PERIOD
    twin: SimulatedRig | None = None
    fast: bool = False
    truth: Mapping[str, Any] = field(default_factory=dict)

    @property
    def constants(self) -> dict[str, float]:
        """Radii of the discs [m], as `radius_leg` and `radius_ground`."""
        profile = self.bench.profile
        return {"radius_leg": profile.radius_leg, "radius_ground": profile.radius_ground}

    def load_setter(self, setting: LoadSetting, control: Control) -> LoadSetter:
        """Return the setter of the normal force: the operator, real or simulated.

        Args:
            setting: Tolerance of a force that a real operator sets by hand.
            control: Mailbox that receives the operator's confirmation.
        """
        if self.twin is not None:
            return SimulatedOperator(self.twin)
        return HandShaft(control, tolerance=setting.tolerance)


@contextmanager
def opened_rig(
    address: str,
    *,
    seed: int = 0,
    run: str = "",
    fast: bool = False,
) -> Iterator[OpenedRig]:
    """Open the rig that an address names; a twin is simulated while the context lasts.

    Args:
        address: `PROFILE@PORT`, `PROFILE@sim` or `sim`.
        seed: Seed of a twin, from which the errors of its load cell, discs and sensors are drawn:
            each seed is another rig, and an equal seed the same rig.
        run: Name of this use of a twin; noise, slip wander, the zero at power-on and the first
            angle of the ground disc are drawn anew for another name.
        fast: Run a twin in simulated time, as fast as possible; only a profile with a board.

    Yields:
        The rig; its bench is not yet entered.

    Raises:
        RigError: The address or the profile is invalid, or a port cannot be opened.
        SettingsError: `fast` is set for a real rig, or for a profile without a board.
    """
    name, port = resolve(address, default=TWIN_PROFILE)
    profile = load_rig_profile(name)
    profiles = {RIG: (profile.name, profile_text(name))}
    if port != SIMULATED:
        if fast:
            raise SettingsError("works only with a simulated rig; omit it", key="--fast")
        yield OpenedRig(make_bench(open_rig(address)), profiles)
        return
    rng = _run_rng(seed, run)
    rig = SimulatedRig(
        plan=SweepPlan(radius_leg=profile.radius_leg, radius_ground=profile.radius_ground),
        imperfections=with_load_noise(draw_imperfections(np.random.default_rng([seed, 1]))),
        dynamics=RigDynamics(ripple=0.005), rng=rng,
    )  # fmt: skip
    rig.command("leg", 0.0)  # it is commanded from the first: it sweeps nothing by itself
    truth = {"rig": rig.description()}
    if fast:
        clock = ManualClock()
        yield OpenedRig(
            _fast_bench(profile, rig, rng, clock), profiles, clock, FAST_PERIOD, rig, True, truth
        )
        return
    with simulated_rig_devices(profile, rig, rng=rng) as devices:
        yield OpenedRig(make_bench(devices), profiles, twin=rig, truth=truth)


def _run_rng(seed: int, run: str) -> np.random.Generator:
    """Return the random generator of what changes from run to run of one simulated rig."""
    if not run:
        return np.random.default_rng(seed)
    return np.random.default_rng([seed, int.from_bytes(hashlib.sha256(run.encode()).digest())])


def _fast_bench(
    profile: RigProfile, rig: SimulatedRig, rng: np.random.Generator, clock: ManualClock
) -> Bench:
    """Return the bench of a simulated board whose time is that of `clock`, read from memory.

    Raises:
        SettingsError: The profile has no board.
    """
    if profile.board is None:
        raise SettingsError(
            f"the simulated '{profile.name}' runs in real time only; use {TWIN_PROFILE}@sim",
            key="--fast",
        )
    twin = SimulatedBoard(rig, profile=profile.board, rng=rng)
    link = MemoryLink(twin, clock=clock)
    return make_bench(board_devices(profile, profile.board, link, clock=clock))
