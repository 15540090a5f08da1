# SPDX-License-Identifier: MIT
"""What `import zebro_lab` offers is documented and typed."""

import inspect

import pytest

import zebro_lab as zl


def test_every_name_is_offered_and_documented():
    assert dir(zl) == sorted(zl.__all__)
    for name in zl.__all__:
        if name != "__version__":
            assert inspect.getdoc(getattr(zl, name))
    with pytest.raises(AttributeError, match="no attribute 'walkgait'"):
        _ = zl.walkgait


def test_parameters_of_public_functions_are_typed_and_described():
    for name in zl.__all__:
        function = getattr(zl, name)
        if not inspect.isfunction(function):
            continue
        for parameter in inspect.signature(function).parameters.values():
            assert parameter.annotation is not inspect.Parameter.empty
            assert f"{parameter.name}:" in (inspect.getdoc(function) or ""), (name, parameter.name)
