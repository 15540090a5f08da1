# SPDX-License-Identifier: MIT
import numpy as np
import pytest

from model.bayes.likelihood import NUISANCE
from model.bayes.priors import LogNormal, Normal, Truncated, Uniform
from model.slip.thesis_curve import THESIS_LAW
from zebro_lab.calibration.prior_argument import named_priors, parse_prior
from zebro_lab.files.errors import SettingsError

PARAMETERS = (*THESIS_LAW.parameters, *NUISANCE)


def stated(*texts):
    """Return the priors of some texts by the parameter's name."""
    found = named_priors([parse_prior(each, key="--prior") for each in texts], PARAMETERS, key="x")
    return {name: prior for name, (prior, _) in found.items()}


@pytest.mark.parametrize(
    ("text", "name", "prior"),
    [
        ("friction = 0.40 ± 0.05", "friction", Normal(0.4, 0.05)),
        ("friction=.4+/-5e-2", "friction", Normal(0.4, 0.05)),
        ("mu = 0.4 +- 0.05", "friction", Normal(0.4, 0.05)),
        ("x_m/Fn = 0.0066 ± 0.0005 1/N", "peak_slip_per_load", Normal(0.0066, 0.0005)),
        ("gain_normal = 0 ± 0.5 %", "gain_normal", Normal(0.0, 0.005)),
        ("bias_normal = -20 ± 50 mN", "bias_normal", Normal(-0.02, 0.05)),
        ("friction = 0.1 ± 0.1", "friction", Truncated(0.1, 0.1, 0.0, np.inf)),
        ("shape = 1.6 ± 0.3", "shape", Truncated(1.6, 0.3, 1.0, 2.0)),
        ("slip_stiffness ~ lognormal(20, 0.3)", "slip_stiffness", LogNormal(20.0, 0.3)),
        ("shape ~ uniform(1.4, 1.7)", "shape", Uniform(1.4, 1.7)),
        ("crosstalk ~ normal(0, 0.01)", "crosstalk", Normal(0.0, 0.01)),
    ],
)
def test_a_text_is_the_prior_that_it_says_in_si(text, name, prior):
    found = stated(text)[name]
    assert type(found) is type(prior)
    assert vars(found) == pytest.approx(vars(prior))


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        (["friction 0.4"], "is no prior; expected"),
        (["friction = 0.4"], "is no prior"),
        (["friction = 0.4 ± 0"], "standard deviation above 0"),
        (["friction = 0.4 ± 0.1e999"], "standard deviation above 0"),
        (["friction ~ beta(1, 2)"], "unknown family 'beta'; known: 'normal'"),
        (["shape ~ uniform(1.7, 1.4)"], "LOW below HIGH"),
        (["frction = 0.4 ± 0.1"], "did you mean 'friction'"),
        (["friction = -0.4 ± 0.1"], "outside the bounds of friction, 0 to inf"),
        (["shape ~ uniform(0.9, 1.4)"], "outside the bounds of shape, 1 to 2"),
        (["friction ~ lognormal(0, 0.1)"], "outside the bounds of friction, 0 to inf"),
        (["shape ~ lognormal(1, 0.1)"], "outside the bounds of shape, 1 to 2"),
        (["friction = 0.4 ± 0.1 N"], "cannot be converted"),
        (["friction = 0.4 ± 0.1", "mu = 0.5 ± 0.1"], "friction is stated twice"),
    ],
)
def test_what_is_no_prior_of_a_parameter_is_refused(texts, message):
    with pytest.raises(SettingsError, match=message):
        stated(*texts)
