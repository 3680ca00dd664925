"""Files: the same bytes for the same input, the plan safe before the models, and nothing old left without a word."""

import hashlib
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import trimesh
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox

from cad_io.arrays import Style
from cad_io.errors import WriteError
from cad_io.part import Part
from cad_io.split import cut_faces
from cad_io.split.border import CannotSplit
from cad_io.split.pieces import MIXED, split
from cad_io.write import write_gltf
from cad_io.write.step import canonical
from plan_cutters import Cutter, plan
from plan_cutters.report import models
from plan_cutters_base.forks import TimeLimit, limited
from tests.support.forked import run, start
from tests.support.places import ROOT, SAMPLES
from tests.support.split_parts import labels

ENV = {**os.environ, "PYTHONPATH": os.pathsep.join(map(str, (ROOT / "plugin", ROOT)))}


def sha256(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


# ---- the same bytes

ASSEMBLY = """
import sys
blocks = [bytearray(size) for size in range(1, int(sys.argv[2]), 37)]
if int(sys.argv[2]) % 2:
    import scipy.interpolate, trimesh
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
from OCP.gp import gp_Trsf, gp_Vec
from OCP.TopLoc import TopLoc_Location
from cad_io.arrays import Style
from cad_io.kernel.shapes import Node
from cad_io.kernel.shapes import compound
from cad_io.part import Part
from cad_io.split import split
from cad_io.write import write_gltf
from cad_io.write import write_step

def place(k):
    move = gp_Trsf()
    move.SetTranslation(gp_Vec(20.0 * k, 0, 0))
    return TopLoc_Location(move)

boxes = [BRepPrimAPI_MakeBox(10, 5 + k % 3, 5).Solid() for k in range(6)]
part = Part(compound([b.Located(place(k)) for k, b in enumerate(boxes)]))
nodes = [Node(f"box {k}", f"b{k}", place(k), faces=tuple(range(6 * k + 1, 6 * k + 7))) for k in range(6)]
tree = [Node("all", "", TopLoc_Location(), children=tuple(nodes[:4])), *nodes[4:]]
del blocks
found = split(part, [])
style = lambda p: Style(f"F{p.face} it's #9", (p.face % 5 / 5, p.face % 3 / 3, 0.5))
write_step(found, sys.argv[1] + ".step", style, product="p", tree=tree, layers={n: (f"L{n % 2}",) for n in range(1, 37)})
write_gltf(found, sys.argv[1] + ".glb", style, extras=lambda n: {}, piece_extras=lambda p: {})
"""


@pytest.mark.slow("starts commands and ends them on the way")
def test_an_assembly_has_the_same_bytes_in_every_process(tmp_path):
    for name, seed, blocks in (("a", "1", 2), ("b", "22", 70001)):
        subprocess.run([sys.executable, "-c", ASSEMBLY, str(tmp_path / name), str(blocks)], check=True,
                       env={**ENV, "PYTHONHASHSEED": seed}, timeout=120)  # fmt: skip
    for suffix in ("step", "glb"):
        assert len({sha256(path) for path in tmp_path.glob(f"*.{suffix}")}) == 1, suffix


def test_groups_of_styles_follow_what_they_style():
    head = b"DATA;\n#1 = ADVANCED_FACE('F1 #7; it''s',(#2));\n#2 = A();\n#3 = ADVANCED_FACE('',(#2));\n#4 = C();\n#5 = C();\n"
    group = b"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION"
    one = b"#6 = %b('',(#7),#5);\n#7 = STYLED_ITEM('color',(#8),#3);\n#8 = X(#9);\n#9 = RGB('',0.5,1.E-02);\n" % group
    two = b"#10 = %b('',(#11),#4);\n#11 = STYLED_ITEM('color',(#12),\n    #1);\n#12 = X(#9);\n" % group
    # The other way round, the kernel writes what both use below the first of them.
    first = b"#6 = %b('',(#7),#4);\n#7 = STYLED_ITEM('color',(#8),#1);\n#8 = X(#9);\n#9 = RGB('',0.5,1.E-02);\n" % group
    second = b"#10 = %b('',(#11),#5);\n#11 = STYLED_ITEM('color',(#12),#3);\n#12 = X(#9);\n" % group
    end = b"ENDSEC;\nEND-ISO-10303-21;\n"
    found = canonical(head + one + two + end)
    assert found == canonical(head + first + second + end)
    assert b"".join(found.split()) == b"".join((head + first + second + end).split())
    assert canonical(head + end) == head + end
    assert max(map(len, found.splitlines())) <= 100


# ---- what time has to do with it


def spin(seconds):
    began = time.process_time()
    while time.process_time() - began < seconds:
        pass
    return b"done"


@pytest.mark.slow("starts commands and ends them on the way")
def test_processor_time_is_counted_not_the_clocks():
    assert limited(lambda: time.sleep(1.5) or b"slept", 1, processor=True) == b"slept"
    with pytest.raises(TimeLimit):
        limited(lambda: spin(30), 1, processor=True)


@pytest.mark.slow("starts commands and ends them on the way")
def test_a_copy_that_does_nothing_at_all_is_ended(monkeypatch):
    monkeypatch.setattr("plan_cutters_base.forks._ASLEEP", 1)
    began = time.monotonic()
    with pytest.raises(TimeLimit):
        limited(lambda: time.sleep(60) or b"", 100, processor=True)
    assert time.monotonic() - began < 30
    assert limited(lambda: spin(1.5), 100, processor=True) == b"done"


# ---- a face that could not be split


def test_a_face_left_whole_is_one_mesh_of_no_label(tmp_path, monkeypatch):
    def refused(*_):
        raise CannotSplit("forced")

    monkeypatch.setattr(cut_faces, "pieces", refused)
    part = Part(BRepPrimAPI_MakeBox(30, 20, 10).Solid())
    top = next(f.number for f in part.faces if abs(f.area - 600) < 1e-6)
    found = split(part, [labels(part, top, lambda x, y: 1 * (x > 0.52) + (x > 0.52) * (y > 0.31), n=41)])
    assert [p.label for p in found.pieces if p.face == top] == [MIXED]
    write_gltf(found, tmp_path / "p.glb", lambda p: Style(f"F{p.face}_{p.label}", (0.2, 0.2, 0.2)),
               extras=lambda n: {}, piece_extras=lambda p: {})  # fmt: skip
    meshes = trimesh.load(tmp_path / "p.glb").geometry
    assert {name: mesh.area * 1e6 for name, mesh in meshes.items() if name.startswith(f"F{top}_")} == {
        f"F{top}_{MIXED}": pytest.approx(600.0, rel=1e-6)
    }


# ---- the plan first


@pytest.fixture(scope="module")
def result():
    return plan(SAMPLES / "pocket_top.step", cutters=[Cutter.flat(radius=4, length=60)], grid=21, area_budget=0)


def read(out):
    return json.loads((out / "plan.json").read_text())


def check_files(out):
    """The plan lists what is there, and nothing else is."""
    said = {entry["name"]: entry["sha256"] for entry in read(out)["files"].values()}
    assert said == {p.name: sha256(p) for p in out.iterdir() if p.name != "plan.json"}


def test_a_step_that_fails_costs_the_step_alone(result, tmp_path, monkeypatch):
    def fails(*_, **__):
        raise WriteError("the CAD kernel cannot turn the part into STEP", file="x.step")

    monkeypatch.setattr(models, "write_cad", fails)
    document = result.write(tmp_path / "out")
    assert document.not_written == {"step": "the CAD kernel cannot turn the part into STEP"}
    assert sorted(document.files) == ["glb", "html", "npz", "process"]
    assert read(tmp_path / "out")["not_written"] == document.not_written
    check_files(tmp_path / "out")
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


@pytest.mark.parametrize("error", [ValueError("no curve"), MemoryError(), OSError(28, "No space left on device")])
def test_splitting_that_fails_costs_the_models_alone(result, tmp_path, monkeypatch, error):
    def fails(*_, **__):
        raise error

    monkeypatch.setattr(models, "split", fails)
    document = result.write(tmp_path)
    assert sorted(document.not_written) == ["glb", "step"]
    assert all("no curve" in why or "memory" in why or "space" in why for why in document.not_written.values())
    check_files(tmp_path)
    assert sorted(read(tmp_path)["files"]) == ["html", "npz", "process"]


def test_the_plan_is_there_before_the_models_begin(result, tmp_path, monkeypatch):
    real, seen = models.split, []

    def looks(*words, **more):
        check_files(tmp_path)
        seen.append(read(tmp_path))
        return real(*words, **more)

    monkeypatch.setattr(models, "split", looks)
    document = result.write(tmp_path)
    (before,) = seen
    assert sorted(before["files"]) == ["npz", "process"]
    assert sorted(before["not_written"]) == ["glb", "html", "step"]  # the page is made meanwhile
    assert document.not_written == {}
    check_files(tmp_path)
    after = read(tmp_path)
    differs = {key for key in after if after[key] != before[key]}
    assert differs == {"files", "not_written", "split", "run"}
    assert after["run"]["seconds"].keys() - result.plan.run.seconds.keys() == {
        "start",
        "html",
        "npz",
        "process",
        "json",
        "split",
        "glb",
        "step",
    }


def test_files_of_an_earlier_run_are_removed_if_they_are_surely_ours(result, tmp_path):
    result.write(tmp_path)
    (tmp_path / "notes.txt").write_text("mine")
    result.write(tmp_path, ("json", "npz"))
    assert sorted(p.name for p in tmp_path.iterdir()) == ["notes.txt", "plan.json", "process.toml", "samples.npz"]
    result.write(tmp_path)
    (tmp_path / "annotated.step").write_text("edited")
    result.write(tmp_path, ("json",))
    assert sorted(p.name for p in tmp_path.iterdir()) == ["annotated.step", "notes.txt", "plan.json", "process.toml"]
    assert (tmp_path / "annotated.step").read_text() == "edited"
    (tmp_path / "plan.json").write_text('{"format": "other", "files": {"step": {"name": "annotated.step"}}}')
    (tmp_path / "annotated.glb").write_text("whose?")
    result.write(tmp_path, ("json",))
    assert (tmp_path / "annotated.glb").read_text() == "whose?"


def test_a_plan_that_names_files_of_others_removes_none(result, tmp_path):
    out = tmp_path / "out"
    result.write(out, ("json",))
    other = tmp_path / "other.step"
    other.write_text("of others")
    (out / "more.step").write_text("of others")
    said = read(out)
    said["files"] = {n: {"name": name, "sha256": sha256(other)} for n, name in (("a", "../other.step"), ("b", "more.step"))}
    (out / "plan.json").write_text(json.dumps(said))
    result.write(out, ("json",))
    assert other.exists()
    assert (out / "more.step").exists()


# ---- the command


def begun(*words, cwd, out=os.devnull):
    """The command, as far as it has begun to write models, and what it has said until then."""
    process = start(*words, cwd=cwd, out=str(out))
    said = []
    for line in process.stderr:
        said.append(line)
        if "writing the models" in line:
            break
    return process, "".join(said)


WORDS = (
    SAMPLES / "peaks_and_valleys.step",
    "--formats",
    "json,step,glb,npz",
    "--cutter",
    "R4L60",
    "--cutter",
    "R12L120",
    "--grid",
    "41",
    "--area-budget",
    "0",
)


def child_of(process):
    return int(Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()[0])


@pytest.mark.slow("starts commands and ends them on the way", only=("19",))
@pytest.mark.parametrize(("number", "word"), [(signal.SIGSEGV, "SIGSEGV"), (signal.SIGSTOP, "within")])
def test_a_crash_or_hang_while_splitting_costs_the_models_alone(tmp_path, number, word):
    printed = tmp_path.with_suffix(".printed")
    printed.touch()
    process, said = begun(*WORDS, "--read-timeout", "10", "--json", "-", "-o", "out", cwd=tmp_path, out=printed)
    assert "flat end D8 x 60" in said
    os.kill(child_of(process), number)
    _, rest = process.communicate(timeout=120)
    document = read(tmp_path / "out")
    assert process.returncode == (0 if document["selected"] else 1)
    assert "Traceback" not in rest
    assert word in rest.strip().splitlines()[-1]
    assert "annotated.step" in rest
    assert sorted(document["not_written"]) == ["glb", "step"]
    assert all(word in why for why in document["not_written"].values())
    assert json.loads(printed.read_text()) == document
    check_files(tmp_path / "out")
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


@pytest.mark.slow("starts commands and ends them on the way")
def test_an_interrupt_while_splitting_leaves_the_plan(tmp_path):
    process, _ = begun(*WORDS, "-o", "out", cwd=tmp_path)
    process.send_signal(signal.SIGINT)
    _, rest = process.communicate(timeout=120)
    assert process.returncode == 130
    assert "Traceback" not in rest
    assert "interrupted" in rest
    assert "out" in rest.strip().splitlines()[-1]
    assert set(read(tmp_path / "out")["not_written"].values()) <= {"interrupted"}
    check_files(tmp_path / "out")
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


@pytest.mark.slow("starts a command and ends its child on the way")
def test_a_crash_at_one_part_is_not_taken_for_the_end_of_all(tmp_path):
    process, _ = begun(*WORDS, SAMPLES / "v_groove.step", "-o", "out", cwd=tmp_path)
    os.kill(child_of(process), signal.SIGSEGV)
    _, rest = process.communicate(timeout=120)
    assert process.returncode == 3
    assert "not planned" in rest.strip().splitlines()[-1]
    assert "v_groove" in rest.strip().splitlines()[-1]


def test_what_is_old_is_named(tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "merged.glb").write_text("whose?")
    words = [SAMPLES / "pocket_top.step", "--cutter", "R4L60", "--grid", "3", "--area-budget", "0", "--formats", "json",
             "-o", "out"]  # fmt: skip
    done = run(*words, cwd=tmp_path)
    assert "merged.glb" in next(line for line in done.stdout.splitlines() if line.startswith("Left over"))
    assert (tmp_path / "out" / "merged.glb").read_text() == "whose?"


def test_the_summary_names_faces_that_were_not_split(result, monkeypatch):
    from plan_cutters.command.summary import written

    def refused(*_):
        raise CannotSplit("forced")

    monkeypatch.setattr(cut_faces, "pieces", refused)
    found = models.split_result(result)
    document = result.plan.model_copy(update={"split": models.rungs(found)})
    (line,) = [x for x in written(document, Path("missing"), (), verbose=True) if "could not be split" in x]
    assert f"F{next(iter(found.whole))}" in line
    assert "forced" in line
