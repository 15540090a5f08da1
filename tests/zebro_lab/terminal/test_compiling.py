# SPDX-License-Identifier: MIT
"""Compiling is announced once, only where it takes a moment, and only where it happens."""

import sys
import time

import numba
import pytest

from zebro_lab.terminal import compiling as module
from zebro_lab.terminal.compiling import ANNOUNCEMENT, announcing_compilation


@pytest.fixture
def at_once(monkeypatch):
    monkeypatch.setattr(module, "AFTER_IN_PIPE", 0.0)


def compile_anew(summand=1.0):
    @numba.njit
    def total(x):
        result = 0.0
        for value in x:
            result += value**2 + summand
        return result

    return total


def test_a_compilation_is_announced_once(at_once, capsys):
    x = (1.0, 2.0, 3.0)
    with announcing_compilation():
        compile_anew()(x)
        compile_anew(2.0)(x)
        time.sleep(0.05)
    assert capsys.readouterr().err.splitlines() == [ANNOUNCEMENT]


def test_compiled_loops_are_not_announced(at_once, capsys):
    loop = compile_anew()
    loop((1.0,))
    with announcing_compilation():
        loop((1.0,))
        time.sleep(0.05)
    compile_anew(3.0)((1.0,))  # nobody listens any more
    time.sleep(0.05)
    assert capsys.readouterr().err == ""


def test_a_loop_that_is_compiled_in_a_moment_is_not_announced(monkeypatch, capsys):
    monkeypatch.setattr(module, "AFTER_IN_PIPE", 30.0)
    with announcing_compilation():
        compile_anew()((1.0, 2.0))
    assert capsys.readouterr().err == ""


def test_numba_is_not_imported_for_it(monkeypatch):
    monkeypatch.delitem(sys.modules, "numba")
    with announcing_compilation():
        assert "numba" not in sys.modules


def test_nobody_is_told_where_a_shell_has_closed_stderr(at_once, monkeypatch):
    monkeypatch.setattr(sys, "stderr", None)
    with announcing_compilation():
        compile_anew()((1.0, 2.0))
        time.sleep(0.05)
