"""Words as they are said in a shop: diameters, inches, standard chucks, axes, a table below the part, names of tools."""

import json
import math
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from plan_cutters import plan, posture_map
from plan_cutters.command.summary import _NAME, _distinct
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.holder import NOSES, TAPERS, Holder, Segment, words
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.standard_tools import builtin
from plan_cutters.errors import CutterError, OptionError
from plan_cutters.library.raw_tool import Entry, Library
from plan_cutters.library.read import holder_of
from plan_cutters.options import Options
from plan_cutters.plan_file.words.names import called, described, kind, short_names
from plan_cutters.scene.scene import Scene
from plan_cutters.setups.files import read_setup
from tests.support import shapes
from tests.support.cad_parts import box
from tests.support.forked import run
from tests.support.places import DATA

REAL = DATA / "tools"

#: Lengths of three digits behind the point, mm, as texts and numbers.
LENGTHS = st.integers(1, 200_000).map(lambda n: n / 1000)


def same(one, other):
    """Whether two cutters are the same solid, bit for bit, whatever they are called."""
    return replace(one, name="") == replace(other, name="") and one.id == other.id


@given(radius=LENGTHS, corner=st.floats(0, 1), more=LENGTHS, neck=LENGTHS, shank=LENGTHS)
def test_diameters_and_radii_give_the_same_cutter(radius, corner, more, neck, shank):
    rounding = round(corner * radius, 3)
    rounding = rounding if rounding <= radius else 0.0
    flutes = radius + more
    tail = f"L{flutes + 50 + more:.4f}rc{rounding:.4f}F{flutes:.4f}N"
    by_radius = Cutter.parse(f"R{radius:.4f}{tail}{neck:.4f}x30S{shank:.4f}")
    by_diameter = Cutter.parse(f"D{2 * radius:.4f}{tail}{2 * neck:.4f}x30S{2 * shank:.4f}")
    assert same(by_radius, by_diameter)
    assert same(Cutter.parse(by_radius.id), Cutter.parse(by_diameter.id))


@given(tenths=st.integers(1, 100_000))
def test_an_inch_is_25_4_mm_and_nothing_else(tenths):
    """Against whole numbers: a ten-thousandth of an inch is 2540 nm."""
    inch = f"{tenths / 10_000:.4f}"
    whole, part = divmod(tenths * 2540, 1_000_000)
    mm = f"{whole}.{part:06d}"
    for word in "RD":
        assert same(Cutter.parse(f"{word}{inch}inL3in"), Cutter.parse(f"{word}{mm}mmL76.2"))
    assert Holder.parse(f"D{inch}inL2in").id == Holder.parse(f"D{mm}L50.8").id


@pytest.mark.parametrize(
    ("text", "known"),
    [
        ("D12L80", "R6L80"),
        ("d12l80RC6", "R6L80rc6"),
        ("D0.5inL3in", "R6.35L76.2"),
        ("D1/2inL3in", "R6.35L76.2"),
        ("D0.5INL80", "R6.35L80"),
        ("D12mmL80rc1T3F20N11:11.5x40S12", "R6L80rc1T3F20N5.5:5.75x40S6"),
    ],
)
def test_the_id_is_canonical_and_the_name_what_was_given(text, known):
    cutter = Cutter.parse(f" {text} ")
    assert cutter.id == known
    assert cutter.name == text
    assert Cutter.parse(known).name == ""


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("D12", "is not of the form R6L80 .* or D12L80"),
        ("12x80", "D0.5inL3in is in inches"),
        ("D12L80F20rc1", "'rc1' is none of what may follow D12L80F20: in this order, rc1 "),
        ("D12L80T5in", "'in' is none of what may follow D12L80T5"),
        ("D12cmL80", "is not of the form"),
        ("D1/0L80", "radius must be a positive number"),
        (f"D{'9' * 5000}L80", "radius must be a positive number"),
    ],
)
def test_bad_words_are_one_line_that_says_what_is_expected(text, cause):
    with pytest.raises(CutterError, match=cause) as error:
        Cutter.parse(text)
    assert "\n" not in str(error.value)


class TestStandardHolders:
    @pytest.mark.parametrize("word", words())
    def test_each_holds_what_it_says_and_bounds_its_parts(self, word):
        """No section is narrower than the nut, the flange is there whole, the length is the gauge length."""
        holder = holder_of(word)
        taper, nose = word.split("-") if "-" in word else (None, word)
        nut = NOSES[nose]
        assert all(2 * stage.radius >= min(nut.diameter, TAPERS[taper].flange if taper else 1e9) for stage in holder.stages)
        assert 2 * holder.stages[0].radius == nut.diameter
        assert holder.stages[0].length >= nut.length
        length = math.fsum(stage.length for stage in holder.stages)
        if taper:
            standard = TAPERS[taper]
            assert length == pytest.approx(standard.gauge)
            wide = math.fsum(stage.length for stage in holder.stages if 2 * stage.radius >= standard.flange)
            assert wide >= standard.depth
        assert holder.name.lower().startswith(word)
        # The largest shank goes in, a wider one does not.
        Cutter(holder.bore / 2, 60, holder=holder)
        with pytest.raises(CutterError, match=f"does not fit {holder.name}, which takes up to {holder.bore:g} mm"):
            Cutter(holder.bore / 2 + 0.01, 60, holder=holder)

    @given(st.sampled_from(sorted(TAPERS)), st.sampled_from(sorted(NOSES)), st.floats(0, 1), st.floats(0, 1))
    def test_a_longer_one_bounds_all_of_the_shorter_but_the_flange(self, taper, nose, one, other):
        """Measured from the gauge line down, a longer chuck is nowhere narrower."""
        least = TAPERS[taper].depth + NOSES[nose].length
        short, long = sorted(round(least + share * (400 - least), 3) + 0.001 for share in (one, other))

        def radius(length, below):
            at = length - below
            for stage in Holder.parse(f"{taper}-{nose}x{length}").stages:
                if at <= stage.length + 1e-9:
                    return stage.radius
                at -= stage.length
            raise AssertionError(below)

        for below in np.linspace(0.01, short - 0.01, 40):
            assert radius(long, below) >= radius(short, below)

    @pytest.mark.parametrize("text", ["ER32", "HSK-A63-ER32", "hsk63a/er32", "a63-er32", "ISO40-ER16x100", "ct40-er32x4in"])
    def test_other_spellings(self, text):
        assert Holder.parse(text).stages[0].length > 0

    @pytest.mark.parametrize(
        ("text", "cause"),
        [
            ("er31", "no holder is called 'er31'; er32"),
            ("hsk63-er32", "hsk63a-er32"),
            ("bt40-er33", "bt40-er32"),
            ("er16x5", "its nut takes 17 mm"),
            ("bt40-er32x30", "its nut and its flange take 49 mm"),
            ("er32x9999", "to 500 mm"),
            ("nonsense", "nor a word as er32"),
        ],
    )
    def test_what_is_none_gives_the_near_ones(self, text, cause):
        with pytest.raises(CutterError, match=cause) as error:
            holder_of(text)
        assert "\n" not in str(error.value)

    def test_in_options_and_for_a_cutter_s_own(self):
        (one,) = Options(cutters="D12L80", holder="er32").judged
        assert one.holder.name == "ER32"
        assert one.id == Cutter(6, 80, holder="er32").id == "R6L80HR25.05L60"
        with pytest.raises(CutterError, match="24 mm does not fit ER16"):
            _ = Options(cutters=["D24L80"], holder="er16").judged

    @pytest.mark.parametrize("bore", [0.0, -1.0, math.nan, math.inf, "6"])
    def test_a_bore_is_a_length(self, bore):
        with pytest.raises(OptionError):
            Holder((Segment(15, 30),), bore=bore)

    def test_the_command_lists_and_draws_them(self, tmp_path):
        tools = partial(run, command="plan-cutters-tools")
        done = tools("--list-holders", "--draw", tmp_path / "all")
        assert done.returncode == 0
        assert all(f"\n{word} " in done.stdout for word in words())
        assert max(map(len, done.stdout.splitlines())) <= 130
        drawn = list((tmp_path / "all").iterdir())
        assert len(drawn) == len(words())
        assert 'class="part' in drawn[0].read_text("utf-8")
        given = ["--cutter", "D12L80", "--holder", "hsk63a-er32", "--draw", tmp_path / "one", "--json"]
        done = tools(*given)
        (library,) = json.loads(done.stdout)["libraries"]
        assert library["cutters"][0]["holder"]["name"] == "HSK63A-ER32x70"
        (sheet,) = (tmp_path / "one").iterdir()
        assert "flat end D12 x 80, HSK63A-ER32x70" in sheet.read_text("utf-8")
        for wrong in ([], ["--list-holders", "shop.tools"], ["--list-holders", "--cutter", "D12L80"]):
            assert tools(*wrong).returncode == 2


class TestSetups:
    @pytest.mark.parametrize(
        ("word", "axis"), [("+z", (0, 0, 1)), ("z", (0, 0, 1)), ("-Z", (0, 0, -1)), (" -y ", (0, -1, 0)), ("X", (1, 0, 0))]
    )
    def test_words_are_axes_everywhere(self, word, axis, tmp_path):
        assert Options(setup=word).setup == axis
        assert Options(other_setups=(word,)).other_setups == (axis,)
        assert Placement(z=word).z == axis
        assert Placement(z=axis, x="+y" if axis[1] == 0 else "+z").x is not None
        assert Scene.of(box(), setup=word).setup == axis
        (tmp_path / "s.toml").write_text(f'unit = "mm"\naxis = "{word}"\n')
        assert read_setup(tmp_path / "s.toml").z == axis

    @pytest.mark.parametrize("word", ["up", "z+", "+", "--z", "xy", ""])
    def test_others_are_none(self, word, tmp_path):
        with pytest.raises(OptionError):
            Options(setup=word)
        with pytest.raises(OptionError):
            Placement(z=word)
        (tmp_path / "s.toml").write_text(f'unit = "mm"\naxis = "{word}"\n')
        with pytest.raises(OptionError, match=r"give a direction as \+z"):
            read_setup(tmp_path / "s.toml")

    def test_on_the_command_line_a_word_with_a_sign_is_no_option(self):
        from plan_cutters.command.cli import command
        from plan_cutters.command.request import PlanRequest
        from plan_cutters.command.validation import options_of

        words = ["p.step", "--setup", "-y", "--setup", "Z"]
        options = options_of(PlanRequest(**command.make_context("plan-cutters", words).params))
        assert options.setup == (0, -1, 0)
        assert options.other_setups == ((0, 0, 1),)


class TestTables:
    AXES = (((0, 0, 1), (1, 0, 0)), ((0, -1, 0), (1, 0, 0)), ((1, 0, 0), (0, 1, 0)), ((0.6, 0, 0.8), (0.8, 0, -0.6)))

    @pytest.mark.parametrize(("axis", "along"), AXES)
    def test_a_holder_over_a_table_across_the_setup(self, axis, along):
        """The plate of `test_fixtures`, turned with its setup: the nose comes down to L cos(tilt) - (Rh - R) sin(tilt)."""
        part = shapes.shell(shapes.plane((-20, 5), (-20, 20), z=axis, x=along))
        cutter = Cutter.flat(radius=5, length=20, holder=Holder.parse("D60L40"))
        found = posture_map(part, point=(0, 0, 0), cutter=cutter, rotations=np.zeros(1), tolerance=0.0, setup=axis,
                            fixtures="table:-10")  # fmt: skip
        lowest = math.acos(-10 / math.hypot(20, 25)) - math.atan2(25, 20)
        ((low, high),) = np.degrees(found.free[0])
        assert (low, high) == pytest.approx((0, math.degrees(lowest)), abs=0.05)

    @pytest.mark.parametrize("axis", [(0, 0, 1), (0, -1, 0), (-1, 0, 0), (0.6, 0, 0.8), (0.6, 0.64, -0.48)])
    def test_without_a_height_it_lies_right_below_the_part(self, axis):
        low, high = np.array([1, 2, 3]), np.array([41, 32, 23])
        scene = Scene.of(box(40, 30, 20, (1, 2, 3)), setup=axis, fixtures=["table", "table@0,0,0"])
        lowest = sum(min(a * s, b * s) for a, b, s in zip(low, high, axis, strict=True))
        for standing in scene.surround().fixtures:
            heights = standing.obstacles.triangles.vertex @ np.array(axis)
            assert heights.max() == pytest.approx(lowest, abs=1e-9)
            # As far as any cutter goes, to all sides and down.
            assert heights.min() < lowest - 1900
            assert standing.body is not None

    def test_it_is_moved_by_its_shift_and_kept_by_its_angles(self):
        def top(text, axis=(0, -1, 0), along=None):
            scene = Scene.of(box(40, 30, 20), setup=axis, fixtures=text)
            return (scene.surround().fixtures[0].obstacles.triangles.vertex @ np.array(along or axis)).max()

        assert top("table@0,3,0") == pytest.approx(-33)
        assert top("table:-40@0,2,0") == pytest.approx(-42)
        # Turned by angles it is what it was: all below a height along its own z.
        assert top("table:-5@0,0,0,0,0,30", along=(0, 0, 1)) == pytest.approx(-5)
        assert not Fixture.parse("table:-5@0,0,0,0,0,30").follows_setup

    def test_what_looks_down_at_a_table_is_not_reached(self):
        """A block on its side: the face that stands on the table, and the one that looks up."""
        for axis in ("-y", "+y"):
            part = Scene.of(box(40, 30, 20), setup=axis).part
            normals = {f.id: plan(part, cutters="D6L60", faces=f.id, grid=3, area_budget=0).samples.normal[0] for f in part.faces}
            up = next(name for name, n in normals.items() if n @ Placement(z=axis).z > 0.9)
            down = next(name for name, n in normals.items() if n @ Placement(z=axis).z < -0.9)
            found = plan(part, cutters="D6L60", faces=f"{up},{down}", grid=5, setup=axis, fixtures="table", area_budget=0)
            (reach,) = found.reaches.values()
            bottom = found.samples.face == int(down[1:])
            assert reach.not_reached[bottom].all()
            assert reach.reached[~bottom].all()
            assert any("along the setup axis" in note for note in found.plan.notes)

    def test_several_setups_say_that_it_stays(self):
        part = box(40, 30, 20)
        how = {"cutters": "D6L60", "faces": "all", "grid": 3, "setup": "-y", "fixtures": "table:-500", "machine": "tilt:30",
               "area_budget": 0}  # fmt: skip
        both = plan(part, other_setups=["+y"], **how)
        assert any("stays there in the others" in note for note in both.plan.notes)

    @pytest.mark.parametrize(
        ("fixture", "setups"), [("table:-60", {"second_setup"}), ("box:5,5,5@500,0,0", {"setup", "second_setup"})]
    )
    def test_another_setup_is_no_step_where_a_table_would_lie_elsewhere(self, fixture, setups):
        found = plan(box(40, 30, 20), cutters="D6L60", faces="F4", grid=4, setup="-y", fixtures=fixture, machine="tilt:30",
                     answers="mend", area_budget=0).plan  # fmt: skip
        things = {change.thing for step in found.cutters[0].mend.steps for change in step.changes}
        assert things & {"setup", "second_setup"} == setups

    def test_in_a_setup_file_of_inches(self, tmp_path):
        path = tmp_path / "s.toml"
        path.write_text('unit = "in"\naxis = "-y"\nfixtures = ["table"]\n')
        assert read_setup(path).fixtures == (Fixture("table"),)
        path.write_text('unit = "in"\naxis = "-y"\nfixtures = ["table:-5"]\n')
        with pytest.raises(OptionError, match="must say its unit"):
            read_setup(path)


class TestNames:
    def test_the_nineteen_of_a_drawer_stay_apart_in_a_narrow_row(self):
        cutters = builtin()[:19]
        names = [called(cutter) for cutter in cutters]
        assert len(set(names)) == 19
        assert max(map(len, names)) <= _NAME + 2
        assert len(set(_distinct(names, _NAME))) == 19
        assert all(
            f"D{2 * cutter.radius:g} " in name and kind(cutter) in name for cutter, name in zip(cutters, names, strict=True)
        )
        assert not any("built-in" in name for name in names)

    @pytest.mark.parametrize(
        ("cutter", "name"),
        [
            (Cutter.parse("D12L80"), "flat end D12 x 80"),
            (Cutter.parse("R3L40rc3"), "ball end D6 x 40"),
            (Cutter.parse("D0.5inL3in"), "flat end D0.5in x 3in"),
            (Cutter.parse("R6L80rc1T5"), "bull nose D12 rc1 T5 x 80"),
            (Cutter(3, 40, 3, name="Finisher"), "Finisher D6"),
            (Cutter(3, 40, 3, name="6 mm ball, long"), "6 mm ball, long"),
            (Cutter(3, 40, 3, name="ball 16 and 6.5"), "ball 16 and 6.5 D6"),
            (Cutter.lollipop(radius=4, neck_radius=2, length=50), "lollipop D8 x 50"),
        ],
    )
    def test_by_description_and_diameter(self, cutter, name):
        assert called(cutter) == name

    def test_numbers_only_where_they_are_unique(self):
        """Of two libraries: 1 is in both, 3 is also a tool that is not used, 2 and 4 are of one tool."""
        ball, flat, bull = Cutter(3, 40, 3, name="Ball"), Cutter(6, 80, name="Flat"), Cutter(5, 60, 1, name="Bull")
        one = Library("a.toml", "x", (Entry("1", 1, cutter=ball), Entry("2", 2, cutter=flat), Entry("3", 3, unused="no")))
        two = Library("b.toml", "x", (Entry("1", 1, cutter=bull), Entry("2", 3, cutter=ball), Entry("3", 4, cutter=flat)))
        found = plan(box(), libraries=[one, two], faces="F1", grid=2, area_budget=0).plan
        names = short_names(found)
        assert names == {ball.id: "Ball D6", flat.id: "T2 T4 Flat D12", bull.id: "Bull D10"}

    def test_what_is_alike_is_told_by_its_holder_or_its_dimensions(self):
        given = [Cutter(4, 80, holder="er16"), Cutter(4, 80, holder="er32"), Cutter.parse("D10L80"),
                 Cutter.parse("D10L80F20S10"), Cutter(4, 80, name="flat end D8 x 80, ER32")]  # fmt: skip
        found = plan(box(), cutters=given, faces="F1", grid=2, area_budget=0).plan
        names = short_names(found)
        assert len(set(names.values())) == 5
        # What it would be called is the name of another one: so its id it is.
        assert names[given[1].id] == given[1].id
        assert names[given[4].id] == "flat end D8 x 80, ER32 (R4L80)"
        assert names[given[0].id] == "flat end D8 x 80, ER16"
        assert names[given[2].id] == "flat end D10 x 80 (D10L80)"
        assert names[given[3].id] == "flat end D10 x 80 (D10L80F20S10)"
        entry = next(c for c in found.cutters if c.id == given[1].id)
        assert described(entry, "flat end D8 x 80, ER32") == "R4L80, 80 mm out of its holder ER32, up to D50.1 wide"
        inline = plan(box(), cutters="D0.5inL3in", faces="F1", grid=2, area_budget=0).plan
        assert described(inline.cutters[0], "flat end D0.5in x 3in").startswith("D0.5inL3in, ")

    def test_the_examples_of_help_are_words_that_are_known(self):
        from plan_cutters.command.tools import command

        for text in ("--cutter D12L80 --holder hsk63a-er32 --draw drawings", "--list-holders"):
            assert command.make_context("plan-cutters-tools", text.split())
