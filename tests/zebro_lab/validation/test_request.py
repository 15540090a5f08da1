# SPDX-License-Identifier: MIT
"""A validation is written into the run that it is of, and elsewhere for several."""

from pathlib import Path

from zebro_lab.validation.request import ValidateRequest

RUN, OTHER = Path("a"), Path("b")


def test_the_validation_of_one_run_lies_in_it():
    assert ValidateRequest((RUN,)).folder == RUN / "validation"
    assert ValidateRequest((RUN, OTHER)).folder == Path("validation")
    assert ValidateRequest((RUN,), (OTHER,), (OTHER,)).folder == Path("validation")
    assert ValidateRequest((RUN,), out=OTHER).folder == OTHER
