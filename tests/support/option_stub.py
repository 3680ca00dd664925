"""The stub by which type checkers know the options, made of their table; `python -m tests.support.option_stub` writes it."""

from plan_cutters.option_table import ATTRIBUTES, OF_A_SCENE, TAKES
from tests.support.places import PACKAGES

STUB = PACKAGES["plan_cutters"] / "option_types.pyi"
HEAD = '''"""Types of options as callers give them and as `Options` keeps them: made by `python -m tests.support.option_stub`."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypedDict

from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.holder import Holder
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.own_process import OwnProcess
from plan_cutters.domain.placement import Placement, Setup
from plan_cutters.domain.posture import Range
from plan_cutters.library.raw_tool import Library
'''


def stub() -> str:
    """The text of the stub."""
    scene = {word: TAKES[word] for word in OF_A_SCENE}
    records = {
        "class PointOptions(TypedDict, total=False)": {word: kind for word, kind in scene.items() if word != "tolerance"},
        "class SceneOptions(PointOptions, total=False)": {"tolerance": scene["tolerance"]},
        "class PlanOptions(SceneOptions, total=False)": {word: kind for word, kind in TAKES.items() if word not in scene},
        "@dataclass(frozen=True)\nclass OptionValues": {word: each.types[1] for word, each in ATTRIBUTES.items()},
    }
    return HEAD + "".join(
        f"\n{record}:\n" + "".join(f"    {word}: {kind}\n" for word, kind in fields.items()) for record, fields in records.items()
    )


if __name__ == "__main__":
    STUB.write_text(stub(), "utf-8")
