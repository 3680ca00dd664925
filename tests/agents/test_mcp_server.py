"""The server over standard input and output, with the SDK's own client: each tool, refusals, and a call that is cancelled."""

import base64
import contextlib
import functools
import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import CancelledError
from pathlib import Path

import jsonschema
import pytest
from anyio.from_thread import start_blocking_portal
from mcp import Client, StdioServerParameters

from tests.support.forked import ENV
from tests.support.places import SAMPLES

GROOVE, PEAKS = "v_groove.step", "peaks_and_valleys.step"
#: The limit of tilt loses samples, and no library is needed for that.
HELD = {"cutters": ["R6L80"], "machine": "tilt:20", "grid": 5}
NAMES = ["plan_part", "posture_map", "explain_sample", "compare_cutters", "render", "list_tools_and_machines", "compare_plans"]
#: Fields that stay as they are, for they are handed back or must not be wider than they are; and places, in 0.1 um.
EXACT, PLACES = (
    {"axis", "angles", "free", "undecided", "forbidden"},
    {"point", "obstacle_point", "place_mm", "normal", "direction_max"},
)
LIMITS = ("--most-mb", "2", "--most-cutters", "2", "--most-samples", "10000", "--timeout", "200")


def numbers(value, name=""):
    """All numbers of an answer, each with the name of the field that it stands in."""
    if name in EXACT:
        return
    for key, each in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
        yield from numbers(each, key if isinstance(key, str) else name)
    if isinstance(value, float):
        yield name, value


class Server:
    """A running server, whose client lives in a thread of its own."""

    def __init__(self, root, portal, client, tools):
        self.root, self.portal, self.client, self.tools = root, portal, client, tools
        self.told = []

    def begin(self, name, /, **arguments):
        async def tell(done, total, words):
            self.told.append((name, done, words))

        return self.portal.start_task_soon(functools.partial(self.client.call_tool, name, arguments, progress_callback=tell))

    def answer(self, call):
        """The answer of a call, which is as its schema says, and the same as text."""
        found = call.result(200)
        assert not found.is_error, found.content[0].text
        assert json.loads(found.content[0].text) == found.structured_content
        return found.structured_content

    def call(self, name, /, **arguments):
        found = self.answer(self.begin(name, **arguments))
        jsonschema.validate(found, self.tools[name].output_schema)
        assert set(found) == set(self.tools[name].output_schema["properties"])
        for field, number in numbers(found):
            if field not in EXACT | PLACES:
                assert number == float(f"{number:.4g}"), field
        return found

    def refused(self, name, /, **arguments):
        """The line of a call that is refused."""
        found = self.begin(name, **arguments).result(200)
        assert (found.is_error, found.structured_content, len(found.content)) == (True, None, 1)
        (line,) = found.content[0].text.splitlines()
        assert "Traceback" not in line
        return line


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    root = tmp_path_factory.mktemp("root")
    for name in (GROOVE, PEAKS, "shop.toml"):
        (root / name).write_bytes((SAMPLES / name).read_bytes())
    words = ["-m", "plan_cutters", "mcp", "--root", str(root), *LIMITS]
    with start_blocking_portal() as portal, open(os.devnull, "w") as nowhere:
        from mcp.client.stdio import stdio_client

        given = StdioServerParameters(command=sys.executable, args=words, env=given_environment(root), cwd=str(root))
        client = Client(stdio_client(given, errlog=nowhere))
        with portal.wrap_async_context_manager(client):
            listed = portal.call(client.list_tools).tools
            yield Server(root, portal, client, {each.name: each for each in listed})


def given_environment(root):
    return {"PYTHONPATH": ENV["PYTHONPATH"], "PLAN_CUTTERS_CACHE": f"{root}-cache"}


@pytest.fixture(scope="module")
def planned(server):
    """A plan with its files."""
    return server.answer(server.begin("plan_part", part=GROOVE, out="out", formats=["npz"], **HELD))


#: The same without a limit of tilt.
WHOLE = {"part": GROOVE, "cutters": ["R6L80"], "grid": 5, "out": "whole"}


@pytest.fixture(scope="module")
def whole(server):
    return server.call("plan_part", **WHOLE)


@pytest.fixture(scope="module")
def both(server):
    """A plan that is made while another call works: its answer, that of the other one, and how far they said they were."""
    server.told.clear()
    plan = server.begin("plan_part", part=GROOVE, **HELD)
    posture = server.begin("posture_map", part=GROOVE, cutter="R8L90", point=[0, 0, 0], rotation_step_deg=90, picture=True)
    return server.answer(plan), posture.result(200), [*server.told]


def test_the_tools_say_what_they_take_and_give(server):
    assert list(server.tools) == NAMES
    for each in server.tools.values():
        for schema in (each.input_schema, each.output_schema):
            jsonschema.Draft202012Validator.check_schema(schema)
            assert schema["type"] == "object"
        assert each.input_schema["additionalProperties"] is False
        assert each.annotations.read_only_hint is (each.name != "plan_part")


def test_the_list_of_tools_is_short(server):
    """It is read before the first question: 15 kB, names of what a call needs and the words for it included."""
    listed = server.portal.call(server.client.list_tools)
    assert len(listed.model_dump_json(by_alias=True, exclude_none=True).encode()) < 15_000
    for name in ("part", "cutters", "machine", "faces", "setup", "process", "operations", "out"):
        assert server.tools["plan_part"].input_schema["properties"][name]["description"], name
    shared = server.tools["compare_cutters"].input_schema["properties"]
    assert shared["cutters"] == {"type": "array", "items": {"type": "string"}}
    assert set(shared) < set(server.tools["plan_part"].input_schema["properties"])


@pytest.mark.slow("starts servers or clusters")
def test_two_calls_work_at_once_and_tell_how_far_they_are(both):
    told = [name for name, _, _ in both[2]]
    assert set(told) >= {"plan_part", "posture_map"}
    # The one began before the other had ended.
    assert told.index("posture_map") < max(i for i, name in enumerate(told) if name == "plan_part")
    seconds = [done for name, done, _ in both[2] if name == "plan_part"]
    assert seconds == sorted(set(seconds))
    assert any("judging" in words for _, _, words in both[2])


@pytest.mark.slow("plans whole parts")
def test_a_plan_is_what_its_file_says(server, planned):
    found, plan = planned, json.loads((server.root / "out/plan.json").read_text())
    assert found["exit_code"] == 1
    assert found["selected"] is plan["selected"] is None
    (mine,), (cutter,) = found["cutters"], plan["cutters"]
    assert mine["lost_by"] == pytest.approx(cutter["area_share"]["lost_by"], rel=1e-3)
    assert mine["reached"] == pytest.approx(
        1 - cutter["area_share"]["inaccessible"] - cutter["area_share"]["undecided"], rel=1e-3
    )
    assert [note["code"] for note in found["notes"]][: len(plan["note_codes"])] == plan["note_codes"]
    assert found["files"] == {
        "json": f"{server.root}/out/plan.json",
        "npz": f"{server.root}/out/samples.npz",
        "process": f"{server.root}/out/process.toml",
    }
    assert sorted(os.listdir(server.root / "out")) == ["plan.json", "process.toml", "samples.npz"]


def test_written_files_are_linked(server, planned):
    reply = server.begin("plan_part", part=GROOVE, out="linked", formats=["json", "html"], **HELD).result(200)
    links = [each for each in reply.content if each.type == "resource_link"]
    files = reply.structured_content["files"]
    assert {each.uri: each.name for each in links} == {Path(file).as_uri(): Path(file).name for file in files.values()}
    assert {each.name: each.mime_type for each in links} == {
        "plan.json": "application/json", "review.html": "text/html", "process.toml": "application/toml",
    }  # fmt: skip
    for each in links:
        assert each.size == (server.root / "linked" / each.name).stat().st_size
    nothing = server.begin("compare_plans", old="linked/plan.json", new="out/plan.json").result(200)
    assert [each.type for each in nothing.content] == ["text"]


@pytest.mark.slow("starts a server")
def test_two_plans_are_compared(server, planned, whole):
    """The groove with a shorter limit of tilt is another question."""
    found = server.call("compare_plans", old="whole/plan.json", new="out/plan.json")
    assert (found["comparable"], found["lost"], found["faces"]) == (False, None, [])
    assert any("machine differs" in line for line in found["why_not"])
    same = server.call("compare_plans", old="whole/plan.json", new="whole/plan.json")
    assert (same["comparable"], same["lost"], same["won"], same["faces"], same["cutters"]) == (True, False, False, [], [])
    assert "lies outside the roots" in server.refused("compare_plans", old="whole/plan.json", new="/etc/passwd")


@pytest.mark.slow("plans twice")
def test_what_one_plan_wins_the_other_one_loses(server):
    server.answer(server.begin("plan_part", part=GROOVE, cutters=["R6L80"], grid=5, out="flat"))
    server.answer(server.begin("plan_part", part=GROOVE, cutters=["R6L80rc6"], grid=5, out="ball"))
    back, forth = (server.call("compare_plans", old=f"{a}/plan.json", new=f"{b}/plan.json", **{})
                   for a, b in (("flat", "ball"), ("ball", "flat")))  # fmt: skip
    if back["comparable"]:
        assert (back["lost"], back["won"]) == (forth["won"], forth["lost"])


def test_tools_and_machines_are_listed(server):
    from plan_cutters.domain.machine import builtin_machines
    from plan_cutters.domain.standard_tools import builtin

    found = server.call("list_tools_and_machines")
    assert [each["id"] for each in found["tools"]] + [None] * found["more_tools"] == [
        each.id for each in builtin()[: len(found["tools"])]
    ] + [None] * (len(builtin()) - len(found["tools"]))
    assert {each["name"] for each in found["machines"]} == {*builtin_machines()}
    assert next(each for each in found["machines"] if each["name"] == "trunnion-ac")["axes"] == ["C", "A"][::-1]
    mine = server.call("list_tools_and_machines", library="shop.toml", machines=False)
    assert [(each["number"], each["diameter_mm"], each["holder"]) for each in mine["tools"]] == [
        (1, 12.0, "ER32 chuck"), (2, 10.0, "ER32 chuck"), (3, 6.0, "ER32 chuck"),
    ]  # fmt: skip
    assert mine["machines"] == []
    assert "lies outside the roots" in server.refused("list_tools_and_machines", library="/etc/passwd")


@pytest.mark.slow("plans three times")
def test_one_spacing_makes_the_samples_of_all_calls_the_same(server):
    """By default the smallest cutter decides: then the answers say that their samples differ."""
    fine, coarse = ({"cutters": [name], "part": GROOVE} for name in ("R4L60", "R12L60"))
    spacings = [
        server.call("plan_part", **each)["samples"]
        for each in (coarse, {**coarse, "spacing_mm": 6.0}, {**fine, "spacing_mm": 6.0})
    ]
    default, one, other = spacings
    assert (default["sampled_by"], one["sampled_by"]) == ("default", "spacing")
    assert default["spacing_mm"] == 3.0  # a quarter of the radius
    assert one == other
    assert one["spacing_mm"] == 6.0


@pytest.mark.slow("starts a server")
def test_a_second_call_takes_what_the_first_one_made_of_the_part(server, whole):
    cache = Path(f"{server.root}-cache")

    def stored():
        return {path: path.stat().st_ino for path in cache.rglob("*.stage")}

    before = stored()
    assert before
    second = server.call("plan_part", **WHOLE)
    assert second["cutters"] == whole["cutters"]
    # A file that is written again is another one.
    assert before.items() <= stored().items()


@pytest.mark.slow("plans each proposed clamping")
def test_a_map_is_answered_with_its_picture(both):
    _, reply, _ = both
    found = reply.structured_content
    assert (found["cutter"], found["postures"]["face"], found["exit_code"]) == ("R8L90", "F2", 0)
    shares = found["postures"]
    assert 0 < shares["free_share"] < 1
    width = sum(high - low for row in shares["rotations"] for low, high in row["free"]) / 90 / len(shares["rotations"])
    assert shares["free_share"] == pytest.approx(width, abs=1e-3)
    assert base64.b64decode(reply.content[1].data).startswith(b"\x89PNG")


def test_a_plan_that_is_there_is_explained_by_face_and_by_point(server, planned):
    plan = json.loads((server.root / "out/plan.json").read_text())
    (cutter,) = plan["cutters"]
    face = max(cutter["faces"], key=lambda name: cutter["faces"][name]["area_share"]["inaccessible"])
    found = server.call("explain_sample", plan="out/plan.json", cutter="R6", face=face)
    assert (found["cutter"], found["face"], found["reached"]) == ("R6L80", face, False)
    assert {each["code"]: each["share"] for each in found["reasons"]} == pytest.approx(
        cutter["faces"][face]["area_share"]["lost_by"], rel=1e-3
    )
    assert found["no_help"].startswith("the plan was made without --answers mend")
    witness = next(each for each in cutter["witnesses"] if each["face"] == face)
    at = server.call("explain_sample", plan="out/plan.json", cutter="R6", point=witness["point"])
    assert at["sample"]["distance_mm"] == pytest.approx(0.0, abs=1e-9)
    assert (at["sample"]["verdict"], at["sample"]["reason"]) == (witness["verdict"], witness["reason"])
    assert at["witnesses"][0]["point"] == pytest.approx(witness["point"], abs=1e-4)
    assert "mm from the point" in server.refused("explain_sample", plan="out/plan.json", cutter="R6", point=[0, 0, 900])
    assert "no cutter is called 'R5'" in server.refused("explain_sample", plan="out/plan.json", cutter="R5", face=face)
    assert "there is no such face" in server.refused("explain_sample", plan="out/plan.json", cutter="R6", face="F99")


@pytest.mark.slow("starts a server")
def test_why_not_and_what_would_help_is_one_call(server):
    found = server.call("explain_sample", part=PEAKS, cutter="R8L90", face="F1", grid=9)
    assert found["reached"] is False
    assert sum(each["share"] for each in found["reasons"]) == pytest.approx(found["lost_share"], rel=1e-3)
    assert found["help_is_about"] == "this face"
    best = found["would_help"][0]
    assert best["lost_after"] < best["lost_before"] == pytest.approx(found["lost_share"], rel=1e-3)
    assert best["option"].startswith("--cutter R")
    for word in ("flat end D16 x 90 does not reach", "F1", "rear gouge", "What would help: ", best["option"]):
        assert word in found["told"]


@pytest.mark.slow("starts servers or clusters")
def test_cutters_are_compared_on_the_faces_on_which_they_differ(server):
    found = server.call("compare_cutters", part=PEAKS, cutters=["R12L90", "R4L90"], grid=7)
    assert [each["id"] for each in found["cutters"]] == ["R4L90", "R12L90"]
    (row,) = found["differ"]
    assert row["reached"] == {each["id"]: pytest.approx(each["reached"]) for each in found["cutters"]}
    assert "one cutter is compared with nothing" in server.refused("compare_cutters", part=PEAKS, cutters=["R4L90"])


@pytest.mark.slow("starts servers or clusters")
def test_a_picture_is_rendered_and_nothing_is_left(server):
    before = sorted(os.listdir(server.root))
    reply = server.begin("render", part=GROOVE, **HELD).result(200)
    assert not reply.is_error
    assert reply.structured_content["shown"] == "R6L80"
    assert base64.b64decode(reply.content[1].data).startswith(b"\x89PNG")
    assert sorted(os.listdir(server.root)) == before


def test_what_lies_outside_is_refused(server, tmp_path):
    (tmp_path / "plan.json").write_text("{}")
    os.symlink(tmp_path, server.root / "away")
    os.symlink(SAMPLES / GROOVE, server.root / "link.step")
    try:
        for name in ("/etc/passwd", "../x.step", "away/plan.json", "link.step", str(SAMPLES / GROOVE), f"./../{SAMPLES.name}/x"):
            assert "lies outside the roots" in server.refused("plan_part", part=name), name
            assert "lies outside the roots" in server.refused("explain_sample", plan=name, cutter="R6", face="F1"), name
        for word in ("out", "library", "holder", "machine"):
            assert "lies outside the roots" in server.refused("plan_part", part=GROOVE, **{word: "away/x.toml"}), word
        assert "lies outside the roots" in server.refused("plan_part", part=GROOVE, fixtures=["../vise.stl@0,0,-20"])
    finally:
        (server.root / "away").unlink()
        (server.root / "link.step").unlink()


def test_what_is_wrong_or_too_large_is_one_line(server):
    with open(server.root / "huge.step", "wb") as file:
        file.truncate(3_000_000)
    os.mkfifo(server.root / "pipe.step")
    (server.root / "none.json").write_text('{"format": "plan-cutters-plan"}')
    assert "at most 2 MB" in server.refused("plan_part", part="huge.step")
    assert "is no file" in server.refused("plan_part", part="pipe.step")
    assert "no such file" in server.refused("plan_part", part="none.step")
    assert "is no name of a file" in server.refused("plan_part", part="a\0b")
    assert "at most 2 in a call" in server.refused("plan_part", part=GROOVE, cutters=["R1L20"] * 4)
    assert "is a root itself" in server.refused("plan_part", part=GROOVE, out=".")
    assert "no plan of plan-cutters" in server.refused("explain_sample", plan="none.json", cutter="R6", face="F1")
    assert "either `face` or `point`" in server.refused("explain_sample", part=GROOVE, cutter="R6L80")
    assert "cuters: Extra inputs" in server.refused("plan_part", part=GROOVE, cuters=["R6L80"])
    assert "there is no tool 'plan'" in server.refused("plan", part=GROOVE)
    assert "lists 3 cutters, and this server judges at most 2" in server.refused("plan_part", part=GROOVE, library="shop.toml")
    (server.root / "bad.step").write_text("no part")
    assert server.refused("plan_part", part="bad.step").startswith(f"{server.root}/bad.step: ")


def running(root):
    """Numbers of processes that work for this root, but for the server's own."""
    found = []
    for each in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words = each.read_bytes().decode(errors="replace").split("\0")
        except OSError:
            continue
        if any(str(root) in word for word in words) and "mcp" not in words:
            found.append(int(each.parent.name))
    return found


@pytest.mark.skipif(not Path("/proc/self/cmdline").exists(), reason="processes are looked up as Linux lists them")
def test_a_cancelled_call_ends_its_process_and_leaves_no_file(server):
    before = sorted(os.listdir(server.root))
    server.told.clear()
    call = server.begin("plan_part", part=GROOVE, cutters=["R6L80"], grid=41, out="never", formats=["step", "html"])
    until(lambda: any(words == "starting" for _, _, words in server.told) and running(server.root))
    call.cancel()
    with pytest.raises(CancelledError):
        call.result(60)
    until(lambda: not running(server.root))
    assert sorted(os.listdir(server.root)) == before
    assert server.call("explain_sample", plan="out/plan.json", cutter="R6", face="F1")["format_version"] == 1


@pytest.mark.slow("starts a server and ends a process of it")
@pytest.mark.skipif(not Path("/proc/self/cmdline").exists(), reason="processes are looked up as Linux lists them")
def test_a_crash_of_the_kernel_is_an_error_of_one_call(server):
    call = server.begin("plan_part", part=GROOVE, cutters=["R6L80"], grid=61)
    until(lambda: len(running(server.root)) == 2)  # the command, and the child that it guards
    os.kill(max(running(server.root)), signal.SIGSEGV)
    found = call.result(200)
    assert found.is_error
    assert "the CAD kernel crashed (SIGSEGV" in found.content[0].text
    assert server.call("plan_part", part=GROOVE, cutters=["R6L80"], grid=3)["selected"] == "R6L80"


@pytest.mark.slow("judges a map of many postures")
def test_a_point_of_a_part_is_explained_with_all_its_postures(server):
    found = server.call("explain_sample", part=PEAKS, cutter="R8L90", point=[0, 0, -21.9], within_mm=5, grid=9)
    assert found["postures"]["face"] == found["face"] == "F1"
    assert found["witnesses"]
    assert found["told"].startswith("At the point, on F1, ")
    assert "10000" in LIMITS
    assert "at most 1e+04 are taken" in server.refused("plan_part", part=GROOVE, cutters=["R6L80"], grid=200)


def until(holds, seconds=60.0):
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.05)


def test_nothing_but_the_protocol_is_on_standard_output(tmp_path):
    """A client that goes away ends the server; a line that is no message is answered as one, or not at all."""
    done = subprocess.run(
        [sys.executable, "-m", "plan_cutters", "mcp", "--root", str(tmp_path)], input="no message\n", env=ENV,
        capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert done.returncode == 0
    for line in done.stdout.splitlines():
        assert json.loads(line)["jsonrpc"] == "2.0"


@contextlib.contextmanager
def greeted(root):
    """A server of which nothing but the greeting was asked."""
    words = [sys.executable, "-m", "plan_cutters", "mcp", "--root", str(root)]
    hello = {"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": {
        "protocolVersion": "2025-06-18", "capabilities": {}, "clientInfo": {"name": "test", "version": "1"}}}  # fmt: skip
    pipe = subprocess.PIPE
    with subprocess.Popen(words, stdin=pipe, stdout=pipe, stderr=pipe, env=ENV, text=True) as process:
        print(json.dumps(hello), file=process.stdin, flush=True)
        assert json.loads(process.stdout.readline())["result"]["serverInfo"]["name"] == "plan-cutters"
        yield process


def test_a_signal_ends_a_server_that_waits_for_its_client(tmp_path):
    """The client holds standard input open, and says nothing."""
    with greeted(tmp_path) as process:
        process.terminate()
        assert process.wait(30) == 130


def test_a_client_that_is_killed_ends_the_server_without_a_word(tmp_path):
    """Its end of standard output is closed, and an answer to its last question finds nobody."""
    with greeted(tmp_path) as process:
        process.stdout.close()
        print(json.dumps({"jsonrpc": "2.0", "method": "notifications/initialized"}), file=process.stdin)
        print(json.dumps({"jsonrpc": "2.0", "id": 2, "method": "tools/list"}), file=process.stdin, flush=True)
        process.stdin.close()
        assert process.wait(30) == 0
        assert process.stderr.read() == ""


@pytest.mark.slow("starts servers or clusters")
def test_what_a_file_in_the_root_names_outside_says_nothing(server):
    """A library's bits, and what a machine includes: each leads out of the root."""
    outside = server.root.parent / f"{server.root.name}-outside"
    (outside / "Bit").mkdir(parents=True)
    bit = {"shape": "endmill.fcstd", "name": "secret bit", "parameter": {"Diameter": "furlongs"}}
    (outside / "Bit/bit.fctb").write_text(json.dumps(bit))
    (outside / "secret.inc").write_text("[TRAJ]\nLINEAR_UNITS = furlongs\n")
    names = {"lib.fctl": json.dumps({"tools": [{"nr": 1, "path": "bit.fctb"}], "version": 1}),
             "m.ini": f"#INCLUDE ../{outside.name}/secret.inc\n[KINS]\nKINEMATICS = xyzac-trt-kins\nJOINTS = 5\n"}  # fmt: skip
    for name, text in names.items():
        (server.root / name).write_text(text)
    (server.root / "Bit").symlink_to(outside / "Bit")
    said = [
        server.refused("plan_part", part=GROOVE, library="lib.fctl"),
        server.refused("plan_part", part=GROOVE, cutters=["R6L80"], machine="m.ini"),
    ]
    assert not any(word in line for line in said for word in ("secret bit", "furlongs"))
    assert "its bit is neither" in said[0]
    assert all("outside the folders that may be read" in line for line in said[1:])


#: The groove, with operations of one machine.
STEPPED = {"cutters": ["R3L60"], "machine": "trunnion-ac", "feed_mm_min": 1000.0, "spacing_mm": 8.0}


@pytest.mark.slow("starts servers or clusters")
def test_steps_of_an_answer_are_edited_and_judged_again(server):
    """What the first answer proposes is handed back: the same is finished; on fewer faces, a step does just these."""
    first = server.answer(server.begin("plan_part", part=GROOVE, operations="fastest", **STEPPED))
    steps = first["steps"]
    assert steps
    assert sum(each["area_mm2"] for each in [*steps, *first["left"]]) == pytest.approx(first["asked_mm2"], rel=1e-3)
    assert sum(each["area_mm2"] for each in steps) == pytest.approx(first["finished_share"] * first["asked_mm2"], rel=1e-3)
    mine = [{name: each[name] for name in ("setup", "mode", "angles", "cutter", "faces", "take")} for each in steps]
    same = server.answer(server.begin("plan_part", part=GROOVE, process={"step": mine, "rest": "leave"}, **STEPPED))
    assert [each["own"]["number"] for each in same["steps"]] == [*range(1, 1 + len(steps))]
    assert same["finished_share"] == pytest.approx(first["finished_share"], abs=0.001)
    one = {"step": [{**mine[0], "faces": ["F1"]}], "rest": "leave", "forbid": [{"cutter": "R3L60", "faces": ["F1"]}]}
    (step,) = server.answer(server.begin("plan_part", part=GROOVE, process=one, **STEPPED))["steps"]
    assert step["own"]["asked_mm2"] < first["asked_mm2"]
    assert step["area_mm2"] == step["alone_mm2"] == pytest.approx(step["own"]["asked_mm2"])


@pytest.mark.slow("starts servers or clusters", only=("process6",))
@pytest.mark.parametrize(
    ("process", "said"),
    [
        ({"step": [{"cutter": "R3L60"}]}, "process: step 1: angles are missing"),
        ({"step": [{"angles": {"C": 0, "A": 0}}]}, "process: step 1: cutter is missing"),
        ({"step": [{"cutter": "R3L60", "mode": "simultaneous", "faces": []}]}, "process: step 1: faces is"),
        ({"rest": "leave"}, "process: has no step"),
        ("process.toml", "process: "),
        ({"step": [{"cutter": "R9L60", "mode": "simultaneous"}]}, "process.json: step 1: cutter 'R9L60'"),
        ({"step": [{"cutter": "R3L60", "mode": "simultaneous", "faces": ["F99"]}]}, "process.json: step 1: faces: F99"),
    ],
)  # fmt: skip
def test_a_wrong_process_is_one_line_with_its_place(server, process, said):
    assert said in server.refused("plan_part", part=GROOVE, process=process, **STEPPED)
