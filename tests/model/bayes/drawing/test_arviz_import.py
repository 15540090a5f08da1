# SPDX-License-Identifier: MIT
import pytest

from model.bayes.drawing import arviz_import
from model.bayes.drawing.arviz_import import import_arviz


def failing(error, times):
    """Return an import that fails that often, and the names that were asked for."""
    asked = []

    def load(name):
        asked.append(name)
        if len(asked) <= times:
            raise error
        return name

    return load, asked


def test_a_stamp_that_another_process_took_is_tried_again(monkeypatch):
    load, asked = failing(FileNotFoundError("daily_warning.tmp"), 2)
    monkeypatch.setattr(arviz_import, "import_module", load)
    assert import_arviz() == "arviz"
    assert asked == ["arviz"] * 3


@pytest.mark.parametrize("error", [ImportError("no arviz"), PermissionError("cache")])
def test_other_errors_are_raised_at_once(monkeypatch, error):
    load, asked = failing(error, 9)
    monkeypatch.setattr(arviz_import, "import_module", load)
    with pytest.raises(type(error)):
        import_arviz()
    assert len(asked) == 1


def test_a_stamp_that_is_always_gone_is_an_error(monkeypatch):
    load, _ = failing(FileNotFoundError("daily_warning.tmp"), 99)
    monkeypatch.setattr(arviz_import, "import_module", load)
    with pytest.raises(FileNotFoundError):
        import_arviz()
