"""Observables against motions whose answers are known."""

from __future__ import annotations

import numpy as np
import pytest

from trbdyn import observables as obs

PLAY = 0.25e-3


def circle(
    radius: float = 0.2e-3,
    hertz: float = 20.83,
    duration: float = 0.5,
    n: int = 5001,
    centre: tuple[float, float] = (0.0, 0.0),
) -> tuple[np.ndarray, np.ndarray]:
    t = np.linspace(0.0, duration, n)
    angle = 2 * np.pi * hertz * t + 0.3
    return t, np.column_stack([centre[0] + radius * np.cos(angle), centre[1] + radius * np.sin(angle), np.zeros(n)])


def test_orbit_radius_forgets_where_the_orbit_lies() -> None:
    t, p = circle(radius=0.05e-3, hertz=20.0, duration=0.5, centre=(0.0, -0.2e-3))
    whole = p[:-1]
    np.testing.assert_allclose(obs.orbit_radius(whole), 0.05e-3, rtol=1e-9)
    assert obs.axis_distance(whole).max() == pytest.approx(0.25e-3, rel=1e-4)
    assert obs.whirl_frequency(t[:-1], whole, "mean") == pytest.approx(20.0, rel=1e-6)
    assert abs(obs.whirl_frequency(t[:-1], whole, "axis")) < 0.5


@pytest.mark.parametrize("hertz", [20.83, -20.83, 3.7])
def test_whirl_frequency_by_angle_and_by_spectrum(hertz: float) -> None:
    t, p = circle(hertz=hertz, duration=1.0)
    assert obs.whirl_frequency(t, p, "axis") == pytest.approx(hertz, rel=1e-9)
    assert obs.whirl_frequency_spectral(t, p) == pytest.approx(hertz, abs=0.1)


def test_spectral_frequency_survives_noise_that_spoils_the_angle() -> None:
    t, p = circle(radius=0.02e-3, duration=2.0, n=20001)
    p = p + np.random.default_rng(3).normal(0.0, 0.02e-3, p.shape)
    assert obs.whirl_frequency_spectral(t, p) == pytest.approx(20.83, abs=0.05)


def test_whirl_frequency_of_a_cage_at_rest_is_undefined() -> None:
    t = np.linspace(0, 1, 100)
    assert np.isnan(obs.whirl_frequency_spectral(t, np.zeros((100, 3))))


def test_spectrum_integrates_to_the_mean_square() -> None:
    t = np.linspace(0.0, 2.0, 8000, endpoint=False)
    x = 3.0 * np.sin(2 * np.pi * 50.0 * t) + 7.0
    f, p = obs.spectrum(t, x)
    assert np.trapezoid(p, f) == pytest.approx(4.5, rel=1e-3)
    assert obs.peak_frequency(f, p) == pytest.approx(50.0, abs=0.01)
    assert obs.high_share(f, p) < 1e-3
    late, power = obs.spectrum(t + 5.0, x)  # a record that begins late
    np.testing.assert_allclose(late, f)
    np.testing.assert_allclose(power, p, rtol=1e-6, atol=1e-12)


def test_uneven_times_are_interpolated() -> None:
    t = np.linspace(0.0, 1.0, 1001) ** 1.1
    interval, x = obs.uniform(t, 2.0 * t)
    assert interval == pytest.approx(1e-3)
    np.testing.assert_allclose(x, 2.0 * np.linspace(0.0, 1.0, 1001), atol=1e-12)
    with pytest.raises(ValueError, match="increase"):
        obs.uniform([0.0, 1.0, 0.5], [1, 2, 3])


def test_lean_is_positive_for_negative_theta_x_at_positive_y() -> None:
    up = np.array([[0.0, 1e-4, 0.0]])
    np.testing.assert_allclose(obs.lean(up, np.array([[-2e-4, 0.0]])), [2e-4])
    np.testing.assert_allclose(obs.lean(up, np.array([[0.0, 5e-4]])), [0.0])
    right = np.array([[1e-4, 0.0, 0.0]])
    np.testing.assert_allclose(obs.lean(right, np.array([[0.0, 3e-4]])), [3e-4])
    np.testing.assert_allclose(obs.lean(np.zeros((1, 3)), np.ones((1, 2))), [0.0])


def test_classification_of_three_motions() -> None:
    t, p = circle(radius=0.2e-3, hertz=20.0)
    v = np.gradient(p, t, axis=0)
    circling = obs.classify(p, v, PLAY)
    assert circling.kind == "circling"
    assert circling.orbit_over_play == pytest.approx(0.8, rel=1e-2)
    assert circling.speed_deviation_ratio < 0.02
    assert circling.whirl_coherence == pytest.approx(1.0, abs=1e-3)
    assert obs.classify(p * [1, -1, 1], v * [1, -1, 1], PLAY).whirl_coherence == pytest.approx(-1.0, abs=1e-3)
    still = obs.classify(1e-2 * p - [0, 0.2e-3, 0], 1e-2 * v, PLAY)
    assert still.kind == "stable"
    rng = np.random.default_rng(5)
    velocity = rng.normal(size=(20000, 2))
    assert obs.speed_deviation_ratio(velocity) == pytest.approx(np.sqrt(4 / np.pi - 1), rel=0.02)
    assert obs.classify(rng.normal(0.0, 0.1e-3, (20000, 2)), velocity, PLAY).kind == "unstable"
    for turned, kind in ((1.9, "unknown"), (2.1, "circling")):  # by the turns of the record, whatever came before it
        angle = 100.0 + np.linspace(0.0, 2.0 * np.pi * turned, len(p))
        assert obs.classify(p, v, PLAY, cage_angle=angle).kind == kind


def test_whirl_coherence_of_ellipses_and_lines() -> None:
    angle = np.linspace(0.0, 2 * np.pi, 2000, endpoint=False)
    for b in (1.0, 0.5, 0.0):
        place = np.column_stack([np.cos(angle), b * np.sin(angle)]) + 7.0
        velocity = np.column_stack([-np.sin(angle), b * np.cos(angle)])
        assert obs.whirl_coherence(place, velocity) == pytest.approx(2 * b / (1 + b**2), abs=1e-9)
    assert np.isnan(obs.whirl_coherence(np.zeros((9, 2)), np.zeros((9, 2))))


@pytest.mark.parametrize("n", [0, 12, -1])
def test_spacing_refuses_a_wrong_number_of_gaps(n: int) -> None:
    with pytest.raises(ValueError, match="between 1 and 11"):
        obs.spacing(np.zeros((3, 12)), n)


def test_energy_audit_without_losses_has_no_closure() -> None:
    terms = {"kinetic_energy": [1.0, 2.0], "elastic_energy": [1.0, 0.0], "work_shaft": [0.0, 1e-6]}
    audit = obs.energy_audit(terms)
    assert np.isnan(audit.closure)
    assert audit.relative_residual == pytest.approx(1e-6)
    with pytest.raises(ValueError, match="work_shaft"):
        obs.energy_audit({"kinetic_energy": [0.0], "elastic_energy": [0.0]})


def test_settling_of_several_signals_waits_for_the_last() -> None:
    t = np.linspace(0.0, 10.0, 5001)
    noise = 0.01 * np.random.default_rng(4).normal(size=(t.size, 2))
    quick, slow = np.exp(-t / 0.05), np.exp(-t / 0.8)
    both = obs.settling(t, np.column_stack([quick, slow]) + noise)
    assert both.time == obs.settling(t, slow + noise[:, 1]).time
    assert obs.settling(t, np.ones(t.size)) == obs.Settling(0, 0.0, True)
    with pytest.raises(ValueError, match="4 batches"):
        obs.settling([0, 1, 2], [0, 1, 2])
