# SPDX-License-Identifier: MIT
"""A signal stops a command wherever it is: one line, exit code 130."""

import signal
import subprocess
import sys
import time

import pytest

PROGRAM = """
import signal, sys, time
from zebro_lab.terminal import stopping
stopping.PATIENCE = 0.3
{before}
with stopping.stoppable():
    {body}
"""


def ended(body: str, before: str = "") -> subprocess.CompletedProcess[str]:
    program = PROGRAM.format(body=body, before=before)
    return subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=30
    )


RAISE = {name: f"signal.raise_signal(signal.{name})" for name in ("SIGINT", "SIGTERM")}


@pytest.mark.parametrize(("name", "said"), [("SIGINT", "Ctrl-C"), ("SIGTERM", "SIGTERM")])
def test_a_signal_is_one_line_and_130_and_what_is_open_is_closed(name, said):
    process = ended(f"""
    try:
        {RAISE[name]}
    finally:
        print("closed")""")
    assert (process.returncode, process.stdout) == (130, "closed\n")
    assert process.stderr == f"stopped by {said}; nothing was left half-written\n"


@pytest.mark.parametrize(
    "swallow",
    ["try: {0}\n    except BaseException: pass", "[{0} for _ in [0] if 0 or not time.sleep(0)]"],
)
def test_a_process_that_catches_the_exception_ends_a_little_later(swallow):
    process = ended(swallow.format(RAISE["SIGTERM"]) + "\n    time.sleep(20)")
    assert process.returncode == 130
    assert process.stderr == "stopped by SIGTERM; nothing was left half-written\n"


@pytest.mark.parametrize("asked", [False, True])
def test_finalisers_of_what_a_stop_left_half_made_say_nothing(asked):
    before = "class Half:\n    def __del__(self): self.never_made"
    process = ended("half = Half()\n    " + (RAISE["SIGTERM"] if asked else "del half"), before)
    assert ("AttributeError" in process.stderr) == (not asked)


def test_a_process_that_catches_the_exception_is_stopped_again_and_removes_its_drafts():
    process = ended(f"""
    try: {RAISE["SIGTERM"]}
    except BaseException: pass
    try:
        time.sleep(20)
    finally:
        print("closed")""")
    assert (process.returncode, process.stdout) == (130, "closed\n")
    assert process.stderr == "stopped by SIGTERM; nothing was left half-written\n"


def test_a_process_that_catches_it_twice_is_ended():
    process = ended(f"""
    for _ in range(2):
        try:
            {RAISE["SIGTERM"]} if not _ else time.sleep(20)
        except BaseException: pass
    time.sleep(20)""")
    assert process.returncode == 130
    assert process.stderr == "stopped by SIGTERM; nothing was left half-written\n"


def test_a_finaliser_that_swallows_the_exception_is_quiet_and_does_not_keep_it():
    body = f"""
    class Closing:
        def __del__(self):
            {RAISE["SIGTERM"]}
    Closing()
    time.sleep(20)
    print("went on")"""
    process = ended(body)
    assert (process.returncode, process.stdout) == (130, "")
    assert process.stderr == "stopped by SIGTERM; nothing was left half-written\n"


def test_other_errors_of_finalisers_are_still_reported():
    process = ended("type('A', (), {'__del__': lambda self: 1 / 0})()")
    assert process.returncode == 0
    assert "ZeroDivisionError" in process.stderr


def test_an_ignored_signal_stays_ignored_and_sigterm_is_heard():
    process = ended(
        f"{RAISE['SIGINT']}; print('here'); {RAISE['SIGTERM']}",
        before="signal.signal(signal.SIGINT, signal.SIG_IGN)",
    )
    assert (process.returncode, process.stdout) == (130, "here\n")


def test_a_stopped_command_can_be_ended_by_a_second_signal(tmp_path):
    body = f"""
    try:
        {RAISE["SIGTERM"]}
    finally:
        print("closing", flush=True)
        time.sleep(60)"""
    program = PROGRAM.format(body=body, before="").replace("0.3", "60")
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE) as process:
        assert process.stdout is not None
        process.stdout.readline()
        began = time.monotonic()
        process.send_signal(signal.SIGTERM)
        assert process.wait(20) == 130
        assert time.monotonic() - began < 15


def test_matplotlib_is_imported_whole_when_a_signal_comes():
    body = """
    import builtins, sys
    real = builtins.__import__
    def importing(name, *rest):
        if name.startswith("matplotlib") and not asked:
            asked.append(name)
            signal.raise_signal(signal.SIGTERM)
        return real(name, *rest)
    asked, builtins.__import__ = [], importing
    try:
        import zebro_lab.plots
    finally:
        print("matplotlib.figure" in sys.modules)"""
    process = ended(body)
    assert (process.returncode, process.stdout) == (130, "True\n")
