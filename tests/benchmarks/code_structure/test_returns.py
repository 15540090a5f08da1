# SPDX-License-Identifier: MIT
"""The order in which a made-up stage enters rooms."""

import pytest

from benchmarks.code_structure.measures import Checkout
from benchmarks.code_structure.returns import Rooms, calls_of, count_returns

STAGE = """
from model.law import Law, fit
from zebro_lab.files.names import read
from zebro_lab.runs import load
from zebro_lab.walk.steps import step
from functools import partial


def predict(request):
    if request:
        data = _prepare(request)
    law = fit(load(read(data)))
    Law(law)
    law.draw()
    partial(step, law)
    return Law.of(law)


def _prepare(request):
    return load(request)
"""
FILES = {
    "zebro_lab/walk/predict_stage.py": STAGE,
    "zebro_lab/walk/steps.py": "from model.law import fit\n\ndef step(x):\n    return fit(x)\n",
    "zebro_lab/runs/__init__.py": "from zebro_lab.runs.folder import load\n",
    "zebro_lab/runs/folder.py": "def load(x):\n    return x\n",
    "zebro_lab/files/names.py": "def read(x):\n    return x\n",
    "model/law.py": "class Law:\n    def of(x):\n        return x\n\ndef fit(x):\n    return x\n",
}


@pytest.fixture
def checkout(tmp_path):
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    return Checkout.read(tmp_path)


def called(checkout, **how):
    return [
        (call.module, call.function)
        for call in calls_of(checkout, "predict", rooms=Rooms(checkout), **how)
    ]


def test_arguments_are_called_first_and_what_is_handed_on_has_its_own_module(checkout):
    assert called(checkout) == [
        ("zebro_lab.runs.folder", "load"),
        ("zebro_lab.files.names", "read"),
        ("zebro_lab.runs.folder", "load"),
        ("model.law", "fit"),
        ("zebro_lab.walk.steps", "step"),
        ("model.law", "Law.of"),
    ]


def test_functions_of_the_own_room_are_followed_where_that_is_asked(checkout):
    assert called(checkout, whole_room=True)[-2:] == [("model.law", "fit"), ("model.law", "Law.of")]


def test_a_room_that_is_entered_again_is_a_return():
    assert count_returns(["runs", "model"]) == 0
    assert count_returns(["runs", "model", "runs", "model", "rig"]) == 2
