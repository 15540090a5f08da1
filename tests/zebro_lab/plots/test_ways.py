# SPDX-License-Identifier: MIT
"""The figure of ways shows both paths, the goal and the robot, a panel a goal."""

import numpy as np
import pytest

from model.robot import Robot
from support.ways import made_way
from zebro_lab.plots.ways import DrawnGoal, ways_to_goals

PATHS = {"stop-turn-walk": made_way().path, "curve": made_way(end=(1.0, 0.3, 0.5)).path}


@pytest.mark.parametrize("n", [1, 4])
def test_each_goal_has_a_panel_with_both_ways_to_one_scale(n):
    goals = [DrawnGoal(f"goal {k}", (1.0, 0.2), 0.5 if k else None, PATHS) for k in range(n)]
    figure = ways_to_goals(goals, Robot(), title="Ways")
    shown = [axes for axes in figure.axes if axes.axison]
    assert [axes.get_title(loc="left") for axes in shown] == [goal.title for goal in goals]
    for axes in shown:
        labels = axes.get_legend_handles_labels()[1]
        assert set(labels) == {"stop-turn-walk", "curve", "start", "goal"}
        assert axes.get_aspect() == 1.0
        (low, high), (bottom, top) = axes.get_xlim(), axes.get_ylim()
        assert low < -0.05 < 1.1 < high
        assert high - low == pytest.approx(top - bottom)
    assert "(simulated)" in figure.get_suptitle()


def test_the_ends_of_both_paths_are_drawn():
    figure = ways_to_goals([DrawnGoal("goal", (1.0, 0.2), None, PATHS)], Robot(), title="Ways")
    drawn = {line.get_label(): line.get_xydata() for line in figure.axes[0].lines}
    for name, path in PATHS.items():
        np.testing.assert_allclose(drawn[name], path.position[:, :2])
