# SPDX-License-Identifier: MIT
"""`doctor` fails only where something needed is broken."""

from zebro_lab.recording import doctor


def test_the_command_fails_only_where_something_needed_is_broken(
    monkeypatch, tmp_path, run_command
):
    ended = run_command("doctor", "--data", tmp_path)
    assert (ended.code, "everything that zebro-lab needs is there" in ended.out) == (0, True)
    broken = doctor.Finding("BROKEN", "disk", "full")
    monkeypatch.setattr(doctor, "check_disk", lambda _: broken)
    ended = run_command("doctor", "--data", tmp_path)
    assert (ended.code, "1 BROKEN" in ended.out) == (1, True)
