"""`trbdyn.frequencies`: how often defects of a bearing's parts are rolled over, from its geometry alone."""

from __future__ import annotations

from dataclasses import dataclass

from trbdyn.base.expected import expect
from trbdyn.base.shown import Shown, Tabled
from trbdyn.base.validation import number_of
from trbdyn.errors import InputError
from trbdyn.model.bearing import Bearing


@dataclass(frozen=True, eq=False, repr=False)
class Frequencies(Tabled):
    """Frequencies of a bearing in pure rolling (Hz).

    Attributes
    ----------
    bpfo, bpfi : float
        A place of the outer, or of the inner, raceway is rolled over so often: ball pass frequencies.
    bsf : float
        Rotation of a roller about its own axis, against the cage. A defect of a roller meets a raceway twice in each turn.
    ftf : float
        Rotation of the cage, against the housing: fundamental train frequency. It is negative where the cage turns backwards.
    reference : float
        Speed of the shaft, or of the outer ring where the shaft rests (Hz): orders count in it.
    """

    bpfo: float
    bpfi: float
    bsf: float
    ftf: float
    reference: float

    @property
    def orders(self) -> dict[str, float]:
        """The same over the speed of the shaft, or of the outer ring where the shaft rests (1)."""
        return {name: getattr(self, name) / self.reference for name in _MEANINGS}

    def _shown(self) -> Shown:
        orders = self.orders
        rows = tuple(
            (name.upper(), f"{getattr(self, name):.5g}", f"{orders[name]:.5g}", text)
            for name, text in _MEANINGS.items()
        )
        return Shown(
            f"Frequencies of defects at {60.0 * self.reference:.5g} rpm",
            (("", "Hz", "order", "of"), *rows),
            head=("name", "value", "order", "meaning"),
            notes=("Pure rolling. Rollers that slide turn slower, and so does their cage.",),
        )


_MEANINGS = {
    "bpfo": "rollers over a place of the outer raceway",
    "bpfi": "rollers over a place of the inner raceway",
    "bsf": "a roller about its axis; it meets a raceway twice a turn",
    "ftf": "the cage",
}


def frequencies(bearing: Bearing, *, speed_rpm: float, outer_speed_rpm: float = 0.0) -> Frequencies:
    """BPFO, BPFI, BSF and FTF: the frequencies by which defects of a bearing are found in its vibration.

    Parameters
    ----------
    bearing : Bearing
        A tapered or cylindrical bearing.
    speed_rpm : float
        Speed of the shaft (rpm).
    outer_speed_rpm : float
        Speed of the outer ring (rpm).

    Returns
    -------
    Frequencies
        In Hz, and as orders of the shaft's speed.

    Raises
    ------
    InputError
        If both rings turn alike, or not at all.

    Notes
    -----
    With the radii ri and ro of the raceways at one place of the contact, which are in the same ratio at every place of rolling
    cones, c = ri/(ri + ro), and the speed n of the shaft against the outer ring: cage c n against the outer ring, BPFO = Z c n,
    BPFI = Z (1 - c) n, BSF = c n ro/rw with the radius rw of the roller (Harris and Kotzalas, Rolling Bearing Analysis,
    chapter 10). Handbooks have c = (1 - Dw cos(alpha)/Dpw)/2, which is the same for cylinders.

    Examples
    --------
    >>> import trbdyn as trb
    >>> found = trb.frequencies(trb.cases.rig_30310(), speed_rpm=3000)
    >>> round(found.bpfo, 1), round(found.bpfi, 1), round(found.ftf, 1)
    (250.0, 350.0, 20.8)
    """
    expect("bearing", bearing, Bearing)
    shaft, outer = number_of("speed_rpm", speed_rpm) / 60.0, number_of("outer_speed_rpm", outer_speed_rpm) / 60.0
    if shaft == outer:
        raise InputError.of(
            "speed_rpm", speed_rpm, f"must differ from outer_speed_rpm = {outer_speed_rpm:g}: nothing rolls (rpm)"
        )
    geometry, rolling = bearing.geometry, shaft - outer
    share, count = geometry.cage_speed_ratio, bearing.n_rollers
    return Frequencies(
        bpfo=count * share * abs(rolling),
        bpfi=count * (1.0 - share) * abs(rolling),
        bsf=geometry.roller_spin_ratio * abs(rolling),
        ftf=share * rolling + outer,
        reference=abs(shaft if shaft != 0.0 else outer),
    )
