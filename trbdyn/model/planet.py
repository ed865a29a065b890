"""The bearing of a planet wheel: its inner ring sits on a pin of the carrier, its outer ring turns with the planet."""

from __future__ import annotations

import math
from typing import Any

from trbdyn.base.validation import number_of
from trbdyn.errors import InputError
from trbdyn.model.bearing import Bearing
from trbdyn.model.motion import History
from trbdyn.model.rotating_load import RotatingLoad
from trbdyn.model.scene import Scene


def planet(
    bearing: Bearing,
    *,
    carrier_speed_rpm: float,
    planet_speed_rpm: float,
    arm: float,
    load: float,
    load_direction_deg: float = 90.0,
    gravity: tuple[float, float, float] = (0.0, 0.0, 0.0),
    **scene: Any,
) -> Scene:
    """The scene of a planet bearing, in axes that go round with the pin but do not turn.

    The pin circles about the carrier's axis, so that rollers and cage feel the acceleration arm x speed squared away from that
    axis; in these axes it is a field of gravity that turns with the carrier. The inner ring turns with the carrier, the outer
    ring with the planet, and the load of the gears, which keeps its direction on the carrier, turns with the carrier, too.

    Parameters
    ----------
    bearing : Bearing
        The bearing. Its axis is parallel to the carrier's.
    carrier_speed_rpm : float
        Speed of the carrier (rpm), not 0: that of the inner ring.
    planet_speed_rpm : float
        Absolute speed of the planet (rpm): that of the outer ring. A planet with speed n relative to the carrier has the
        carrier's speed plus n.
    arm : float
        Distance of the pin from the carrier's axis (m), > 0. The pin begins on the x axis, at +x of the carrier's axis.
    load : float
        Radial load of the pin on the inner ring (N).
    load_direction_deg : float
        Its direction relative to the arm (deg): 0 outward, 90 along the circle of the pin, as the tangential force of the
        gears is.
    gravity : tuple of float, shape (3,)
        Weight in the machine's axes (m/s2); none by default, as that of the circling is usually many times larger.
    **scene : Any
        Other fields of `Scene`, such as ``displacement`` or ``axial_load``, ``lubricant``, ``effects``.

    Returns
    -------
    Scene
        The scene; the ring follows the load as it turns.

    Raises
    ------
    InputError
        If a number is not allowed.

    Examples
    --------
    >>> import trbdyn as trb
    >>> scene = trb.planet(
    ...     trb.cases.rig_30310(),
    ...     carrier_speed_rpm=300,
    ...     planet_speed_rpm=-1200,
    ...     arm=0.12,
    ...     load=8000.0,
    ...     displacement=(None, None, -25e-6),
    ... )
    >>> round(max(scene.gravity[0].values)), scene.outer_speed_rpm
    (118, -1200)
    """
    speed, radius = number_of("carrier_speed_rpm", carrier_speed_rpm, "rpm"), number_of("arm", arm, "m", gt=0.0)
    if speed == 0.0:
        raise InputError.of(
            "carrier_speed_rpm", speed, "must not be 0: with a carrier at rest the bearing is an ordinary one (rpm)"
        )
    given = [name for name in ("speed_rpm", "outer_speed_rpm", "rotating_load", "ring", "radial_load") if name in scene]
    if given:
        raise InputError.of(
            given[0], scene[given[0]], "must not be given: it follows from the speeds and the load of the planet"
        )
    pull = radius * (speed * math.pi / 30.0) ** 2
    phase = -90.0 if speed > 0.0 else 90.0
    turning = {"frequency_hz": abs(speed) / 60.0}
    field = (
        History.harmonic(gravity[0], pull, **turning),
        History.harmonic(gravity[1], pull, phase_deg=phase, **turning),
        gravity[2],
    )
    return Scene(
        bearing,
        speed_rpm=speed,
        outer_speed_rpm=planet_speed_rpm,
        rotating_load=RotatingLoad(load, direction_deg=load_direction_deg if speed > 0.0 else -load_direction_deg),
        ring="follows",
        gravity=field,
        **scene,
    )
