"""A small plan of operations with two cutters, a holder and a table, as its files say it, and the question for the checker."""

import copy
import json
import math
from pathlib import Path

import numpy as np

from cad_io import read_part
from plan_cutters import Options, plan
from plan_cutters_check.asking import question_of
from plan_cutters_check.check import on_paper
from plan_cutters_check.findings import Answer
from plan_cutters_check.question import Question
from tests.support.places import ROOT

PART = str(ROOT / "samples/pocket_top.step")
WORDS = {"cutters": ["R3L40rc1F12S3", "R2L40rc2F10S3"], "holder": "er16", "fixtures": "table", "faces": "all", "grid": 3,
         "machine": "trunnion-bc", "tilt": (0.0, math.radians(60.0))}  # fmt: skip
#: The same on a command line.
TYPED = ("--cutter", "R3L40rc1F12S3", "--cutter", "R2L40rc2F10S3", "--holder", "er16", "--fixture", "table", "--faces", "all",
         "--grid", "3", "--machine", "trunnion-bc", "--tilt", "0:60")  # fmt: skip
FILES = ("operations.npz", "samples.npz")


def write(folder: Path, words: dict | None = None) -> None:
    """Plan, and write what the checker reads."""
    plan(PART, operations="both", feed=2000, area_budget=2000, **(words or WORDS)).write(folder, ["json", "npz"])


class Written:
    """The files of a plan, to be forged: each call of `question` is about copies of them."""

    def __init__(self, folder: Path, part: str = PART, words: dict | None = None) -> None:
        self.document = json.loads((folder / "plan.json").read_text())
        self.arrays = {}
        for name in FILES:
            with np.load(folder / name) as archive:
                self.arrays[name] = {each: archive[each] for each in archive.files}
        self.part, self.options = read_part(part), Options(**(words or WORDS))
        self._of = question_of(self.part, self.options, self.document, self.arrays)

    def copies(self) -> tuple[dict, dict]:
        """plan.json and the arrays, to be altered."""
        arrays = {name: {each: array.copy() for each, array in found.items()} for name, found in self.arrays.items()}
        return copy.deepcopy(self.document), arrays

    def question(self, document: dict | None = None, arrays: dict | None = None) -> Question:
        """The question of the checker, about what is given instead of what was written."""
        arrays = self.arrays if arrays is None else arrays
        return Question(
            self.part, self._of.machine, self._of.tools, self._of.setups, self._of.ignored, self._of.sign, self._of.tolerance,
            self.document if document is None else document, arrays["operations.npz"], arrays["samples.npz"],
        )  # fmt: skip

    def asked(self, document: dict | None = None, arrays: dict | None = None) -> Question:
        """The question as `--check-operations` puts it.

        Raises
        ------
        OptionError
            The plan is of other options.
        """
        said = (self.document if document is None else document), (self.arrays if arrays is None else arrays)
        return question_of(self.part, self.options, *said)

    def read(self, document: dict | None = None, arrays: dict | None = None) -> Answer:
        """What is found of it without putting a tool down, but for its operations."""
        return on_paper(self.asked(document, arrays))
