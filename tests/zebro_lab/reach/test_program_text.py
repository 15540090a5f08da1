# SPDX-License-Identifier: MIT
"""A manoeuvre written as a program is read back as the same cycles."""

import numpy as np
import pytest

from model.routes.manoeuvre import Part
from zebro_lab.reach.program_text import program_text
from zebro_lab.reach.request import SteppingRequest
from zebro_lab.reach.stage import stepping_of
from zebro_lab.walk.program_file import read_program

PARTS = (Part(-1.0, 0.31, 1), Part(0.0, 1.0, 7), Part(0.2, 0.9, 2))
REQUESTS = {
    "tripod": SteppingRequest(),
    "slow": SteppingRequest(cycle=4.0),
    "times": SteppingRequest(tau_ground=1.2, tau_flight=0.8, tau_double=0.1),
    "tetrapod": SteppingRequest(gait="tetrapod", liftoff_deg=130.0, touchdown_deg=45.0),
    "groups": SteppingRequest(gait="{1,4} < {2,5} < {3,6}", cycle=3.0),
}


@pytest.mark.parametrize("name", REQUESTS)
@pytest.mark.parametrize("arc_deg", [180, 200])
def test_the_program_has_the_cycles_of_the_parts(name, arc_deg, tmp_path):
    arc = float(np.radians(arc_deg))
    stepping = stepping_of(REQUESTS[name], arc)
    file = tmp_path / "program.toml"
    file.write_text(program_text(PARTS, stepping, REQUESTS[name], about=["a comment"]))
    program = read_program(file, leg_arc=arc)
    for part, segment in zip(PARTS, program.segments, strict=True):
        asked, found = stepping.cycle(part), segment.gait
        np.testing.assert_allclose(found.touchdown, asked.touchdown, atol=1e-6)
        np.testing.assert_allclose(found.liftoff, asked.liftoff, atol=1e-6)
        np.testing.assert_array_equal(found.sense, asked.sense)
        np.testing.assert_allclose(
            found.system.steady_state.touchdown, asked.system.steady_state.touchdown
        )
        assert segment.until.strides == part.strides


def test_a_comment_says_what_the_program_is():
    text = program_text(PARTS, stepping_of(SteppingRequest(), np.pi), SteppingRequest(),
                        about=["curve to 1, 0 m", "zebro-lab walk curve.toml"])  # fmt: skip
    assert text.splitlines()[:2] == ["# curve to 1, 0 m", "# zebro-lab walk curve.toml"]
