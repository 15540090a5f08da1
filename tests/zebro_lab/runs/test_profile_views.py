# SPDX-License-Identifier: MIT
"""A stored profile tells which streams its device has and how they are shown."""

import pytest

from zebro_lab.recording.devices import profile_text
from zebro_lab.runs.profile_views import profile_views, stored_views

STREAMS = {
    ("legs", "zebro-100-serial"): {"legs"},
    ("imu2", "imu-quaternion-serial"): {"imu2"},
    ("rig", "rig-odrive-netft"): {"drives", "load_cell"},
    ("rig", "rig-board-serial"): {"board"},
}


@pytest.mark.parametrize("stored", STREAMS)
def test_each_stream_of_a_profile_has_its_topics(stored, tmp_path):
    name, profile = stored
    (tmp_path / "profiles").mkdir()
    file = tmp_path / "profiles" / f"{name}.toml"
    file.write_text(profile_text(profile))
    views = profile_views(file)
    assert set(views) == STREAMS[stored]
    for stream, view in views.items():
        assert view.topics
        assert all(topic.startswith(f"/{stream}/") for topic in view.topics)
    assert set(stored_views(tmp_path, [name])) == STREAMS[stored]
