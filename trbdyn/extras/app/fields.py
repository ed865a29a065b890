"""The fields of the page: made from the fields of the models, with their units and meanings."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final, Literal, get_args, get_origin

from trbdyn.base.shown import field_rows, field_texts
from trbdyn.model.bearing import Bearing
from trbdyn.model.lubricants import OILS
from trbdyn.model.pocket_shapes import SHAPES

PAGE: Final[dict[str, tuple[str, str]]] = {
    "bore": ("d, bore", "m"),
    "outside": ("D, outside diameter", "m"),
    "width": ("T, width (B of a cylindrical bearing)", "m"),
    "C": ("C, dynamic rating", "N"),
    "e": ("e, factor", "1"),
    "Y": ("Y, factor (in place of e)", "1"),
    "C0": ("C0, static rating", "N"),
    "Y0": ("Y0, factor of P0", "1"),
    "Cu": ("Cu or Pu, fatigue limit", "N"),
    "contact_angle_deg": ("contact angle (in place of e)", "deg"),
    "n_rollers": ("Z, number of rollers", "1"),
    "roller_diameter": ("Dwe, roller diameter", "m"),
    "roller_length": ("Lwe, roller length", "m"),
    "pitch_diameter": ("Dpw, pitch diameter", "m"),
    "cup_width": ("width of the cup", "m"),
    "cage_mass": ("mass of the cage", "kg"),
    "flanges": ("type, if cylindrical", ""),
    "F": ("F, raceway of the inner ring", "m"),
    "E": ("E, raceway of the outer ring", "m"),
    "radial_clearance": ("radial clearance, if cylindrical", "m"),
    "reference_speed_rpm": ("reference speed", "rpm"),
    "limiting_speed_rpm": ("limiting speed", "rpm"),
}
"""Numbers of a catalogue page, of `Bearing.from_catalogue`: words and unit in SI."""
MAIN: Final = ("bore", "outside", "width", "C", "e", "C0")
"""Those that every page has."""
PAIR: Final[dict[str, tuple[str, str, Any, str]]] = {
    "arrangement": ("arrangement", "", "back to back", "Which ends of the bearings face each other."),
    "spread": ("spread of the load centres", "m", 0.15, "Distance between the load centres."),
    "end_play": ("end play", "m", -2e-5, "Of the shaft between both bearings; negative: preload."),
    "mass": ("mass of the shaft", "kg", 8.0, "With everything that turns with it."),
    "diameter": ("diameter of the shaft", "m", 0.06, "Of a cylinder with the same inertia."),
    "length": ("length of the shaft", "m", 0.3, "Of a cylinder with the same inertia."),
    "position": (
        "place of the load",
        "m",
        0.0,
        "Along the shaft, from the middle between the load centres; right is positive.",
    ),
}
"""What a pair on a shaft has beside its bearings: words, unit, default, meaning."""
ARRANGEMENTS: Final = ("back to back", "face to face")
CLEANLINESS: Final = ("13/10", "15/12", "17/14", "19/16", "21/18")
RELIABILITY: Final = ("90", "95", "96", "97", "98", "99")
ACTS: Final = {"gear": "a gear", "wheel": "a wheel on the road"}
"""What may act on a shaft besides a force."""
GEAR: Final[dict[str, tuple[str, str, Any, str]]] = {
    "torque": (
        "torque of the gear",
        "N m",
        None,
        "Of the mesh on this shaft; its sign gives the direction of turning.",
    ),
    "pitch_diameter": ("pitch diameter", "m", None, "Of the gear on this shaft."),
    "pressure_angle_deg": ("pressure angle", "deg", 20.0, "In the normal section."),
    "helix_angle_deg": (
        "helix angle",
        "deg",
        0.0,
        "With a positive torque a positive one pushes the shaft to the right.",
    ),
    "direction_deg": ("direction to the mesh", "deg", 0.0, "From the axis, from +x towards +y, which is up."),
    "position": ("place of the gear", "m", 0.0, "Along the shaft, from the middle between the load centres."),
}
"""A gear on the shaft, of `ShaftLoad.gear`: words, unit, default, meaning."""
WHEEL: Final[dict[str, tuple[str, str, Any, str]]] = {
    "load": ("load of the wheel", "N", None, "On a straight level road."),
    "rolling_radius": ("rolling radius", "m", None, "Distance of the road from the axis."),
    "cornering": ("lateral acceleration over g", "1", 0.0, "Positive: the outer wheel of the curve; usual up to 0.25."),
    "centre_height": ("height of the centre of mass", "m", 0.0, "Of the vehicle."),
    "track": ("track", "m", None, "Distance of both wheels of the axle; needed with the height."),
    "position": ("middle plane of the wheel", "m", 0.0, "Along the shaft, from the middle between the load centres."),
}
"""A wheel, of `ShaftLoad.wheel`."""
FIT: Final[dict[str, tuple[str, str, Any, str]]] = {
    "shaft": ("tolerance of the shaft", "", None, "By ISO 286, for instance m6."),
    "housing": ("tolerance of the housing", "", None, "By ISO 286, for instance N7."),
    "set": ("end play was set", "", "mounted", "The play of mounted bearings has the fits in it already."),
    "bore": ("d, bore", "m", None, "Where the bearing is neither of the table nor of a page."),
    "outside": ("D, outside diameter", "m", None, "Where the bearing is neither of the table nor of a page."),
    "width": ("T, width", "m", None, "Where the bearing is neither of the table nor of a page."),
    "housing_material": ("housing is of", "", "steel", "Aluminium grows twice as much when it becomes warm."),
    "inner_c": ("shaft and inner rings", "C", None, "Temperature in operation; 20 C where nothing is typed."),
    "outer_c": ("outer rings and housing", "C", None, "Temperature in operation; 20 C where nothing is typed."),
    "over": ("preload at the temperatures", "", None, "Of all parts, in C, with commas between: -20, 20, 60, 80."),
}
"""Seats and temperatures, of `Mounting` and `Temperatures`."""
_CHOICES: Final = {
    "pair.arrangement": ARRANGEMENTS,
    "fit.set": ("mounted", "before mounting"),
    "fit.housing_material": ("steel", "aluminium"),
}
_TEXTS: Final = ("fit.shaft", "fit.housing", "fit.over")
SHAPE: Final = "bearing.cage.pocket.shape"
SCENE: Final = ("speed_rpm", "axial_load", "radial_load", "radial_direction_deg", "misalignment_x", "misalignment_y",
                "outer_speed_rpm", "unloaded")  # fmt: skip


@dataclass(frozen=True)
class Field:
    """A field of the page."""

    path: (
        str  # in the tables of a case; ``page.`` and ``pair.`` begin those of a catalogue page and of a pair on a shaft
    )
    words: str  # its name on the page
    unit: str = ""  # unit in SI, empty where it has none
    choices: tuple[str, ...] = ()  # what may be chosen; ``('on', 'off')`` of a switch; empty: it is typed
    whole: bool = False  # whether it is a whole number
    text: bool = False  # whether it is a text
    default: Any = None  # its value where nothing is typed; None: there is none
    meaning: str = ""  # a sentence

    def value(self, typed: str) -> Any:
        """What stands in the tables for a choice or a text."""
        return typed == "on" if self.choices == ("on", "off") else typed


def page_fields() -> list[Field]:
    """The fields of a catalogue page."""
    types = ("NU", "NJ", "NUP", "N")
    made = [Field("page.name", "name", text=True, meaning="Name in titles and files.")]
    return made + [
        Field(f"page.{name}", words, "" if si == "1" else si, types if name == "flanges" else (), name == "n_rollers")
        for name, (words, si) in PAGE.items()
    ]


def pair_fields() -> list[Field]:
    """The fields of a pair on a shaft."""
    other = "Designation of the right bearing, where it differs from the left one."
    return [
        *_listed("pair", PAIR),
        Field("pair.other", "right bearing", text=True, meaning=other),
        *_listed("gear", GEAR),
        *_listed("wheel", WHEEL),
    ]


def _listed(prefix: str, table: dict[str, tuple[str, str, Any, str]]) -> list[Field]:
    return [
        Field(
            path=f"{prefix}.{name}",
            words=words,
            unit="" if si == "1" else si,
            choices=_CHOICES.get(f"{prefix}.{name}", ()),
            text=f"{prefix}.{name}" in _TEXTS,
            default=default,
            meaning=meaning,
        )
        for name, (words, si, default, meaning) in table.items()
    ]


def named_fields() -> list[Field]:
    """The designation, from which all dimensions follow."""
    words = "For instance 32208, 30310 or LM67048/LM67010, with or without the letters of a maker."
    return [Field("named.designation", "designation", text=True, meaning=words)]


def fit_fields() -> list[Field]:
    """Seats and temperatures."""
    return _listed("fit", FIT)


def rating_fields() -> list[Field]:
    """Dirt in the oil, and the reliability of a life."""
    dirt = "ISO 4406; where nothing is chosen, the ratings assume 17/14 and say so."
    return [
        Field("lubricant.cleanliness", "cleanliness of the oil", choices=CLEANLINESS, meaning=dirt),
        Field("lubricant.filtered", "oil circulates through a filter", choices=("on", "off"), default=False),
        Field(
            "rating.reliability", "reliability (%)", choices=RELIABILITY, default="90", meaning="Of the rating lives."
        ),
    ]


def oil_fields() -> list[Field]:
    """The oil and its temperature."""
    warm = "Temperature of the oil in the bearing, from which its viscosity follows."
    return [
        Field(
            "lubricant.oil",
            "oil",
            choices=tuple(OILS),
            default="vg100",
            meaning="One of the oils that ship with trbdyn.",
        ),
        Field("lubricant.temperature_c", "temperature", "C", default=60.0, meaning=warm),
    ]


def pocket_fields(shape: str) -> list[Field]:
    """The shape of the pockets, and the numbers of that shape."""
    words = "What the bars of the pockets look like; the drawing follows."
    made = [Field(SHAPE, "shape of the pockets", choices=tuple(SHAPES), default="default", meaning=words)]
    texts = field_texts(SHAPES[shape])
    for one in list(inspect.signature(SHAPES[shape]).parameters.values())[1:]:
        default = 0.0 if one.default is inspect.Parameter.empty else one.default
        said = texts.get(one.name, "")
        si = "deg" if one.name.endswith("_deg") else "m" if "(m)" in said else ""
        choices = ("leading", "trailing") if one.name == "missing" else ()
        path = f"bearing.cage.pocket.{one.name}"
        made.append(Field(path, _words(one.name), si, choices, default=default, meaning=re.sub(r" \(\w+\)", "", said)))
    return made


def fields_of(model: Any, prefix: str, only: tuple[str, ...] | None = None) -> Iterator[Field]:
    """Fields of a model and of the models in it, or only some of them: numbers, choices and switches, with the values that they
    have. The prefix is what their paths begin with.
    """
    for path, _, si, meaning in field_rows(model):
        *parts, name = path.split(".")
        if only is not None and path not in only:
            continue
        owner: Any = model
        for part in parts:
            owner = getattr(owner, part)
        value = getattr(owner, name)
        options = _options(type(owner).model_fields[name].annotation)
        choices = ("on", "off") if isinstance(value, bool) else options
        if not (choices or isinstance(value, int | float | str)):
            continue
        whole = isinstance(value, int) and not isinstance(value, bool)
        yield Field(
            f"{prefix}{path}", _words(path), si, choices, whole, isinstance(value, str), value, meaning.replace("`", "")
        )


def bearing_fields(bearing: Bearing) -> list[Field]:
    """The fields of a bearing, but for its pockets."""
    return list(fields_of(bearing, "bearing."))


def _options(annotation: Any) -> tuple[str, ...]:
    if get_origin(annotation) is Literal:
        return tuple(str(one) for one in get_args(annotation))
    return tuple(one for part in get_args(annotation) for one in _options(part))


def _words(path: str) -> str:
    """A name as words: ``roller.profile.a_p`` gives ``profile a_p`` below the heading of the rollers."""
    inner = path.split(".")[1:] or [path]
    return re.sub(r" (deg|rpm|c)$", "", " ".join(inner).replace("_", " "))
