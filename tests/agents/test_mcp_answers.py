"""What stands between the protocol and the command: roots, lengths of answers, names of cutters, and the client's own roots."""

import io
import json
from types import SimpleNamespace

import anyio
import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st
from mcp import Client, types

from plan_cutters.domain.figures import percent, size
from plan_cutters.plan_file.load import plan_of
from plan_cutters.plan_file.model import Plan
from plan_cutters.plan_file.words.text import with_text
from plan_cutters_agents import child, command
from plan_cutters_agents.access import CallError, Limits, Roots
from plan_cutters_agents.plan_answers import chosen, compared, explained, planned
from plan_cutters_agents.server import made, service_of
from plan_cutters_agents.short import LISTS, short
from plan_cutters_agents.tools import fitting
from tests.support import plan_files


def made_plan(cutters=3, faces=4, **more):
    """A plan in which each cutter loses half of each face, the first of them nothing."""

    def of(i):
        counts = {"accessible": 2, "inaccessible": 0 if i == 0 else 2}
        share = {"accessible": 1.0 if i == 0 else 0.5, "inaccessible": 0.0 if i == 0 else 0.5,
                 "lost_by": {} if i == 0 else {"rear_gouge": 0.5}}  # fmt: skip
        lost = {**counts, "area_share": share}
        witnesses = [witness([0, 0, k], f"F{k + 1}", k) for k in range(faces if i else 0)]
        names = [f"F{k + 1}" for k in range(faces)]
        entry = plan_files.cutter(f"R{i + 1}L80", {}, radius=i + 1.0).model_dump(mode="json")
        return entry | {"feasible": i == 0, "faces": dict.fromkeys(names, lost), "witnesses": witnesses, **lost}

    plan = plan_files.made([plan_files.face(k + 1, area=1.0) for k in range(faces)], [plan_files.cutter("R1L80", {})])
    data = plan.model_dump(mode="json") | {"cutters": [of(i) for i in range(cutters)]}
    data["samples"] |= {"count": 4 * faces}
    for each in data["faces"]:
        each["samples"] = 4
    return data | {"selected": None, "notes": ["a"], "note_codes": ["no_holder"], **more}


def witness(point, face, depth_mm, reason="rear_gouge", obstacle_face="F1"):
    return {"sample": 0, "point": point, "face": face, "reason": reason, "obstacle_face": obstacle_face, "obstacle_point": None,
            "best_posture": None, "depth_mm": depth_mm}  # fmt: skip


def change(thing, why, **more):
    """A change of one thing, or a move of a step."""
    unknown = dict.fromkeys(("helps", "now", "asked", "beyond", "cutter"))
    return {"thing": thing, **unknown, "left": 0, "looked": 0, "verified": 0, "why": why, **more}


def read(**more):
    return with_text(plan_of(json.dumps(made_plan(**more)), "plan.json", CallError))


def cut(answer, most):
    """An answer as it is handed over, its lists cut."""
    return short(answer.model_dump(mode="json"), dict.fromkeys(LISTS, most))


@settings(max_examples=12, deadline=None)
@given(st.integers(1, 90), st.integers(1, 60), st.integers(6_000, 60_000))
def test_an_answer_is_short_and_says_how_much_it_leaves_out(cutters, faces, characters):
    plan = read(cutters=cutters, faces=faces)
    for answer in (planned(plan, 0, {}), compared(plan, 0)):
        found = fitting(answer, characters)
        assert len(json.dumps(found, separators=(",", ":"))) <= characters
        assert len(found["cutters"]) + found["more_cutters"] == cutters
        for each in found["cutters"]:
            assert len(each["faces"]) + each["more_faces"] == (0 if each["id"] == "R1L80" else faces)
        if "differ" in found:
            assert len(found["differ"]) + found["more_differ"] == (faces if cutters > 1 else 0)


def test_an_answer_that_cannot_be_short_is_refused():
    with pytest.raises(CallError, match="even without its lists"):
        fitting(planned(read(), 0, {}), 300)


@given(st.floats(0.0, 1.0, exclude_min=True, exclude_max=True), st.floats(1e-6, 1e6))
def test_a_short_number_is_near_and_never_all_nor_nothing(share, length):
    """A share is neither 0 nor 1 where it is not; a clearance is never told larger than it is."""
    found = short({"reached": share, "clearance_mm": length, "list": [{"undecided": share}]})
    assert 0.0 < found["reached"] < 1.0
    assert found["list"][0]["undecided"] == found["reached"] == pytest.approx(share, rel=1e-3)
    assert length * 0.998 <= found["clearance_mm"] <= length
    assert {float(f"{each:.4g}") for each in (found["reached"], found["clearance_mm"])} == {
        found["reached"],
        found["clearance_mm"],
    }


def test_what_is_handed_back_or_would_be_wider_stays_as_it_is():
    exact = {"angles": {"C": 123.456789}, "axis": [0.123456789, 0.0, 0.99234567], "free": [[12.3456, 78.9012]],
             "undecided": [[1.23456, 2.34567]], "forbidden": {"holder": [[1.23456, 2.34567]]}}  # fmt: skip
    assert short(exact) == exact
    assert short({"forbidden": {"holder": 0.123456}, "point": [1234.56789, 0.0, -1.0]}) == {
        "forbidden": {"holder": 0.1235}, "point": [1234.5679, 0.0, -1.0],
    }  # fmt: skip


def test_progress_has_a_total_where_the_rest_is_known():
    """The lines of the command, as it writes them where there is no terminal."""
    told = []

    async def tell(seconds, words, rest=None):
        told.append((seconds, words, rest))

    lines = b"    0.8 s  starting\n   12.5 s  judging R6L80 (1 of 2), 40 %, about 18 s left\nplan-cutters: not read\n"
    anyio.run(child._listen, io.BytesIO(lines), bytearray(), tell)
    assert told == [(0.8, "starting", None), (12.5, "judging R6L80 (1 of 2), 40 %", 18.0)]


def test_silence_is_not_an_answer():
    """A face that nobody sampled is neither reached nor lost; obstacles that are missing make a yes unsure."""
    plan = read()
    first, second = plan.cutters[:2]
    assert explained(plan, first, "F1").reached is True
    assert explained(plan, second, "F1").reached is False
    missing = read(missing=[{"face": "F9", "entity": None, "name": "", "why": "not meshed", "stand_in": "none"}])
    assert explained(missing, missing.cutters[0], "F1").reached is None
    bare = made_plan()
    bare["faces"][0] |= {"unjudged": "no normal"}
    del bare["cutters"][0]["faces"]["F1"]
    plan = Plan.model_validate(bare)
    found = explained(plan, plan.cutters[0], "F1")
    assert (found.reached, found.told) == (None, "F1 could not be judged: no normal.")
    bare["faces"][0] |= {"target": False}
    plan = Plan.model_validate(bare)
    with pytest.raises(CallError, match="obstacle only"):
        explained(plan, plan.cutters[0], "F1")


def test_the_deepest_witness_comes_first_and_with_a_point_the_nearest():
    data = made_plan(faces=1)
    data["cutters"][1]["witnesses"] = [
        witness([x, 0, 0], "F1", depth, reason="collision", obstacle_face=None) for x, depth in ((0, 1), (5, 3), (9, None))
    ]
    plan = with_text(Plan.model_validate(data))
    assert [w["point"][0] for w in explained(plan, plan.cutters[1], "F1").witnesses] == [5, 0, 9]
    found = cut(explained(plan, plan.cutters[1], "F1", point=(8.0, 0.0, 0.0)), 2)
    assert ([w["point"][0] for w in found["witnesses"]], found["more_witnesses"]) == ([9, 5], 1)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"format_version": 2}, "has format version 2"),
        ({"format": "x"}, "no plan of plan-cutters"),
        ({"cutters": []}, "cutters: "),
        ({"faces": 3}, "faces: "),
    ],
)
def test_what_is_no_plan_is_refused(change, words):
    with pytest.raises(CallError, match=words):
        plan_of(json.dumps(made_plan() | change), "plan.json", CallError)


def test_a_cutter_is_meant_by_the_beginning_of_its_name():
    known = [
        ("R6L80F30", "flat"),
        ("R6L80rc1F30", "bull"),
        ("R6.5L80", ""),
        ("R60L90", ""),
        ("R2L9rc1", "mould"),
        ("R3L9rc1", "mould"),
    ]
    assert chosen("R6", known) == chosen("R6L80", known) == "R6L80F30"
    assert chosen("r60", known) == "R60L90"
    assert chosen("bull", known) == "R6L80rc1F30"
    for name, why in (("mould", "2 cutters may be meant"), ("R7", "no cutter is called"), ("R6L8", "no cutter")):
        with pytest.raises(CallError, match=why):
            chosen(name, known)


def test_cutters_are_named_by_the_words_that_were_given():
    data = made_plan(cutters=2, selected=None)
    for entry in data["cutters"]:
        entry["name"] = f"D{2 * int(entry['id'][1])}L80"
    lost = data["cutters"][1]
    step = {"changes": [{"thing": "cutter", "now": None, "asked": "R1L80", "why": "R1L80"}], "lost_before": 0.5,
            "lost_after": 0.0, "gained": 8, "left": 0, "cutters": [], "setups": [], "option": "--cutter D3L80",
            "why": "R1L80 for the rest", "remains": []}  # fmt: skip
    lost["mend"] = {"lost": 8, "buried": 0, "why": "", "steps": [step]}
    data["selected"] = "R1L80"
    plan = with_text(Plan.model_validate(data))
    found = planned(plan, 0, {})
    said = (
        f"Take flat end D2 x 80: it finishes all 4 mm². For part.step, {size(plan.part.size_mm)}: D2L80, judged without a "
        "holder, 80 mm up from its tip."
    )
    assert " ".join(found.told.split()).startswith(said)
    assert [c["id"] for c in found.cutters] == ["R1L80", "R2L80"]
    said = explained(plan, plan.cutters[1], "F1")
    assert [each["what"] for each in said.would_help] == ["flat end D2 x 80 for the rest"]
    assert said.told.startswith("flat end D4 x 80 does not reach 50 % of F1 (2 samples): rear gouge 50 %.")
    assert "R2L80" not in said.told
    lost["mend"] |= {"unsure": True}
    plan = with_text(Plan.model_validate(data))
    assert [each["finishes"] for each in explained(plan, plan.cutters[1], "F1").would_help] == [None]


@given(st.floats(0, 1))
def test_a_share_in_words_is_neither_none_nor_all_where_something_is_left(share):
    said = percent(share)
    assert (said == "0 %") == (share == 0)
    assert (said == "100 %") == (share == 1)


def test_a_path_counts_by_where_it_ends(tmp_path):
    for name in ("in", "in/deep", "out"):
        (tmp_path / name).mkdir()
    for name in ("in/a", "in/deep/b", "out/c"):
        (tmp_path / name).write_text("x")
    (tmp_path / "in/up").symlink_to(tmp_path / "out")
    (tmp_path / "in/back").symlink_to(tmp_path / "in/deep")
    (tmp_path / "in/round").symlink_to(tmp_path / "in/round")
    roots = Roots.of([tmp_path / "in"])
    for name in ("a", "deep/../a", "back/b", str(tmp_path / "in/a"), str(tmp_path / "out/../in/a"), "new/folder"):
        assert roots.confined(name).is_relative_to(tmp_path / "in")
    for name in (
        "../out/c",
        "up/c",
        "up/new",
        str(tmp_path / "out/c"),
        str(tmp_path),
        "back/../../a/../../out",
        f"{tmp_path}/inside",
    ):
        with pytest.raises(CallError, match="outside the roots"):
            roots.confined(name)
    with pytest.raises(CallError):
        roots.file("round", 1)
    with pytest.raises(CallError, match="there is no root"):
        Roots(()).confined("a")
    with pytest.raises(CallError, match="is no folder"):
        Roots.of([tmp_path / "in/a"])
    uris = [f"file://{tmp_path}/in", f"file://{tmp_path}/none", "https://host/x", "file://other/x", f"file://{tmp_path}/in/a"]
    assert Roots.of_client(uris) == roots


@pytest.mark.parametrize("mode", ["auto", "legacy"])
@pytest.mark.parametrize(("own", "more", "offered", "allowed"), [
    (False, False, True, True),   # without roots of its own, the client's count
    (True, False, True, False),   # with them, a client cannot widen them
    (True, True, True, True),     # unless the one who starts the server says so
    (False, False, False, False),
])  # fmt: skip
def test_roots_of_the_client(tmp_path, mode, own, more, offered, allowed):
    (tmp_path / "own").mkdir()
    (tmp_path / "theirs").mkdir()
    (tmp_path / "theirs/plan.json").write_text(json.dumps(made_plan()))
    server = made(service_of([str(tmp_path / "own")] if own else [], Limits(), client_roots=more))

    async def roots(context):
        return types.ListRootsResult(roots=[types.Root(uri=f"file://{tmp_path}/theirs")])

    async def asked():
        async with Client(server, mode=mode, list_roots_callback=roots if offered else None) as client:
            question = {"plan": str(tmp_path / "theirs/plan.json"), "cutter": "R2", "face": "F1"}
            return await client.call_tool("explain_sample", question)

    found = anyio.run(asked)
    assert found.is_error is not allowed
    if allowed:
        assert found.structured_content["reasons"][0]["code"] == "rear_gouge"
    else:
        assert ("outside the roots" if own else "there is no root") in found.content[0].text


def test_a_missing_extra_and_a_wrong_root_are_one_line(monkeypatch, tmp_path):
    def said(*words):
        with pytest.raises(Exception) as error:  # noqa: PT011
            CliRunner().invoke(command.command, words, catch_exceptions=False)
        return str(error.value)

    assert said("--root", str(tmp_path / "none")).endswith("is no folder; give one with --root")
    monkeypatch.setattr(command, "find_spec", lambda name: None)
    assert said() == 'the extra is not installed: pip install ".[mcp]" in the folder of plan-cutters'


def test_whoever_runs_a_service_allows_fewer_samples(monkeypatch):
    from plan_cutters.errors import OptionError
    from plan_cutters.scene.preparation import MOST, affordable

    part, asked = SimpleNamespace(file="part.step"), SimpleNamespace(grid=100, spacing=None)
    assert child._environment(Limits(most_samples=9_999), [])[MOST] == "9999"
    affordable(part, [1], asked)
    for said, why in (
        ("9999", "at most 1e\\+04 are taken"),
        ("many", "must be a whole number"),
        ("-1", "must be a whole number"),
    ):
        monkeypatch.setenv(MOST, said)
        with pytest.raises(OptionError, match=why):
            affordable(part, [1], asked)
    monkeypatch.setenv(MOST, "10000")
    affordable(part, [1], asked)


def test_an_internal_error_is_one_line(monkeypatch):
    from plan_cutters_agents import server as module

    def broken(*_):
        raise RuntimeError("a\nb")

    monkeypatch.setattr(module, "_question", broken)
    service = module.Service(Roots(()), Limits(), client_roots=False)
    found = anyio.run(service.call_tool, None, SimpleNamespace(name="render", arguments={}))
    assert (found.is_error, found.content[0].text) == (True, "internal error (RuntimeError: a b)")


def test_steps_are_told_in_the_words_in_which_they_are_given_back():
    """A step that is cut says so; a step of the planner's carries what it leaves; an axis is told where there are no angles."""
    left = {"cause": "orientation", "area_mm2": 3.0, "share": 0.1, "samples": 2, "faces": ["F2", "F1"], "place_mm": None}
    own = {"number": 1, "asked_mm2": 20.0, "leaves": [left] * 3,
           "nearest": {"angles_deg": {"C": 0.0, "A": 90.0}, "axis": [0, -1, 0], "area_mm2": 3.0}}  # fmt: skip
    step = {"setup": 1, "mode": "fixed", "angles_deg": {"C": 0.0, "A": 10.0}, "axis": [0, 0, 1], "cutter": "R1L80",
            "faces": ["F1", "F2"], "area_mm2": 17.0, "share": 0.85, "seconds": 4.0, "clearance_mm": 1.0, "alone_mm2": 6.0,
            "own": own}  # fmt: skip
    planned_step = {**step, "setup": 0, "mode": "any", "angles_deg": None, "axis": None, "own": None, "alone_mm2": None}
    process = {"steps": [step, planned_step], "finished_share": 0.85, "finished_mm2": 17.0, "asked_mm2": 20.0, "left": [left],
               "seconds": 9.0}  # fmt: skip
    found = cut(planned(read(process=process), 1, {}), 1)
    (first,) = found["steps"]
    assert (found["more_steps"], found["asked_mm2"], found["finished_share"], found["seconds"]) == (1, 20.0, 0.85, 9.0)
    assert (first["setup"], first["angles"], first["axis"]) == (2, {"C": 0.0, "A": 10.0}, None)
    assert (first["faces"], first["more_faces"]) == (["F1"], 1)
    assert (first["alone_mm2"], first["own"]["number"], first["own"]["more_leaves"]) == (6.0, 1, 2)
    assert (first["own"]["leaves"][0]["faces"], first["own"]["leaves"][0]["more_faces"]) == (["F2"], 1)
    assert first["own"]["nearest"]["angles"] == {"C": 0.0, "A": 90.0}
    assert planned(read(process=process), 1, {}).steps[1]["own"] is None
