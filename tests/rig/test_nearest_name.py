# SPDX-License-Identifier: MIT
"""Advice on unknown names."""

from rig.nearest_name import nearest


def test_the_nearest_name_is_found_whatever_its_case():
    assert nearest("FZ", ["t", "Fz"]) == "did you mean 'Fz'? known: 't', 'Fz'"


def test_a_name_like_no_other_gets_the_list_alone():
    assert nearest("colour", ["t", "w"]) == "known: 't', 'w'"


def test_a_long_list_is_cut_and_counted():
    known = [f"column_{number:03d}" for number in range(40)]
    advice = nearest("zzz", known)
    assert "'column_014'" in advice
    assert "'column_015'" not in advice
    assert advice.endswith("and 25 more")
