"""The program that never decides: it is never wrong, and scores nothing."""

from collections import Counter
from typing import Any

import numpy as np

from conformance.posture import Postures
from conformance.programs.protocol import UNDECIDED, Words
from conformance.suite import Held, Part
from conformance.tool import Tool


class Program:
    """Says undecided everywhere."""

    name = "undecided"
    libraries: tuple[str, ...] = ()

    def __init__(self) -> None:
        self.settings: dict[str, Any] = {}
        self.why: Counter[str] = Counter()

    def prepare(self, part: Part) -> None:
        """Do nothing."""

    def answer(self, part: Part, tool: Tool, setup: Held, postures: Postures) -> Words:
        """Return undecided for each posture."""
        self.why["it never decides"] += len(postures)
        return np.full(len(postures), UNDECIDED)
