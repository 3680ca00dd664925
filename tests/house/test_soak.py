"""The laws that `python -m tests.soak` draws cases of: each in one case, and what becomes of a law that is false."""

import inspect
import math
from dataclasses import replace

import pytest

from tests.soak import commands, exact, files, laws  # noqa: F401
from tests.soak.cases import Mill, Part, Setting, Tool, Turn, VoidError, bodies
from tests.soak.commands import Line
from tests.soak.register import LAWS, Law
from tests.soak.run import Soak, alone, drawn
from tests.soak.solids import Body

#: A block with a round pocket that some postures reach, and others do not.
POCKET = Part(((1, Body("box", (16.0, 14.0, 8.0))), (-1, Body("ball", (5.0,), at=(7.0, 6.0, 9.0)))))
SMALL = Setting(POCKET, Tool("bull", 3), Mill(tilt=70.0), tolerance=0.2, grid=3, step=90.0)
OTHER = Setting(POCKET, Tool("flat", 5, bare=False), Mill(), tolerance=0.2, grid=3, step=90.0)
BLOCK = Body("box", (4.0, 4.0, 6.0), at=(5.0, 16.0, 0.0))
TRUNNION = Mill(turns=(Turn("part", (0.0, 0.0, 1.0)), Turn("part", (1.0, 0.0, 0.0), (-100.0, 30.0))))
CASES = {
    "a_rigid_motion_changes_nothing": (SMALL, (20.0, -40.0, 75.0), (11.0, -7.0, 3.0)),
    "scaling_changes_nothing": (SMALL, 3.0),
    "more_in_the_way_never_gives_more": (SMALL, "fixture", 0.5, (BLOCK,)),
    "narrower_limits_never_give_more": (OTHER, 10, 20),
    "a_larger_tolerance_never_gives_less": (SMALL, 1.5),
    "the_order_of_features_changes_nothing": (
        SMALL.but(part=Part((*POCKET.steps, (-1, Body("rod", (2.0, 9.0), at=(13.0, 10.0, -0.5)))))), 1),
    "a_mirror_image_has_the_same_postures": (SMALL, "x"),
    "a_plan_adds_up": (SMALL, (), False),
    "the_checker_agrees": (SMALL.but(mill=TRUNNION, grid=3), Tool("ball", 2), "fewest"),
    "commands_end_as_they_say": Line("plan", "part.step", (("--tolerance", "nan"),)),
}  # fmt: skip


@pytest.mark.slow(
    "laws that other rooms test of parts of their own",
    only=(
        "a_rigid_motion_changes_nothing",
        "scaling_changes_nothing",
        "the_order_of_features_changes_nothing",
        "a_mirror_image_has_the_same_postures",
        "narrower_limits_never_give_more",
        "a_larger_tolerance_never_gives_less",
        "more_in_the_way_never_gives_more",
        "the_checker_agrees",
        "between_samples_is_safe",
    ),
)
@pytest.mark.parametrize("name", sorted(LAWS))
def test_a_law_holds_in_one_case(name, monkeypatch):
    monkeypatch.setattr(files, "_CHECK", 3.0)
    LAWS[name].holds(CASES.get(name, SMALL))


def test_the_exact_surface_is_as_deep_as_it_is_by_a_formula():
    """A flat end that stands on a floor 0.3 mm too low gouges by that; one that stands within the block is seen to, too."""
    setting = replace(SMALL, part=Part(((1, Body("box", (20.0, 20.0, 10.0))),)), tool=Tool("flat", 5))
    truth, radius = setting.truth(), setting.tool.cutter.radius
    for low, deep in ((0.3, 0.3), (0.0, 0.0), (4.0, min(4.0, radius))):
        found = truth.deepest([10.0, 10.0, 10.0 - low], [0.0, 0.0, 1.0], (0.0, 0.0))
        assert found == pytest.approx(deep, abs=1e-6 if low < 1.0 else 0.3)


def no_body_is_a_ball(body):
    """False on purpose."""
    assert body.kind != "ball"


def never_ends(body):
    """It takes longer than a case may."""
    while True:
        pass


FALSE = Law("no_body_is_a_ball", no_body_is_a_ball, bodies((20.0, 20.0, 10.0)), 5.0)


@pytest.fixture(scope="module")
def told():
    """What is printed of a law that is false."""
    lines = []
    soak = Soak([FALSE], shrink=math.inf, tell=lines.append)
    number = next(k for k in range(100) if alone(FALSE, drawn(FALSE, k)).fell)
    soak.one(soak.rows[0], number)
    return soak, number, lines


class TestALawThatIsFalse:
    def test_it_falls_and_is_made_smaller(self, told):
        soak, *_ = told
        ((_, case, outcome),) = soak.rows[0].fell
        assert outcome.kind == "fell"
        # The smallest ball that is drawn, turned by nothing.
        assert (case.kind, case.sizes, case.turn) == ("ball", (2.0,), (0.0, 0.0, 0.0))
        assert "fell: --only no_body_is_a_ball --case" in soak.table()

    def test_it_is_printed_as_a_test_that_falls(self, told):
        _, number, lines = told
        code = compile(lines[-1], "pasted", "exec")
        names = {}
        LAWS[FALSE.name] = FALSE
        try:
            exec(code, names)
            with pytest.raises(AssertionError):
                names[f"test_{FALSE.name}_{number}"]()
        finally:
            del LAWS[FALSE.name]
        assert f"--only {FALSE.name} --case {number}" in inspect.getdoc(names[f"test_{FALSE.name}_{number}"])


def test_the_same_seed_gives_the_same_cases():
    for law in LAWS.values():
        first = [repr(drawn(law, number)) for number in (1, 2)]
        assert first == [repr(drawn(law, number)) for number in (1, 2)]
        assert len({*first}) == 2


def test_a_case_that_takes_too_long_is_ended():
    assert alone(Law("never_ends", never_ends, bodies((1.0, 1.0, 1.0)), 0.2), BLOCK).kind == "late"


def test_what_the_kernel_makes_otherwise_is_no_case():
    """As nothing that is left of a ball."""
    part = Part(((1, Body("ball", (4.0,))), (-1, Body("ball", (9.0,)))))
    with pytest.raises(VoidError):
        _ = part.shape
