# SPDX-License-Identifier: MIT
"""In a picture of darkest values a chain of exposures makes it likelier, point by point."""

import numpy as np
import pytest

from support.drawn_board import SIZE, composite, likeness
from tracking.composite.chain import steady_chain
from tracking.composite.darkest import Chain, DarkestSearch

WALK = steady_chain(np.array([-0.15, -0.05, 0.15]), np.array([0.14, 0.0, 0.1]), 0.0, 2, 0)


@pytest.fixture(scope="module")
def search() -> DarkestSearch:
    """Return a picture of the darkest values of three exposures, the first one known."""
    picture = likeness(composite(WALK, "darkest"), WALK[0], reach=0.3)
    return DarkestSearch(*picture.raster(SIZE[0] / 24), SIZE[0])


def test_true_exposures_make_the_picture_likelier_and_others_do_not(search):
    assert search.worth(WALK) > search.worth(WALK[:2]) > search.worth(WALK[:1])
    one_more = np.concatenate((WALK, [[-0.1, 0.2, 0.1]]))
    assert search.worth(one_more) < search.worth(WALK)
    assert search.worth(np.concatenate((WALK, WALK[-1:] + 1e-3))) == -np.inf


def test_an_exposure_gains_where_it_is_and_not_beside(search):
    look = search.look(WALK[:2])
    cover = search.cover(WALK[:2], look)
    tried = np.array([WALK[2], WALK[2] + [0.0, 0.15, 0.0]])
    gain, claim, inside = search.gains(tried, look, cover, search.body)
    assert gain.shape == claim.shape == inside.shape == (2,)
    assert gain[0] > 0.1 > gain[1]
    assert claim[0] > 0.3
    assert inside[0] == 1.0


def test_a_chain_is_fitted_to_the_walk(search):
    step = np.array([0.13, 0.005, 0.08, 0.0])
    fitted = search.fitted(WALK[0], Chain(step, 2, 0))
    np.testing.assert_allclose(fitted.poses(WALK[0])[:, :2], WALK[:, :2], atol=0.012)


def test_a_part_of_the_picture_has_the_same_value(search):
    rows, columns = (slice(0, size) for size in search.used.shape)
    part = search.part(rows, columns)
    assert part.value(WALK) == pytest.approx(search.value(WALK))


def test_a_chain_with_some_between_holds_the_chain():
    chain = Chain(np.array([0.2, 0.0, 0.1, 0.0]), 2, 1)
    some = chain.with_some_between.poses(WALK[0])
    assert len(some) == 7
    for pose in chain.poses(WALK[0]):
        assert np.hypot(*(some - pose)[:, :2].T).min() < 3e-3
