"""GLB of split parts: hierarchy, facts, units, axes, linear colours, normals; read by trimesh and as plain JSON."""

import numpy as np
import pytest
import trimesh
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeSphere

from cad_io.arrays import Style
from cad_io.errors import WriteError
from cad_io.part import Part
from cad_io.split import split
from cad_io.write import gltf as module
from cad_io.write.gltf import linear, write_gltf
from tests.support.gltf import read
from tests.support.split_parts import GREEN, GREY, RED, block, labels, largest_bspline

COLOURS = {0: RED, 1: GREEN, -1: GREY}


def write(found, path, **more):
    return write_gltf(
        found,
        path,
        lambda p: Style(f"F{p.face}_{p.label}", COLOURS[p.label], str(p.label)),
        extras=lambda n: {"number": n, "list": [1, None, "é"]},
        piece_extras=lambda p: {"verdict": p.label},
        **more,
    )


@pytest.fixture(scope="module")
def halves():
    part = Part(block(1))
    return part, split(part, [labels(part, largest_bspline(part), lambda x, y: x > 0.4 + 0.3 * y)])


@pytest.fixture(scope="module")
def drawn(halves, tmp_path_factory):
    """The file of them."""
    path = tmp_path_factory.mktemp("halves") / "p.glb"
    assert write(halves[1], path) == ()
    return path


def test_one_node_a_face_and_below_it_one_a_piece(halves, drawn):
    part, found = halves
    document, _ = read(drawn)
    nodes = document["nodes"]
    tops = [nodes[i] for i in nodes[0]["children"]]
    assert [n["name"] for n in tops] == [f.id for f in part.faces]
    assert [n["extras"]["number"] for n in tops] == [f.number for f in part.faces]
    assert tops[0]["extras"]["list"] == [1, None, "é"]
    below = [(n["name"], nodes[i]["name"], nodes[i]["extras"]["verdict"]) for n in tops for i in n["children"]]
    assert below == [(f"F{p.face}", f"F{p.face}_{p.label}", p.label) for p in found.pieces]


def sRGB(light):
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def test_each_colour_is_a_material_in_linear_light(halves, drawn):
    _, found = halves
    document, _ = read(drawn)
    assert [material["name"] for material in document["materials"]] == [
        str(k) for k in dict.fromkeys(p.label for p in found.pieces)
    ]
    for material in document["materials"]:
        surface = material["pbrMetallicRoughness"]
        assert (surface["metallicFactor"], surface["roughnessFactor"], material["doubleSided"]) == (0.0, 0.8, True)
        *light, opaque = surface["baseColorFactor"]
        assert opaque == 1.0
        assert sRGB(np.array(light)) == pytest.approx(COLOURS[int(material["name"])], abs=1e-4)
    for mesh in document["meshes"]:
        (primitive,) = mesh["primitives"]
        # A viewer multiplies material and vertex colour.
        assert "COLOR_0" not in primitive["attributes"]
        assert mesh["name"].endswith("_" + document["materials"][primitive["material"]]["name"])
    assert linear((0.0, 0.5, 1.0)) == pytest.approx([0, 0.214041, 1], abs=1e-6)


@pytest.mark.slow("works on many faces")
def test_the_merged_mesh_has_vertex_colours_under_white(halves, tmp_path):
    _, found = halves
    write(found, tmp_path / "p.glb", merged=True)
    document, arrays = read(tmp_path / "p.glb")
    (material,), (mesh,) = document["materials"], document["meshes"]
    assert "baseColorFactor" not in material["pbrMetallicRoughness"]
    attributes = mesh["primitives"][0]["attributes"]
    seen = np.unique(np.round(sRGB(arrays[attributes["COLOR_0"]][:, :3] / 65535), 3), axis=0)
    assert seen == pytest.approx(np.unique(np.round([COLOURS[p.label] for p in found.pieces], 3), axis=0), abs=2e-3)


def test_trimesh_shows_the_colours(drawn):
    for name, mesh in trimesh.load(drawn).geometry.items():
        colour = np.ravel(mesh.visual.to_color().vertex_colors)[:3]
        (label,) = (k for k in COLOURS if name.endswith(f"_{k}"))
        assert colour == pytest.approx(np.array(linear(COLOURS[label])) * 255, abs=1)


def test_metres_and_y_up_in_trimesh(halves, tmp_path):
    part, found = halves
    write(found, tmp_path / "p.glb")
    scene = trimesh.load(tmp_path / "p.glb")
    size = np.ptp(scene.bounds, axis=0) * 1000
    assert size == pytest.approx([part.size[0], part.size[2], part.size[1]], rel=1e-3)
    assert len(scene.geometry) == len(found.pieces)
    total = sum(mesh.area for mesh in scene.geometry.values()) * 1e6
    assert total == pytest.approx(sum(f.area for f in part.faces), rel=2e-3)
    names = {mesh.metadata.get("name", key) for key, mesh in scene.geometry.items()}
    assert "F1_-1" in names


def test_meshes_of_a_solid_close_and_face_outwards(drawn):
    whole = trimesh.load(drawn).to_mesh()
    whole.merge_vertices(merge_norm=True, merge_tex=True)
    assert whole.is_watertight
    assert whole.volume > 0


@pytest.mark.parametrize("shape", [BRepPrimAPI_MakeSphere(10).Solid(), BRepPrimAPI_MakeBox(1, 2, 3).Solid()])
def test_normals_are_unit_and_outward(shape, tmp_path):
    write(split(Part(shape), []), tmp_path / "p.glb")
    document, arrays = read(tmp_path / "p.glb")
    for mesh in document["meshes"]:
        (primitive,) = mesh["primitives"]
        point, normal = (arrays[primitive["attributes"][name]] for name in ("POSITION", "NORMAL"))
        triangle = arrays[primitive["indices"]].reshape(-1, 3)
        assert np.allclose(np.linalg.norm(normal, axis=1), 1, atol=1e-6)
        facet = np.cross(point[triangle[:, 1]] - point[triangle[:, 0]], point[triangle[:, 2]] - point[triangle[:, 0]])
        assert ((facet[:, None] * normal[triangle]).sum(-1) > 0).all()
        if len(document["meshes"]) == 1:
            assert np.allclose(normal, point / np.linalg.norm(point, axis=1)[:, None], atol=2e-5)


@pytest.mark.slow("writes a whole part twice")
def test_same_bytes_whatever_mesh_the_part_carries(halves, tmp_path):
    from OCP.BRepMesh import BRepMesh_IncrementalMesh

    _, found = halves
    write(found, tmp_path / "a.glb")
    BRepMesh_IncrementalMesh(found.shape, 0.05, False, 0.3, False)
    write(found, tmp_path / "b.glb")
    assert (tmp_path / "a.glb").read_bytes() == (tmp_path / "b.glb").read_bytes()


@pytest.mark.slow("works on many faces")
def test_what_cannot_be_written(halves, tmp_path, monkeypatch):
    _, found = halves
    with pytest.raises(WriteError, match="cannot be written"):
        write(found, tmp_path / "missing" / "p.glb")
    real = module.with_normals
    calls = []
    monkeypatch.setattr(module, "with_normals", lambda *a, **k: calls.append(1) or (None if len(calls) == 1 else real(*a, **k)))
    assert write(found, tmp_path / "p.glb") == (found.pieces[0].face,)
    document, _ = read(tmp_path / "p.glb")
    assert len(document["meshes"]) == len(found.pieces) - 1
    # The material of what could not be drawn is left out: a validator tells of each that nothing uses.
    used = {mesh["primitives"][0]["material"] for mesh in document["meshes"]}
    assert used == set(range(len(document["materials"])))
    monkeypatch.setattr(module, "with_normals", lambda *a, **k: None)
    with pytest.raises(WriteError, match="no triangle"):
        write(found, tmp_path / "q.glb")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["p.glb"]
