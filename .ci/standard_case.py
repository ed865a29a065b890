"""The numbers of the 30310 with the default effects for programs in C: csrc/api/standard_case.inc.

python .ci/standard_case.py           says whether the file is as the package has it
python .ci/standard_case.py --write   writes it
"""

import sys
from pathlib import Path

FILE = Path(__file__).resolve().parent.parent / "csrc" / "api" / "standard_case.inc"
HEAD = "/* Parameters of a 30310 with the default effects that are not 0; written by .ci/standard_case.py. */\n"


def text() -> str:
    """What the file has to hold."""
    from trbdyn import _core
    from trbdyn.model.cases import rig_30310
    from trbdyn.model.flatten import parameter_block
    from trbdyn.model.scene import Scene

    block = parameter_block(Scene(rig_30310(), speed_rpm=3000.0, axial_load=4930.0))
    names = [row[0] for row in _core.parameter_table()]
    rows = [
        f"TRB_STANDARD({name}, {value!r})" for name, value in zip(names, block.tolist(), strict=True) if value != 0.0
    ]
    return HEAD + "\n".join(rows) + "\n"


def main() -> int:
    if "--write" in sys.argv[1:]:
        FILE.write_text(text(), encoding="utf-8")
        return 0
    same = FILE.read_text(encoding="utf-8") == text()
    print(
        "csrc/api/standard_case.inc is "
        + ("as the package has it" if same else "old: run .ci/standard_case.py --write")
    )
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
