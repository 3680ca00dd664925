"""Files of fixtures: units, axes, what is refused, and what the command says and writes of them."""

import json

import numpy as np
import pytest
import trimesh

from cad_io import ReadError, read_part
from cad_io.read.mesh import read_mesh, shells
from plan_cutters import Fixture, plan
from plan_cutters.plan_file.reasons import PALETTE
from plan_cutters.report.to_json import schema
from plan_cutters_base.user_files import noted
from tests.support import vises
from tests.support.cad_parts import box, compound
from tests.support.commands import assert_one_line, in_lines, leftovers
from tests.support.forked import run
from tests.support.gltf import read
from tests.support.places import ROOT, SAMPLES

LOW, HIGH = np.array([1.0, 2.0, 3.0]), np.array([5.0, 8.0, 11.0])


def solid(low=LOW, high=HIGH):
    vertex = vises.block(low, high)
    return trimesh.Trimesh(vertex.reshape(-1, 3), np.arange(36).reshape(-1, 3), process=False)


@pytest.mark.parametrize("kind", ["stl", "obj", "ply", "glb"])
@pytest.mark.parametrize(("unit", "scale"), [(None, 1.0), ("in", 25.4), ("cm", 10.0)])
def test_units_and_axes(tmp_path, kind, unit, scale):
    file = tmp_path / f"block.{kind}"
    solid().export(file)
    found = read_mesh(file, unit)
    corners = np.array([found.vertex.min(axis=(0, 1)), found.vertex.max(axis=(0, 1))])
    expected = np.array([LOW, HIGH])
    if kind == "glb":
        # Its Y is up, and it is in metres.
        expected, scale = np.array([[1, -11, 2], [5, -3, 8.0]]), scale if unit else 1000.0
    assert corners == pytest.approx(scale * expected, rel=1e-6)
    assert (found.shells.closed, found.shells.open) == (1, 0)
    assert found.shells.weight.tolist() == [1] * 12
    assert len(found.sha256) == 64
    said = " ".join(found.notes)
    assert ("mm was assumed" in said) == (unit is None and kind != "glb")
    assert ("metres" in said) == (unit is None and kind == "glb")


def test_ascii_stl_and_meshes_of_several_bodies(tmp_path):
    file = tmp_path / "block.stl"
    file.write_text(trimesh.exchange.stl.export_stl_ascii(solid()))
    assert read_mesh(file).shells.closed == 1
    scene = trimesh.Scene()
    scene.add_geometry(solid(np.zeros(3), np.ones(3)), node_name="one")
    scene.add_geometry(
        solid(np.zeros(3), np.ones(3)), node_name="two", transform=[[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    )
    scene.export(tmp_path / "two.glb")
    found = read_mesh(tmp_path / "two.glb")
    assert found.shells.closed == 2
    assert np.ptp(found.vertex, axis=(0, 1)) == pytest.approx([6000, 1000, 1000])


def test_our_own_model_comes_back_where_the_part_is(tmp_path):
    plan(box(40, 30, 20), cutters="R4L12", spacing=10.0, faces="all", area_budget=0).write(tmp_path, ["glb"])
    found = read_mesh(tmp_path / "annotated.glb")
    assert found.vertex.min(axis=(0, 1)) == pytest.approx([0, 0, 0], abs=1e-4)
    assert found.vertex.max(axis=(0, 1)) == pytest.approx([40, 30, 20], abs=1e-3)


def test_what_encloses():
    block = vises.block(LOW, HIGH)
    assert shells(block[:, ::-1]).weight.tolist() == [-1] * 12
    mixed = block.copy()
    mixed[[1, 4, 7]] = mixed[[1, 4, 7], ::-1]
    found = shells(mixed)
    assert (found.closed, found.turned) == (1, 1)
    assert np.flatnonzero(found.weight < 0).tolist() == [1, 4, 7]
    opened = shells(block[1:])
    assert (opened.closed, opened.open, opened.weight.any()) == (0, 1, False)
    # Two that touch along an edge, one apart, and an open one.
    beside = vises.block(LOW + np.array([4, 6, 0]), HIGH + np.array([4, 6, 0]))
    found = shells(np.concatenate([block, beside, block + 50.0, block[1:] - 50.0]))
    assert (found.closed, found.open) == (2, 1)
    assert (found.weight[:36] == 1).all()
    # A corner that is off in its last digits, and triangles without area.
    loose = block + 1e-9 * np.random.default_rng(1).standard_normal(block.shape)
    assert shells(loose).closed == 1
    assert shells(np.concatenate([block, block[:1, [0, 1, 1]]])).closed == 1
    assert shells(np.zeros((3, 3, 3))).closed == 0
    # One side only: a strip with a half turn.
    turn = np.linspace(0, 2 * np.pi, 25)
    rim = [np.stack([(9 + s * np.cos(t / 2)) * np.cos(t), (9 + s * np.cos(t / 2)) * np.sin(t), s * np.sin(t / 2)], axis=1)
           for s, t in ((-2, turn), (2, turn))]  # fmt: skip
    a, b = rim
    strip = np.concatenate([np.stack([a[:-1], a[1:], b[1:]], axis=1), np.stack([a[:-1], b[1:], b[:-1]], axis=1)])
    assert shells(strip).closed == 0


def broken(folder):
    """Files that are no fixture: name, exit code, words."""
    solid().export(folder / "good.stl")
    data = (folder / "good.stl").read_bytes()
    (folder / "short.stl").write_bytes(data[:300])
    (folder / "cut.stl").write_text(trimesh.exchange.stl.export_stl_ascii(solid())[:900])
    (folder / "nan.stl").write_bytes(data[:96] + np.float32("nan").tobytes() + data[100:])
    (folder / "none.stl").write_bytes(bytes(84))
    (folder / "empty.obj").write_bytes(b"")
    (folder / "words.ply").write_bytes(b"Milk\nbread\n")
    (folder / "words.obj").write_bytes(b"Milk\nbread\n")
    trimesh.PointCloud(np.eye(3)).export(folder / "points.ply")
    (folder / "vise.3mf").write_bytes(b"PK\x03\x04")
    (folder / "vise").write_bytes(data)
    (folder / "vise.step").write_bytes(b"This is a shopping list.\n")
    (folder / "folder.stl").mkdir()
    solid(LOW * 1e9, HIGH * 1e9).export(folder / "far.stl")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("missing.stl", "no such file"), ("missing.step", "no such file"), ("short.stl", "is not a whole STL file"),
        ("cut.stl", "is not a whole STL file"),
        ("nan.stl", "corners that are no points"), ("none.stl", "holds no triangles"), ("empty.obj", "is empty"),
        ("words.ply", "is not a whole PLY file"), ("words.obj", "OBJ file|no triangles"), ("points.ply", "holds no triangles"),
        ("vise.3mf", "'.3mf' is no format of fixtures"), ("vise", "does not say its format"),
        ("vise.step", "does not start as STEP"), ("folder.stl", "is a folder"), ("far.stl", "is its unit right"),
    ],
)  # fmt: skip
def test_files_that_are_no_fixture(tmp_path, name, words):
    broken(tmp_path)
    with pytest.raises(ReadError, match=words) as error:
        plan(SAMPLES / "v_groove.step", cutters="R3L40", grid=5, fixtures=str(tmp_path / name), area_budget=0)
    assert "\n" not in str(error.value)
    assert name in str(error.value)


def test_objects_that_are_no_fixture():
    for given in (object(), trimesh.PointCloud(np.eye(3)), trimesh.Trimesh()):
        with pytest.raises(ReadError):
            plan(SAMPLES / "v_groove.step", cutters="R3L40", grid=5, fixtures=[given], area_budget=0)


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["--fixture", "box:0,1,1"], 2, "must be positive"),
        (["--fixture", "vise.stl:inch"], 2, "no length unit is called 'inch'"),
        (["--fixture", "vise.stl"], 3, "vise.stl: no such file"),
        (["--fixture", "table:5"], 2, "fixture:table and the part stand 5 mm deep in each other"),
    ],
)
def test_the_command_refuses_in_one_line(tmp_path, words, code, said):
    done = run(SAMPLES / "pocket_top.step", "--cutter", "R3L40", "--spacing", "6", *words, cwd=tmp_path)
    assert_one_line(done, code, said)
    assert leftovers(tmp_path) == []


def test_the_command_names_and_draws_fixtures(tmp_path):
    solid(np.array([61.0, -5, 0]), np.array([80.0, 45, 70])).export(tmp_path / "jaw.stl")
    done = run(SAMPLES / "pocket_top.step", "--cutter", "R9L40", "--spacing", "3", "--tilt", "0:10", "--area-budget", "0",
               "--formats", "json,glb,merged", "--fixture", "jaw.stl", "--fixture", "table:0",
               "-v", "-o", "out", cwd=tmp_path)  # fmt: skip
    assert done.returncode == 1, done.stderr
    assert "fixture:jaw: STL files name no unit: mm was assumed." in in_lines(done.stdout)
    document = json.loads((tmp_path / "out/plan.json").read_text())
    assert document["effective"]["fixtures"] == ["jaw.stl", "table:0"]
    jaw, table = document["fixtures"]
    assert (jaw["name"], jaw["file"], jaw["unit"], jaw["triangles"], jaw["watertight"]) == (
        "fixture:jaw",
        "jaw.stl",
        "mm",
        12,
        True,
    )
    assert (table["name"], table["file"], table["sha256"]) == ("fixture:table", None, None)
    assert any(w["obstacle_face"] == "fixture:jaw" for w in document["cutters"][0]["witnesses"])
    assert document["cutters"][0]["by_reason"]["fixture"] > 0
    assert document["legend"]["fixture"] == PALETTE["fixture"]
    for model in ("annotated.glb", "merged.glb"):
        found, _ = read(tmp_path / "out" / model)
        nodes = {node["name"]: node for node in found["nodes"]}
        assert [found["nodes"][i]["name"] for i in found["scenes"][0]["nodes"]] == ["part", "fixtures"]
        assert nodes["fixture:jaw"]["extras"]["file"] == "jaw.stl"
        assert {"mesh", "extras"} <= set(nodes["fixture:table"])
        whole = trimesh.load(tmp_path / "out" / model)
        assert np.ptp(whole.bounds, axis=0).max() < 0.2, "the table is drawn as far as the part goes, and a little more"


def test_a_cad_fixture_is_in_the_step_model_in_its_colour(tmp_path):
    held = Fixture(compound(box(10, 50, 15), box(5, 5, 5, (0, 0, 15))), (62, -5, 0, 0, 0, -10), name="jaw")
    result = plan(SAMPLES / "pocket_top.step", cutters="R9L40", spacing=6.0, fixtures=[held, "table:-1"], area_budget=0)
    result.write(tmp_path)
    again = read_part(tmp_path / "annotated.step")
    assert again.solids == result.part.solids + 2
    names = [node.name for root in again.tree for node, _, _ in root.leaves()] + [root.name for root in again.tree]
    assert "fixture:jaw" in names
    blue = tuple(int(PALETTE["fixture"][i : i + 2], 16) / 255 for i in (1, 3, 5))
    coloured = [face for face in again.faces if face.colour == pytest.approx(blue, abs=2e-3)]
    # All twelve faces of both boxes.
    assert sum(face.area for face in coloured) == pytest.approx(2 * (500 + 150 + 750) + 6 * 25)
    assert "Only the GLB model, the review page and pictures show what is no CAD body: fixture:table." in result.plan.notes


def test_the_schema_is_that_of_the_model():
    from pathlib import Path

    import plan_cutters

    stored = json.loads((Path(plan_cutters.__file__).parent / "plan.schema.json").read_text())
    assert stored == schema()


def test_models_with_fixtures_pass_the_khronos_validator(tmp_path):
    import os
    import subprocess

    assert (ROOT / "node_modules" / "gltf-validator").is_dir(), "run: sh setup.sh dev"
    held = [solid(np.array([61.0, 0, 0]), np.array([70.0, 9, 9])), "cylinder:5,20@30,-8,0", "table:0"]
    result = plan(SAMPLES / "pocket_top.step", cutters="R3L40", spacing=6.0, fixtures=held, area_budget=0)
    result.write(tmp_path, ["glb", "merged", "part"])
    shown = {name: {*trimesh.load(tmp_path / f"{name}.glb").geometry} for name in ("merged", "part")}
    # The part alone, for what holds it would hide it.
    assert shown["part"] == {"part"}
    assert len(shown["merged"]) == 1 + len(held)
    whole = trimesh.load(tmp_path / "annotated.glb")
    pieces = [mesh for name, mesh in whole.geometry.items() if name[:1] == "F" and name[1].isdigit()]
    assert trimesh.load(tmp_path / "part.glb").geometry["part"].area == pytest.approx(sum(mesh.area for mesh in pieces), rel=1e-4)
    for name in ("annotated.glb", "merged.glb", "part.glb"):
        done = subprocess.run(
            ["node", str(ROOT / "tests" / "support" / "gltf_validate.js"), str(tmp_path / name)],
            capture_output=True, text=True, check=True, env={**os.environ, "NODE_PATH": str(ROOT / "node_modules")},
        )  # fmt: skip
        issues = json.loads(done.stdout)
        assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues


def test_a_glb_whose_numbers_lie_in_another_file_is_refused_by_the_name_of_that_file(tmp_path):
    """Nothing but the file itself is opened: what lies beside it cannot change unseen."""
    data = trimesh.creation.box((1.0, 1.0, 1.0)).export(file_type="glb")
    size = int.from_bytes(data[12:16], "little")
    head = json.loads(data[20 : 20 + size])
    head["buffers"][0]["uri"] = "box.bin"
    (tmp_path / "box.bin").write_bytes(data[28 + size :])
    text = json.dumps(head).encode()
    text += b" " * (-len(text) % 4)
    parts = (
        b"glTF",
        (2).to_bytes(4, "little"),
        (20 + len(text)).to_bytes(4, "little"),
        len(text).to_bytes(4, "little"),
        b"JSON",
        text,
    )
    (tmp_path / "box.glb").write_bytes(b"".join(parts))
    with noted() as files, pytest.raises(ReadError, match=r"has its numbers in another file \(box\.bin\): export it as one file"):
        read_mesh(tmp_path / "box.glb")
    assert list(files) == [str(tmp_path / "box.glb")]
