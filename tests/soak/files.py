"""Laws of what a plan writes: its counts add up, and the checker agrees with it."""

import tempfile
from pathlib import Path

from hypothesis import strategies as st

from plan_cutters.command.codes import code_of
from plan_cutters.report.to_json import dumps
from plan_cutters_check.check import check
from tests.soak.cases import Mill, Setting, Turn, VoidError, parts, refused, settings, tools
from tests.soak.register import law
from tests.support import fuzz_read
from tests.support.cad_parts import write_step
from tests.support.written_plan import Written

#: Seconds that the checker may take.
_CHECK = 15.0


def adds_up(document, code):
    """What does not add up in a plan.json, given the exit code that goes with it; empty if all does."""
    fault = fuzz_read.wrong(document, code, b"", document)
    if fault == "the cutter selected does not reach every sample":
        # It need not reach what lies inside another body, or at a sharp edge that may stay.
        entry = next(each for each in document["cutters"] if each["id"] == document["selected"])
        fault *= entry["inaccessible"] + entry["undecided"] > entry.get("inside_bodies", 0) + entry.get("exempt", 0)
    return fault


@law(st.tuples(settings(), st.sampled_from([(), ("stick-out",), ("radius",), ("mend",)]), st.booleans()))
def a_plan_adds_up(case: tuple[Setting, tuple, bool]):
    """Every face and every sample is judged or listed, and the document is as its schema says."""
    import json

    setting, answers, maps = case
    result = setting.planned(answers=answers, posture_maps=maps, sharp_edges="left" if maps else "asked")
    fault = adds_up(json.loads(dumps(result.plan)), code_of(result.plan))
    assert not fault, f"{fault}; {setting!r}"


ROTARY = st.sampled_from([
    Mill(), Mill(turns=(Turn("part", (0.0, 0.0, 1.0)), Turn("part", (1.0, 0.0, 0.0), (-100.0, 30.0)))),
    Mill(turns=(Turn("part", (0.0, 0.0, 1.0)), Turn("tool", (0.0, 1.0, 0.0), (-95.0, 95.0)))),
    Mill(turns=(Turn("tool", (0.0, 0.0, 1.0)), Turn("tool", (1.0, 0.0, 0.0), (-110.0, 110.0)))),
])  # fmt: skip


@law(st.tuples(settings(part=parts(2), mill=ROTARY), tools(), st.sampled_from(["fewest", "fastest", "both"])), seconds=120.0)
def the_checker_agrees(case: tuple[Setting, object, str]):
    """The checker, which shares nothing with the search, finds no fault with a plan of operations."""
    setting, second, which = case
    if setting.part.sheet:
        raise VoidError("an open sheet")
    with tempfile.TemporaryDirectory() as folder:
        file = write_step(setting.part.shape, Path(folder) / "part.step")
        cutters = list({each.id: each for each in (setting.tool.cutter, second.cutter)}.values())
        options = {**setting.options, "cutters": cutters, "operations": which, "feed": 1000.0}
        from plan_cutters import plan

        refused(lambda: plan(str(file), **options).write(folder, ["json", "npz"]))
        answer = check(Written(Path(folder), str(file), options).asked(), seconds=_CHECK)
        wrong = [each.words for each in answer.findings if each.holds is False]
        assert not wrong, f"{wrong[:3]}; {case!r}"
