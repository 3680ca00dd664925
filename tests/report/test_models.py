"""The annotated STEP and GLB of a plan, read back by other means than they were written with."""

import json
import os
import re
import struct
import subprocess
from collections import Counter

import cadquery as cq
import numpy as np
import pytest
import trimesh

from cad_io import read_part
from plan_cutters import Cutter, plan
from plan_cutters.plan_file.reasons import PALETTE, rgb
from plan_cutters.report.folder import DEFAULT_FORMATS
from plan_cutters.report.models import split_result
from tests.support.places import ROOT, SAMPLES


@pytest.fixture(scope="module", params=["pocket_top", "peaks_and_valleys", "blade", "v_groove"])
def written(request, tmp_path_factory):
    out = tmp_path_factory.mktemp(request.param)
    result = plan(SAMPLES / f"{request.param}.step", cutters=[Cutter.flat(radius=8, length=90)], grid=61, area_budget=0)
    return result, result.write(out, (*DEFAULT_FORMATS, "merged")), out


def shares(result):
    """Share of the target samples' area that has each verdict."""
    verdict, area = result.reaches["R8L90"].verdict, result.samples.area
    names = {2: "interference_free", 1: "accessible", 0: "inaccessible"}
    return {name: float(area[verdict == code].sum()) for code, name in names.items() if (verdict == code).any()}


@pytest.mark.slow("plans whole parts", only=("blade", "peaks"))
def test_step_pieces_have_the_verdicts_names_colours_and_areas(written):
    result, document, out = written
    assert {entry.rung for entry in document.split.values()} <= {"contour"}
    again = read_part(out / "annotated.step")
    assert again.solids == result.part.solids
    faces = {f.id: f for f in document.faces}
    area: Counter = Counter()
    for face in again.faces:
        number, _, verdict = face.name.partition("_")
        assert face.colour == pytest.approx(rgb(verdict), abs=2e-3)
        assert (verdict == "check") == (not faces[number].target)
        area[number] += face.area
        if faces[number].target:
            area[verdict] += face.area
    for f in document.faces:
        assert area[f.id] == pytest.approx(f.area_mm2, rel=2e-4)
    whole = sum(f.area_mm2 for f in document.faces if f.target)
    for verdict, expected in shares(result).items():
        assert area[verdict] == pytest.approx(expected, abs=0.04 * whole)


def chunks(path):
    data = path.read_bytes()
    assert data[:4] == b"glTF"
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length])


def linear(value):
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


@pytest.mark.slow("plans whole parts", only=("peaks",))
def test_glb_says_face_and_verdict_and_stands_upright_in_metres(written):
    result, document, out = written
    tree = chunks(out / "annotated.glb")
    said = [n["extras"] for n in tree["nodes"] if "verdicts" in n.get("extras", {})]
    assert sorted(e["face"] for e in said) == sorted(f.id for f in document.faces)
    entry = document.cutters[0]
    for extras in said:
        if extras["target"]:
            assert extras["verdicts"] == entry.faces[extras["face"]].model_dump()
    pieces = [n["extras"] for n in tree["nodes"] if "verdict" in n.get("extras", {})]
    assert {p["verdict"] for p in pieces} <= set(PALETTE)
    scene = trimesh.load(out / "annotated.glb")
    for name, mesh in scene.geometry.items():
        verdict = re.sub(r"_\d+$", "", name.split()[0].partition("_")[2])
        assert mesh.visual.material.name == verdict
        # What trimesh, and a viewer that knows no vertex colours, shows.
        assert np.ravel(mesh.visual.to_color().vertex_colors)[:3] == pytest.approx(
            [255 * linear(c) for c in rgb(verdict)], abs=0.51
        )
    x, y, z = np.ptp(scene.bounds, axis=0) * 1000
    assert (x, z, y) == pytest.approx(result.part.size, rel=0.02)


@pytest.mark.slow("plans whole parts", only=("peaks",))
def test_merged_glb_has_the_same_triangles_in_one_mesh_with_face_numbers(written):
    _, document, out = written
    single, merged = (trimesh.load(out / f"{name}.glb") for name in ("annotated", "merged"))
    (mesh,) = merged.geometry.values()
    assert len(mesh.faces) == sum(len(m.faces) for m in single.geometry.values())
    assert mesh.area == pytest.approx(sum(m.area for m in single.geometry.values()), rel=1e-9)
    tree = chunks(out / "merged.glb")
    assert [f["face"] for f in tree["nodes"][0]["extras"]["faces"]] == [f.id for f in document.faces]
    assert set(np.unique(mesh.vertex_attributes["_FACE"])) == {float(f.id[1:]) for f in document.faces}


@pytest.mark.slow("plans whole parts", only=("peaks",))
@pytest.mark.parametrize("name", ["annotated.glb", "merged.glb"])
def test_glb_passes_the_khronos_validator(written, name):
    _, _, out = written
    assert (ROOT / "node_modules" / "gltf-validator").is_dir(), "run: sh setup.sh dev"
    done = subprocess.run(
        ["node", str(ROOT / "tests" / "support" / "gltf_validate.js"), str(out / name)],
        capture_output=True, text=True, check=True, env={**os.environ, "NODE_PATH": str(ROOT / "node_modules")},
    )  # fmt: skip
    issues = json.loads(done.stdout)
    assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues


@pytest.mark.slow("plans whole parts", only=("peaks",))
def test_a_face_without_a_grid_is_coloured_by_its_worst_verdict(written):
    from dataclasses import replace

    from plan_cutters.plan_file.reasons import LABELS
    from plan_cutters.report.models import split_result

    result, _, _ = written
    bare = replace(result, ready=replace(result.ready, samples=replace(result.samples, grids=())))
    target = {int(f.id[1:]) for f in result.plan.faces if f.target}
    for piece in split_result(bare).pieces:
        if piece.face in target:
            verdicts = result.reaches["R8L90"].verdict[result.samples.face == piece.face]
            assert LABELS[piece.label] == ("inaccessible" if (verdicts == 0).any() else "accessible")


def test_a_face_round_a_seam_with_one_line_is_written(tmp_path):
    """Two lines each way, of which the seam is one twice: the border of its labels is a turn further."""
    cone = cq.Workplane(cq.Solid.makeCone(5, 2, 8))
    result = plan(cone, cutters="R2L40", grid=2, faces="F1", area_budget=0)
    assert result.samples.grids[0].u.size == 1
    assert not result.write(tmp_path, ["json", "step", "glb", "png"]).not_written
    split = split_result(result)
    area = sum(cq.Face(piece.shape).Area() for piece in split.pieces if piece.face == 1)
    assert area == pytest.approx(result.plan.faces[0].area_mm2, rel=1e-6)
