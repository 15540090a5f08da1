# SPDX-License-Identifier: MIT
"""A misspelt command or option is offered in its right spelling; what is no misspelling is not."""

import pytest

TYPOS = {
    "walkk": "walk", "predcit": "predict", "validat": "validate", "recrod": "record",
    "cmpare": "compare", "reprot": "report", "calibrat": "calibrate", "zebra": "zebro",
    "rig plann": "plan", "camera kitt": "kit", "walk --speedup": None,
    "walk --gaitt tripod": "--gait",
    "predict x --slipp thesis": "--slip", "record --zebor sim": "--zebro",
    "plot d --form png": "--format", "track x --camra c": "--camera", "export d --ou q": "--out",
    "xyzzy": None, "analyse": None, "walk --colour red": None, "rig fly": None,
    "calibrate-slip x --blocklength 3": "--block-length", "calibrate-slip x --chains 4": None,
}  # fmt: skip


@pytest.mark.parametrize("typed", TYPOS)
def test_the_right_spelling_is_offered_alone_or_none(run_command, typed):
    ended = run_command(*typed.split())
    assert ended.code == 2
    line = ended.err.splitlines()[-1]
    meant = TYPOS[typed]
    assert "No such " in line
    assert line.partition(" Did you mean ")[2] == ("" if meant is None else f"'{meant}'?")
    assert "Possible options" not in ended.err
