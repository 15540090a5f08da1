# SPDX-License-Identifier: MIT
from benchmarks.accuracy import turning_radius


def test_radii_shrink_with_the_steering_factor_and_figures_are_drawn(monkeypatch, tmp_path, rows):
    monkeypatch.setattr(turning_radius, "IMAGES", tmp_path)
    monkeypatch.setattr(turning_radius, "FACTORS", (1.1, 1.3))
    turning_radius.radius_against_steering()
    [_, *wide, measured], [_, *tight, _] = rows()
    assert all(float(a) > float(b) > 0 for a, b in zip(wide, tight, strict=True))
    assert float(measured) > float(wide[-1])
    assert (tmp_path / "turning-radius.png").is_file()


def test_the_measured_angles_widen_the_turn(monkeypatch, rows):
    monkeypatch.setattr(turning_radius, "MEASURED", {1.3: turning_radius.MEASURED[1.3]})
    turning_radius.contributions()
    [[factor, _, no_slip, *_, together]] = rows()
    assert factor == "1.3"
    assert float(together) > float(no_slip)
