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


def test_locus_and_radius_of_a_circle() -> None:
    _, p = circle(radius=0.2e-3)
    assert obs.locus(p, PLAY).shape == (5001, 2)
    np.testing.assert_allclose(np.hypot(*obs.locus(p, PLAY).T), 0.8, rtol=1e-12)
    np.testing.assert_allclose(obs.axis_distance(p), 0.2e-3, rtol=1e-12)


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


def test_cage_frequency_and_speed_ratio() -> None:
    t = np.linspace(0, 1, 11)
    assert obs.cage_frequency(t, 2 * np.pi * 20.0 * t + 4.0) == pytest.approx(20.0)
    assert obs.cage_speed_ratio(0.41662 * 300.0 * t, 300.0 * t) == pytest.approx(0.41662)
    assert np.isnan(obs.cage_speed_ratio(t, np.zeros(11)))


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


def test_spacing_sums_gaps_and_closes_the_circle() -> None:
    gaps = np.radians([29.0, 31.5, 30.0, 28.0, 30.5, 31.0, 30.0, 30.0, 29.5, 30.5, 29.0, 31.0])
    start = np.concatenate([[0.0], np.cumsum(gaps)[:-1]])
    turn = np.linspace(0.0, 40.0, 7)
    angle = start + turn[:, None]
    np.testing.assert_allclose(obs.spacing(angle), np.tile(gaps, (7, 1)), atol=1e-12)
    over_five = obs.spacing(angle, 5)
    assert over_five[3, 0] == pytest.approx(gaps[:5].sum())
    assert over_five[3, 10] == pytest.approx(gaps[10:].sum() + gaps[:3].sum())
    np.testing.assert_allclose(obs.spacing(angle).sum(axis=1), 2 * np.pi)
    np.testing.assert_allclose(obs.spacing_std(angle), np.degrees(gaps.std()))
    np.testing.assert_allclose(obs.spacing(np.mod(angle, 2 * np.pi)), np.tile(gaps, (7, 1)), atol=1e-12)


@pytest.mark.parametrize("n", [0, 12, -1])
def test_spacing_refuses_a_wrong_number_of_gaps(n: int) -> None:
    with pytest.raises(ValueError, match="between 1 and 11"):
        obs.spacing(np.zeros((3, 12)), n)


def test_kinematic_slip_of_rollers_and_at_standstill() -> None:
    shaft = np.array([100.0, 200.0, 0.0])
    orbit = np.array([[40.0, 39.6], [80.0, 80.0], [0.0, 0.0]])
    slip = obs.kinematic_slip(orbit, shaft, 0.4)
    np.testing.assert_allclose(slip[:2], [[0.0, 0.01], [0.0, 0.0]], atol=1e-15)
    assert np.isnan(slip[2]).all()
    np.testing.assert_allclose(obs.kinematic_slip(np.array([38.0]), np.array([100.0]), 0.4), [0.05])


def test_pocket_statistics_of_known_forces() -> None:
    force = np.zeros((100, 2, 3))
    force[:20, 0, 1] = np.arange(1.0, 21.0)
    force[:, 1, 2] = 5.0
    stats = obs.pocket_statistics(force)
    assert stats.peak[0, 1] == 20.0
    assert stats.p95[0, 1] == pytest.approx(np.percentile(np.arange(1.0, 21.0), 95))
    assert stats.mean[0, 1] == pytest.approx(2.1)
    assert stats.duty[0, 1] == pytest.approx(0.2)
    assert stats.duty[1, 2] == 1.0
    assert stats.p95[0, 0] == 0.0
    assert obs.pocket_statistics(force, threshold=10.0).duty[0, 1] == pytest.approx(0.1)


def audit_terms(t: np.ndarray, residual: float) -> dict[str, np.ndarray]:
    loss, extra = 100.0 * t, 20.0 * t
    kinetic, elastic, gravity = 5.0 + np.sin(t), 1.0 + 0.1 * t, 0.3 * t
    shaft = loss + extra + (kinetic - kinetic[0]) + (elastic - elastic[0]) - gravity + residual * t / t[-1]
    return {
        "kinetic_energy": kinetic,
        "elastic_energy": elastic,
        "work_shaft": shaft + 7.0,
        "work_ring": np.zeros_like(t),
        "work_gravity": gravity,
        "loss_rolling": loss,
        "loss_rolling_pressure": extra,
    }


def test_energy_audit_finds_the_residual() -> None:
    audit = obs.energy_audit(audit_terms(np.linspace(0, 2, 50), residual=0.012))
    assert audit.residual == pytest.approx(0.012, rel=1e-9)
    assert audit.dissipated == pytest.approx(240.0)
    assert audit.closure == pytest.approx(5e-5, rel=1e-9)
    assert audit.losses == pytest.approx({"rolling": 200.0, "rolling_pressure": 40.0})
    assert audit.stored == pytest.approx({"kinetic": np.sin(2.0), "elastic": 0.2})
    assert audit.work["gravity"] == pytest.approx(0.6)


def test_energy_balance_is_zero_for_an_exact_run() -> None:
    balance = obs.energy_balance(audit_terms(np.linspace(0, 2, 50), residual=0.0))
    assert np.abs(balance["residual"]).max() < 1e-12
    assert balance["work_shaft"][0] == 0.0


def test_energy_audit_without_losses_has_no_closure() -> None:
    terms = {"kinetic_energy": [1.0, 2.0], "elastic_energy": [1.0, 0.0], "work_shaft": [0.0, 1e-6]}
    audit = obs.energy_audit(terms)
    assert np.isnan(audit.closure)
    assert audit.relative_residual == pytest.approx(1e-6)
    with pytest.raises(ValueError, match="work_shaft"):
        obs.energy_audit({"kinetic_energy": [0.0], "elastic_energy": [0.0]})


def test_power_split_prefers_the_exact_energies() -> None:
    t = np.linspace(0.0, 2.0, 5)
    energy = {"loss_rib": 3.0 * t}
    power = {"power_rib": np.full(5, 99.0), "power_loss": np.full(5, 99.0)}
    assert obs.power_split(t, energy, power) == pytest.approx({"rib": 3.0})
    assert obs.power_split(t, None, power) == pytest.approx({"rib": 99.0})
    assert obs.torque_split({"inner_torque": [9.0], "inner_torque_rib": [0.2, 0.4]}) == pytest.approx({"rib": 0.3})


def test_settling_finds_the_end_of_a_transient() -> None:
    t = np.linspace(0.0, 10.0, 10001)
    rng = np.random.default_rng(2)
    x = 1.0 + np.exp(-t / 0.5) + 0.02 * rng.normal(size=t.size)
    found = obs.settling(t, x)
    assert found.settled
    assert 0.8 < found.time < 4.0
    assert abs(x[found.index :].mean() - 1.0) < 0.02
    assert t[found.index] == found.time


def test_settling_says_when_a_signal_still_drifts() -> None:
    t = np.linspace(0.0, 10.0, 1001)
    found = obs.settling(t, t)
    assert not found.settled
    assert found.time == pytest.approx(5.0, abs=0.02)


def test_settling_of_several_signals_waits_for_the_last() -> None:
    t = np.linspace(0.0, 10.0, 5001)
    noise = 0.01 * np.random.default_rng(4).normal(size=(t.size, 2))
    quick, slow = np.exp(-t / 0.05), np.exp(-t / 0.8)
    both = obs.settling(t, np.column_stack([quick, slow]) + noise)
    assert both.time == obs.settling(t, slow + noise[:, 1]).time
    assert obs.settling(t, np.ones(t.size)) == obs.Settling(0, 0.0, True)
    with pytest.raises(ValueError, match="4 batches"):
        obs.settling([0, 1, 2], [0, 1, 2])
