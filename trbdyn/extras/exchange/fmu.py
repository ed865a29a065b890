"""Writing a unit of FMI 3 by PythonFMU3, and what runs inside of it."""

from __future__ import annotations

import json
import re
import tempfile
from functools import partial
from pathlib import Path
from typing import Any, Final

from trbdyn.base.expected import expect
from trbdyn.base.own_files import output_path, write_whole
from trbdyn.errors import InputError, TrbError
from trbdyn.extras.exchange.fmu_unit import BearingUnit, Kind
from trbdyn.model.assembly import Subject
from trbdyn.model.scene import Scene

BASE_UNITS: Final[dict[str, dict[str, Any]]] = {
    "s": {"s": 1},
    "m": {"m": 1},
    "rad": {"rad": 1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N m": {"kg": 1, "m": 2, "s": -2},
    "rad/s": {"rad": 1, "s": -1},
    "degC": {"K": 1, "offset": 273.15},
    "W": {"kg": 1, "m": 2, "s": -3},
    "N/m": {"kg": 1, "s": -2},
    "m/s": {"m": 1, "s": -1},
}
"""Units of variables in those of the SI, as FMI wants them."""
CASE: Final = "case.json"

SCRIPT: Final = '''"""A bearing of trbdyn as a unit of FMI 3. Python with trbdyn has to be there where it runs."""

from pythonfmu3 import Fmi3Slave

from trbdyn.extras.exchange.fmu import begin, go


class {name}(Fmi3Slave):
    """{title}"""

    def __init__(self, **how):
        super().__init__(**how)
        begin(self)

    def do_step(self, current_time, step_size):
        return go(self, current_time, step_size)
'''


def write_fmu(
    scene: Subject, path: str | Path, *, ring: Kind = "motion", accuracy: str = "standard", overwrite: bool = False
) -> Path:
    """Write a bearing as a unit for co-simulation by FMI 3.

    The unit holds the case; Python with trbdyn has to be there where it runs.

    Parameters
    ----------
    scene : Scene
        The bearing.
    path : path-like
        File to write, which ends in .fmu.
    ring : {'motion', 'forces'}
        What goes in: the motion of the inner ring, or forces on it.
    accuracy : {'fast', 'standard', 'reference'}
        Preset of the tolerances.
    overwrite : bool
        Replace the file if it is there.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        If an argument is not allowed, or PythonFMU3 is not installed.
    FileError
        If the file cannot be written.
    """
    try:
        from pythonfmu3 import FmuBuilder
    except ModuleNotFoundError:
        raise InputError.of("fmu", str(path), "needs the package pythonfmu3: pip install 'trbdyn[fmi]'") from None
    expect("scene", scene, Scene)
    assert isinstance(scene, Scene)
    target = output_path(path, overwrite=overwrite, endings=(".fmu",))
    BearingUnit(scene, ring=ring, accuracy=accuracy)
    name = re.sub(r"\W", "_", target.stem)
    name = name if name[0].isalpha() else f"bearing_{name}"
    with tempfile.TemporaryDirectory() as folder:
        script, case = Path(folder, f"{name}.py"), Path(folder, CASE)
        script.write_text(SCRIPT.format(name=name, title=scene.title.replace('"', "'")), encoding="utf-8")
        case.write_text(json.dumps({"scene": scene.to_dict(), "ring": ring, "accuracy": accuracy}), encoding="utf-8")
        made = FmuBuilder.build_FMU(script, dest=Path(folder, "made"), project_files=[case])
        write_whole(target, made.read_bytes(), overwrite=overwrite, endings=(".fmu",))
    return target


def begin(slave: Any) -> None:
    """Make the bearing of a unit, and its variables."""
    from pythonfmu3 import DefaultExperiment, Float64, Fmi3Causality, Fmi3Initial, Fmi3Variability, Unit

    case = json.loads(Path(slave.resources, CASE).read_text(encoding="utf-8"))
    scene = Scene.from_dict(case["scene"])
    unit = BearingUnit(scene, ring=case["ring"], accuracy=case["accuracy"])
    slave.bearing = unit
    slave.description = scene.title
    slave.default_experiment = DefaultExperiment(start_time=0.0, stop_time=1e-2, step_size=1e-5)
    slave.register_units([Unit(name, **base) for name, base in BASE_UNITS.items()])
    slave.register_variable(
        Float64(
            "time",
            unit="s",
            description="time",
            causality=Fmi3Causality.independent,
            variability=Fmi3Variability.continuous,
            getter=lambda: unit.time,
        )
    )
    for one in unit.variables:
        slave.register_variable(
            Float64(
                one.name,
                unit=one.unit,
                description=one.text,
                causality=Fmi3Causality.input if one.is_input else Fmi3Causality.output,
                variability=Fmi3Variability.continuous,
                initial=None if one.is_input else Fmi3Initial.calculated,
                getter=partial(unit.get, one.name),
                setter=partial(unit.put, one.name) if one.is_input else None,
            )
        )


def go(slave: Any, time: float, size: float) -> Any:
    """A step of a unit; what fails is logged."""
    from pythonfmu3 import Fmi3Status, Fmi3StepResult

    try:
        slave.bearing.step(time, size)
    except TrbError as error:
        slave.log(str(error), Fmi3Status.error)
        return Fmi3StepResult(status=Fmi3Status.error)
    return Fmi3StepResult()
