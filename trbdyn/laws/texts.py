"""What the arguments of the laws mean, with their units: for the docstrings of `trbdyn.laws`."""

from __future__ import annotations

from typing import Final

ARGUMENTS: Final[dict[str, tuple[str, str]]] = {
    "a": ("bar", "constant of Dicke's law, `Lubricant.dicke.a`"),
    "approach": (
        "1",
        "(V/u) sqrt(2 R/h): speed V at which the gap h closes, mean speed u of the surfaces, radius R of the cylinder",
    ),
    "b": ("bar/C", "constant of Dicke's law, with the temperature"),
    "c": ("1", "constant of Dicke's law, with the pressure"),
    "d": ("1/C", "constant of Dicke's law, with pressure and temperature"),
    "cap": ("1", "largest value of ln(eta/eta0)"),
    "clearance": ("m", "radial clearance of the journal"),
    "decay": ("1", "decay of the law over the slide-roll ratio, `Friction.boundary_decay`"),
    "eccentricity": ("1", "distance of the axes over the clearance, below 1"),
    "eccentricity_across": ("1", "the same across the velocity, positive to its left"),
    "eccentricity_along": (
        "1",
        "distance of the axes along the velocity, over the clearance; positive: the gap closes",
    ),
    "effective_modulus": ("Pa", "E' = 2/[(1 - v1^2)/E1 + (1 - v2^2)/E2]; 226e9 for steel on steel"),
    "elastic_over_rigid": ("1", "film of the piezoviscous-elastic regime over that of the isoviscous-rigid one"),
    "entrainment_speed": (
        "m/s",
        "speed that replaces rolling where surfaces do not roll, `Friction.cage_entrainment_speed`",
    ),
    "film_parameter": ("1", "Lambda: film thickness over composite rms roughness"),
    "exponent": ("1", "C of the share of asperities, `Friction.asperity_exponent`"),
    "factor": ("1", "B of the share of asperities, `Friction.asperity_factor`"),
    "floor": ("1", "smallest value that the law gives, reached smoothly"),
    "G": ("1", "material group alpha0 E'"),
    "half_width": ("1", "half width of the change"),
    "interference": ("m", "how far the undeformed bodies overlap; no load for values <= 0"),
    "density": ("kg/m3", "density of the fluid"),
    "kinematic_viscosity": ("m2/s", "viscosity over density"),
    "k1": ("1", "K1 of the profile"),
    "k2": ("1", "K2 of the profile: share of the half length over which it drops"),
    "lambda_boundary": ("1", "film parameter below which friction is boundary friction"),
    "lambda_full": ("1", "film parameter above which the film carries all"),
    "length": ("m", "effective length of the contact"),
    "limit": ("1", "friction coefficient at large slide-roll ratios, `Friction.boundary_limit`"),
    "load": ("N", "load of the contact"),
    "load_per_length": ("N/m", "load of the contact over its length"),
    "low": ("any", "smallest value of the result"),
    "m": ("1", "parameter, the square of the modulus; 0 <= m < 1"),
    "mean_pressure": ("Pa", "mean Hertz pressure: pi/4 of the largest in a line contact, 2/3 in an ellipse"),
    "pressure": ("Pa", "pressure in the film"),
    "pressure_coefficient": ("1/Pa", "alpha0: d ln(eta)/dp at no pressure"),
    "pressure_over_modulus": ("1", "largest Hertz pressure over E'"),
    "radius": ("m", "equivalent radius Re of the two bodies across the contact line"),
    "radius_one": ("m", "relative radius of curvature in one principal plane"),
    "radius_two": ("m", "relative radius of curvature in the other principal plane"),
    "radius_ratio": ("1", "Ry/Rx, x along rolling"),
    "slide_roll": ("1", "sliding speed over mean speed of the surfaces"),
    "sigma": ("1", "Sigma = eta(pmean) sliding speed/(tau0 hc)"),
    "sliding_speed": ("m/s", "speed of one surface over the other"),
    "slope": ("1", "slope of the law, `Friction.boundary_slope`"),
    "station": ("m", "place along the roller from mid length"),
    "temperature": ("C", "temperature of the oil"),
    "thermal_loading": ("1", "Lt = eta0 beta u^2/k'"),
    "U": ("1", "speed group eta0 u/(E' Re), u the mean speed of the surfaces"),
    "value": ("any", "what is bounded"),
    "viscosity": ("Pa s", "eta0: viscosity at no pressure"),
    "W": ("1", "load group w/(E' Re), w the load over the length"),
    "width": ("m", "width of the journal that is filled with oil"),
    "zm": ("m", "drop at the end of the roller"),
}
"""Unit and meaning of each argument, by its name."""

OF_ONE_LAW: Final[dict[tuple[str, str], tuple[str, str]]] = {
    ("film_point_elastic", "W"): ("1", "load group Q/(E' Rx^2), x along rolling"),
    ("film_point_elastic", "U"): ("1", "speed group eta0 u/(E' Rx), u the mean speed of the surfaces"),
    ("film_point_rigid", "W"): ("1", "load group Q/(E' Rx^2), x along rolling"),
    ("film_point_rigid", "U"): ("1", "speed group eta0 u/(E' Rx), u the mean speed of the surfaces"),
    ("disc_torque", "radius"): ("m", "radius of the disc"),
    ("disc_torque", "speed"): ("rad/s", "speed of rotation"),
    ("journal_shear", "radius"): ("m", "radius of the journal"),
    ("profile_crowned", "radius"): ("m", "radius of the arc"),
    ("rolling_meniscus", "height_over_film"): ("1", "S: height of the oil over the smallest film"),
    ("rolling_supplied", "supply"): ("1", "share of rolling resistance that the supply leaves without heat"),
    ("rolling_supplied", "thermal_factor"): ("1", "share that the heat of a full inlet leaves"),
    ("rolling_gap", "radius_over_gap"): ("1", "equivalent radius over the gap"),
    ("rolling_hysteresis", "loss_factor"): ("1", "a_v: share of the elastic energy that is lost"),
    ("rolling_hysteresis", "width"): ("m", "half width of the contact"),
    ("profile_iso", "scale"): ("m", "a_p times the roller's diameter"),
    ("profile_iso", "length"): ("m", "c_p: length over which it drops, both ends together"),
    ("profile_iso", "straight"): ("m", "d_p: length of the straight middle"),
    ("profile_iso", "exponent"): ("1", "k_p: exponent of the way along the end"),
    ("profile_logarithmic", "load"): ("N", "load of the contact for which the profile is designed"),
    ("shear_modulus", "floor"): ("Pa", "smallest modulus that the law gives, reached smoothly"),
    ("smooth_max", "half_width"): ("any", "half width of the smooth change; the unit of the value"),
    ("traction_muraki_kimura", "d"): (
        "1",
        "D = eta(pmean) u/(Ginf b), the Deborah number; b half the width along rolling",
    ),
}
"""The same where a name means something of its own in one law."""

EXAMPLES: Final[dict[str, tuple[dict[str, float], str]]] = {
    "line_load": ({"interference": 5e-6, "effective_modulus": 226.37e9, "length": 20e-3}, "1.603e+05"),
    "traction_muraki_kimura": ({"sigma": 10.0, "d": 1.0}, "2.773"),
    "boundary_share": ({"film_parameter": 0.5, "lambda_boundary": 0.01, "lambda_full": 1.5}, "0.09139"),
    "film_line_elastic": ({"W": 7e-5, "U": 1.644e-10, "G": 4460.0}, "0.0001259"),
    "friction_boundary": ({"slide_roll": 0.02, "limit": 0.1, "slope": 22.28, "decay": 181.46}, "0.1092"),
    "journal_along": ({"eccentricity_along": 0.0, "eccentricity_across": 0.0}, "1.571"),
    "squeeze_load": ({"approach": 0.0}, "0.2041"),
    "rolling_line": ({"W": 2e-4, "U": 1e-10, "G": 3745.0}, "0.0002461"),
}
"""Arguments of an example and what it prints, for some laws."""


def docstring(name: str, arguments: list[str], text: str) -> str:
    """The docstring of a law in numpydoc form: what it gives, then each argument with unit and meaning."""
    lines = [f"{text[0].upper()}{text[1:]}.", "", "Parameters", "----------"]
    for argument in arguments:
        known = OF_ONE_LAW.get((name, argument)) or ARGUMENTS.get(argument)
        if known is None:
            raise RuntimeError(f"trbdyn/laws/texts.py does not say what the argument {argument} of the law {name} is")
        unit, meaning = known
        word = meaning.split()[0]  # symbols keep their case
        said = f"{meaning[0].upper()}{meaning[1:]}" if word.isalpha() else meaning
        lines += [f"{argument} : array_like", f"    {said} ({unit})."]
    lines += [
        "",
        "Returns",
        "-------",
        "float or ndarray",
        "    In the shape to which the arguments broadcast; nan where an argument is.",
    ]
    if name in EXAMPLES:
        given, printed = EXAMPLES[name]
        call = f"trb.laws.{name}({', '.join(f'{argument}={value:g}' for argument, value in given.items())})"
        lines += ["", "Examples", "--------", ">>> import trbdyn as trb", f'>>> print(f"{{{call}:.4g}}")', printed]
    return "\n".join(lines) + "\n"
