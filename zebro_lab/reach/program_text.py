# SPDX-License-Identifier: MIT
"""Write a manoeuvre as a walking program (`program.toml`)."""

from collections.abc import Sequence

import numpy as np

from model.routes.manoeuvre import Part, Stepping
from zebro_lab.reach.request import SteppingRequest

_DIGITS = 6  # decimals of steering and of degrees; a micrometre in a metre


def program_text(
    parts: Sequence[Part], stepping: Stepping, request: SteppingRequest, *, about: Sequence[str]
) -> str:
    """Return the text of a program with a segment for each part.

    Args:
        parts: The parts.
        stepping: Gait, times and angles that they have in common.
        request: The same as asked for: names and times are written as they were given.
        about: Lines of a comment at its beginning.
    """
    import tomlkit  # takes 0.1 s

    document = tomlkit.document()
    for line in about:
        document.add(tomlkit.comment(line))
    segments = tomlkit.aot()
    for part in parts:
        segments.append(tomlkit.item(_segment(part, stepping, request)))
    document.add("segment", segments)
    return tomlkit.dumps(document)


def _segment(part: Part, stepping: Stepping, request: SteppingRequest) -> dict[str, object]:
    import tomlkit

    down, up = stepping.stance(part.share)
    segment: dict[str, object] = {"gait": request.gait, **_times(request)}
    if part.bend != 0:
        segment |= {"steering": round(part.steering, _DIGITS), "direction": part.direction}
    segment["touchdown_deg"] = round(float(np.degrees(down)), _DIGITS)
    if up is not None:
        segment["liftoff_deg"] = round(float(np.degrees(up)), _DIGITS)
    until = tomlkit.inline_table()
    until["strides"] = part.strides
    return {**segment, "until": until}


def _times(request: SteppingRequest) -> dict[str, float]:
    times = {"cycle": request.cycle, "ground_time": request.tau_ground,
             "flight_time": request.tau_flight}  # fmt: skip
    given = {name: value for name, value in times.items() if value is not None}
    return {**given, **({"double_stance": request.tau_double} if request.tau_double else {})}
