# SPDX-License-Identifier: MIT
"""What a person said comes back as said, in order, and nothing of it is lost by saying more."""

from dataclasses import replace

import pytest

from tracking.body import TopPlate
from tracking.corrections import Delete, Flip, Move
from tracking.photos.scene import MarkedTop
from zebro_lab.files.errors import SettingsError
from zebro_lab.track.annotations import Annotations, read_annotations, render_annotations

CORNERS = ((1.5, 2.0), (3.0, 2.5), (3.0, 8.0), (1.25, 8.0))
SAID = Annotations(
    (MarkedTop("p 1.jpg", CORNERS, TopPlate(0.2, 0.15, 0.04, margin=0.02)),),
    {'p "2".jpg': {"door": (10.0, 20.5)}},
    (Move("p3.jpg", 0.5, -0.25, 1.0), Flip("p4.jpg"), Delete("p5.jpg")),
)


def test_annotations_come_back(tmp_path):
    file = tmp_path / "annotations.toml"
    file.write_text(render_annotations(SAID))
    assert read_annotations(file) == SAID


def test_later_words_are_added_and_none_is_lost():
    later = Annotations(
        (), {'p "2".jpg': {"pipe": (1.0, 2.0)}, "p9.jpg": {"door": (3.0, 4.0)}}, (Flip("p4.jpg"),)
    )
    both = SAID.merged(later)
    assert both.templates == SAID.templates
    assert both.clicks['p "2".jpg'] == {"door": (10.0, 20.5), "pipe": (1.0, 2.0)}
    assert both.corrections == (*SAID.corrections, Flip("p4.jpg"))


def test_tops_of_several_photographs_are_kept_and_one_of_the_same_replaced(tmp_path):
    (first,) = SAID.templates
    second, better = replace(first, photo="p 2.jpg"), replace(first, corner_sd_px=0.3)
    both = SAID.merged(Annotations((second,))).merged(Annotations((better,)))
    assert both.templates == (better, second)
    file = tmp_path / "annotations.toml"
    file.write_text(render_annotations(both))
    assert file.read_text().count("[[template]]") == 2
    assert read_annotations(file) == both


FAULTS = {
    "twice the same": (
        2 * '[[template]]\nphoto = "a"\ncorners_px = [[1, 2], [3, 4], [5, 6], [7, 8]]\n'
        "length = 1\nwidth = 1\nheight = 1\n", "'a' is annotated twice",
    ),
    "unknown kind": ('[[correction]]\nkind = "turn"\nphoto = "a"', r"correction\[1\].*'turn'"),
    "unknown key": ('[[correction]]\nkind = "flip"\nfoto = "a"', "has no 'foto'; known: photo"),
    "three corners": (
        '[template]\nphoto = "a"\ncorners_px = [[1, 2], [3, 4], [5, 6]]', "expected four pixels",
    ),
    "half a pixel": (
        '[template]\nphoto = "a"\ncorners_px = [[1, 2], [3, 4], [5, 6], [7]]',
        "expected a list of 2",
    ),
    "no plate": (
        '[template]\nphoto = "a"\ncorners_px = [[1, 2], [3, 4], [5, 6], [7, 8]]\nlength = 0\n'
        "width = 1\nheight = 1", "above 0 m",
    ),
    "edges in quotes": (
        '[template]\nphoto = "a"\ncorners_px = [[1, 2], [3, 4], [5, 6], [7, 8]]\nlength = 1\n'
        'width = 1\nheight = 1\nedges = "false"', "edges.*'false'; expected true or false",
    ),
    "unknown table": ("[corrections]", "did you mean 'correction'"),
}  # fmt: skip


@pytest.mark.parametrize(("text", "message"), FAULTS.values(), ids=FAULTS)
def test_a_fault_is_named_with_its_place(tmp_path, text, message):
    file = tmp_path / "annotations.toml"
    file.write_text(text)
    with pytest.raises(SettingsError, match=message):
        read_annotations(file)
