# SPDX-License-Identifier: MIT
"""camera.toml comes back as it was written, and says what is wrong with it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracking.camera import Camera, CameraCalibration
from tracking.camera.corner_errors import CornerErrors
from zebro_lab.files.errors import SettingsError
from zebro_lab.track.camera_file import read_camera_file, render_camera_file

_ROOT = np.random.default_rng(1).normal(size=(9, 9)) * np.repeat([3.0, 1e-2], [4, 5])[:, None]
COVARIANCE = _ROOT @ _ROOT.T
GOOD = "size = [1280, 960]\nfocal = [1400, 1401]\ncentre = [640, 480]\n"


def calibration(numbers, distortion) -> CameraCalibration:
    fx, fy, cx, cy = numbers
    matrix = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1.0]])
    camera = Camera((1600, 1200), matrix, np.array(distortion), COVARIANCE)
    errors = CornerErrors(0.1, 0.05, 0.02, COVARIANCE)
    return CameraCalibration(
        camera, "full", errors, 0.2, ("a.jpg",), np.array([0.2]), 0.9, np.ones((6, 8), int)
    )


@given(
    st.tuples(*[st.floats(100, 5000)] * 4), st.tuples(*[st.floats(-0.5, 0.5)] * 5),
    st.text(min_size=1, alphabet=st.characters(codec="utf-8", exclude_categories=["Cs", "Cc"])),
)  # fmt: skip
def test_a_calibration_comes_back(tmp_path_factory, numbers, distortion, name):
    file = tmp_path_factory.getbasetemp() / "camera.toml"
    fit = calibration(numbers, distortion)
    file.write_text(render_camera_file(fit, photos={name: "0" * 64}), encoding="utf-8")
    camera = read_camera_file(file)
    assert camera.size == (1600, 1200)
    np.testing.assert_allclose(camera.matrix, fit.camera.matrix, rtol=1e-11)
    np.testing.assert_allclose(camera.distortion, fit.camera.distortion, rtol=1e-11)
    sd = np.sqrt(np.diag(COVARIANCE))
    np.testing.assert_allclose(
        camera.covariance / np.outer(sd, sd), COVARIANCE / np.outer(sd, sd), atol=1e-3
    )


def test_standard_deviations_alone_are_those_of_independent_errors(tmp_path):
    (tmp_path / "camera.toml").write_text(GOOD + "[calibration]\nfocal_sd = [2, 3]\n")
    covariance = read_camera_file(tmp_path / "camera.toml").covariance
    np.testing.assert_allclose(np.diag(covariance), [4, 9, 0, 0, 0, 0, 0, 0, 0])
    assert not (covariance - np.diag(np.diag(covariance))).any()


FAULTS = {
    "unknown key": (GOOD + "focall = 1", "did you mean 'focal'"),
    "no focal length": ("size = [1280, 960]\ncentre = [640, 480]", "focal: is missing"),
    "negative focal length": (GOOD.replace("1401", "-3"), "focal: is 1400, -3 px"),
    "half a pixel": (GOOD.replace("1280", "1280.5"), "integers of at least 16"),
    "too few numbers": (GOOD + "distortion = [0.1]", "expected a list of 5"),
    "text": (GOOD.replace("1400", '"wide"'), r"focal\[0\]"),
    "negative sd": (GOOD + "[calibration]\nfocal_sd = [-1, 1]", "focal_sd: is -1"),
    "impossible correlation": (
        GOOD + f"[calibration]\ncorrelation = {[0.9, -0.9, 0, 0, 0, 0, 0, 0, 0.9] + 27 * [0]}",
        "not correlations of nine numbers",
    ),
    "no TOML": ("size = ", "cannot be read as TOML"),
}


@pytest.mark.parametrize(("text", "message"), FAULTS.values(), ids=FAULTS)
def test_a_fault_is_named_with_file_and_key(tmp_path, text, message):
    file = tmp_path / "camera.toml"
    file.write_text(text)
    with pytest.raises(SettingsError, match=message) as caught:
        read_camera_file(file)
    assert str(file) in str(caught.value)


def test_the_file_of_the_other_option_is_distinguished(tmp_path):
    file = tmp_path / "x.toml"
    file.write_text("[markers.10]\nx = 0\n")
    with pytest.raises(SettingsError, match=r"are --camera and --floor exchanged\?"):
        read_camera_file(file)
