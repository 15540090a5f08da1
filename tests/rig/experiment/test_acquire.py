# SPDX-License-Identifier: MIT
"""The discs are proved to stand before a person is asked to touch the rig."""

import pytest

from rig.errors import RigError
from rig.experiment.load import HandShaft
from rig.experiment.sink import ExperimentWatcher


def keep_turning(twin, monkeypatch, slowest):
    """Let the leg disc turn with at least some speed, whatever is commanded [rad/s]."""
    command = twin.rig.command
    monkeypatch.setattr(
        twin.rig,
        "command",
        lambda disc, omega: command(disc, max(omega, slowest) if disc == "leg" else omega),
    )


def test_empty_reads_are_not_rest(lab, monkeypatch):
    twin = lab["twin"]()
    acquire = twin.acquisition(lab["plan"](limits={"silence": 0.9}))
    with twin.bench:
        twin.turn(acquire)
        monkeypatch.setattr(twin.board, "_frames", lambda due: [])
        with pytest.raises(RigError, match="leg disc did not come to rest"):
            acquire.come_to_rest(0.3)
        assert twin.at_rest()  # de-energised


@pytest.mark.parametrize("slowest", [0.3, 3.0])
def test_a_disc_that_creeps_within_the_tracking_limit_is_not_at_rest(lab, monkeypatch, slowest):
    twin = lab["twin"]()
    keep_turning(twin, monkeypatch, slowest)
    acquire = twin.acquisition(lab["plan"]())
    with twin.bench:
        twin.turn(acquire)
        with pytest.raises(RigError, match=rf"leg disc .* {slowest:.1g}.* rad/s; .* 0\.1 rad/s"):
            acquire.come_to_rest(1.0)
        assert not acquire.energised


def test_nobody_is_asked_to_turn_the_shaft_while_a_disc_turns(lab, monkeypatch):
    twin = lab["twin"]()
    keep_turning(twin, monkeypatch, 3.0)

    class Bystander(ExperimentWatcher):
        def doing(self, what, *, done, of, left):
            pass

        def prompt(self, text, *, normal):
            raise AssertionError(f"asked to {text!r} while a disc turns")

    with pytest.raises(RigError, match="leg disc did not come to rest"):
        twin.run(load=HandShaft(twin.control, tolerance=0.3), watcher=Bystander())
    assert "prompt" not in [kind for kind, _ in twin.sink.events]
    assert twin.sink.events[-1][1].startswith("NotAtRest")
