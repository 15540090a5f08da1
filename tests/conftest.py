# SPDX-License-Identifier: MIT
"""Where the tests find reference data, and what every test shares."""

import gc
import os
import signal
from pathlib import Path

import pytest
from hypothesis import settings

import zebro_lab.terminal  # noqa: F401 - one BLAS thread, as the commands have

# FFmpeg takes its log level from the first video that any test reads or writes; see tracking's.
os.environ.setdefault("OPENCV_FFMPEG_LOGLEVEL", "-8")

# Tests send these signals to commands that they start. A shell that starts the tests in the
# background, or nohup, has them ignored, and commands inherit that.
for _number, _usual in (
    (signal.SIGINT, signal.default_int_handler),
    (getattr(signal, "SIGHUP", signal.SIGTERM), signal.SIG_DFL),
):
    if signal.getsignal(_number) is signal.SIG_IGN:
        signal.signal(_number, _usual)

REFERENCE = Path(os.environ.get("ZEBRO_LAB_SHARED", Path(__file__).parents[2] / "shared"))

HAS_REFERENCE = REFERENCE.is_dir() and any(REFERENCE.iterdir())

settings.register_profile("lab", deadline=None, derandomize=True, max_examples=50)
settings.load_profile("lab")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_setupnodes(config):
    """Compile the loops once before several workers run all tests; each worker would do it."""
    if config.args_source == pytest.Config.ArgsSource.TESTPATHS:
        from support.compile_loops import compile_loops

        compile_loops()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Mark the tests that ask for the reference data; skip marked ones where it is missing."""
    missing = pytest.mark.skip(
        f"no reference data in {REFERENCE}; set ZEBRO_LAB_SHARED to the folder that holds it"
    )
    for item in items:
        if "shared" in getattr(item, "fixturenames", ()):
            item.add_marker("reference")
        if "reference" in item.keywords and not HAS_REFERENCE:
            item.add_marker(missing)


def pytest_collection_finish():
    """Keep the garbage collector from looking through the thousands of tests again and again."""
    gc.collect()
    gc.freeze()


@pytest.fixture(scope="session")
def shared() -> Path:
    """Return the folder of reference data."""
    return REFERENCE


@pytest.fixture
def blank_pictures(monkeypatch) -> None:
    """Write empty files for figures, for claims that pictures do not show."""
    from matplotlib.figure import Figure

    drawn = Figure.savefig

    def savefig(figure, target, **options):
        if isinstance(target, Path):
            target.write_bytes(b"")
        else:  # a frame of a film
            drawn(figure, target, **options)

    monkeypatch.setattr(Figure, "savefig", savefig)


@pytest.fixture
def coarse_pictures(monkeypatch) -> None:
    """Write figures of few pixels, not laid out, for claims that do not look into them."""
    from matplotlib.figure import Figure

    drawn = Figure.savefig

    def savefig(figure, target, **options):
        figure.set_layout_engine("none")
        drawn(figure, target, **(options | {"dpi": 15}))

    monkeypatch.setattr(Figure, "savefig", savefig)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item, call):
    """Turn a skip into a failure where the reference data exists: nothing excuses it there."""
    report = yield
    if "browser" in item.keywords:  # a browser is not part of the reference data
        return report
    if report.skipped and HAS_REFERENCE and not hasattr(report, "wasxfail"):
        report.outcome = "failed"
        report.longrepr = f"skipped although reference data exists: {report.longrepr}"
    return report
