"""The files of a plan of operations: regions, planes, and models read back by other means than they were written with."""

import csv
import json
import math
import os
import re
import subprocess
from dataclasses import replace
from itertools import pairwise, permutations, product

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from cad_io import read_part
from plan_cutters import plan
from plan_cutters.domain.machine import Machine
from plan_cutters.domain.operations import columns_of
from plan_cutters.operations.orientations import MOST, Indexing, Orientations, index_times
from plan_cutters.plan_file.reasons import parts, rgb
from plan_cutters.report import models
from plan_cutters.report.folder import DEFAULT_FORMATS
from plan_cutters.scene.conditions import Context
from plan_cutters.scene.distances import clearances
from plan_cutters.scene.fixed_axis import at_fixed_axis, held_at
from tests.support.cad_parts import box
from tests.support.places import ROOT, SAMPLES
from tests.support.shapes import ridge

pytestmark = pytest.mark.slow("plans operations of a machine on a sculptured part", only=("peaks",))
BALL = "R1L60rc1"
CASES = {
    "ridge": (lambda: ridge(10.0, 10.0), {"cutters": BALL, "faces": "all", "grid": 15, "tilt": (0.0, math.radians(31.0))}),
    "peaks": (
        lambda: SAMPLES / "peaks_and_valleys.step",
        {"cutters": "R6L80", "grid": 13, "machine": "trunnion-ac", "index_step": math.radians(15.0)},
    ),
}


@pytest.fixture(scope="module", params=CASES)
def written(request, tmp_path_factory):
    part, options = CASES[request.param]
    out = tmp_path_factory.mktemp(request.param)
    result = plan(part(), **options, operations="both", feed=2000.0, area_budget=0)
    return result, result.write(out, DEFAULT_FORMATS), out


def unpacked(runs):
    return [row for first, last in runs for row in range(first, last + 1)]


def files(document):
    stems = ("operations", "operations_fastest")
    return list(zip(document.operations.plans, stems, strict=True))


def words_of(document, entry):
    """How models call the operations of a plan, by their ids: those of the process by the numbers of its steps."""
    steps = document.process.steps if document.process.plan == entry.name else []
    names = {each.id: each.id for each in entry.operations}
    return names | {step.operation: f"step{k}" for k, step in enumerate(steps, 1) if step.operation}


@pytest.mark.slow("plans whole parts")
def test_regions_part_the_samples_of_their_operation_and_are_connected(written):
    result, document, _ = written
    samples = result.samples
    for entry, found in zip(document.operations.plans, result.answers.operations.plans, strict=True):
        assert [r.id for each in entry.operations for r in each.regions] == list(range(found.region.max() + 1))
        for number, each in enumerate(entry.operations):
            rows = [unpacked(region.rows) for region in each.regions]
            every = [row for mine in rows for row in mine]
            assert sorted(every) == np.flatnonzero(found.label == number).tolist()
            assert found.serves[every, number].all()
            assert sum(region.area_mm2 for region in each.regions) == pytest.approx(each.area_mm2)
            assert all(a.area_mm2 >= b.area_mm2 for a, b in pairwise(each.regions))
            for region, mine in zip(each.regions, rows, strict=True):
                assert sum(face.samples for face in region.faces) == region.samples == len(mine)
                assert np.allclose([region.low, region.high], [f(samples.point[mine], axis=0) for f in (np.min, np.max)])
                met, inside = {mine[0]}, set(mine)
                while more := {
                    b for a, b in [*samples.neighbours.tolist(), *samples.neighbours[:, ::-1].tolist()]
                    if a in met and b in inside and b not in met
                }:  # fmt: skip
                    met |= more
                assert met == inside


@pytest.mark.slow("plans whole parts", only=("peaks",))
def test_the_plane_turns_with_the_rotary_axes(written):
    result, document, _ = written
    for entry in document.operations.plans:
        for each in entry.operations:
            if each.mode == "simultaneous":
                assert each.frame is each.index_s is each.index_from is None
                continue
            assert np.allclose(each.frame.z, each.axis, atol=1e-12)
            assert np.isclose(np.linalg.norm(each.frame.x), 1.0)
            assert abs(np.dot(each.frame.x, each.frame.z)) < 1e-12
            assert (each.index_s, each.index_from) == (5.0, "assumed")
            if result.kinematics is not None:
                # C about Z and A about X of the tool: R_z(C) R_x(A), by hand. The machine's X stays across Z.
                c = math.radians(each.angles_deg["C"])
                assert np.allclose(each.frame.x, (math.cos(c), math.sin(c), 0.0), atol=1e-9)


@pytest.mark.slow("plans whole parts", only=("peaks",))
def test_the_clearance_of_an_operation_is_the_least_of_its_samples(written):
    result, document, _ = written
    samples = result.samples
    for entry, found in zip(document.operations.plans, result.answers.operations.plans, strict=True):
        for number, (said, each) in enumerate(zip(entry.operations, found.operations, strict=True)):
            if each.axis is None:
                continue
            conditions = result.ready.setups[0]
            mine = np.where(found.label == number, 0, -1)
            there = held_at(each.axis[None], mine, samples, Context.of(each.cutter, conditions))
            at = at_fixed_axis(samples, there, conditions.tolerance)
            every = clearances(at, each.cutter, there, conditions).distance[each.rows]
            assert said.clearance_mm == pytest.approx(every.min(), abs=0.0)


@pytest.mark.slow("plans whole parts", only=("peaks",))
def test_step_faces_have_the_names_colours_and_areas_of_their_operations(written):
    result, document, out = written
    for (entry, stem), found in zip(files(document), result.answers.operations.plans, strict=True):
        again = read_part(out / f"{stem}.step")
        assert again.solids == result.part.solids
        called = words_of(document, entry)
        colours = {called[each.id]: parts(each.colour) for each in entry.operations}
        words = [face.name.split()[0].partition("_")[2] for face in again.faces]
        for face, word in zip(again.faces, words, strict=True):
            assert face.colour == pytest.approx(colours[word] if word in colours else rgb(word), abs=2e-3)
        whole = sum(face.area_mm2 for face in document.faces)
        assert sum(face.area for face in again.faces) == pytest.approx(whole, rel=2e-4)
        for number, each in enumerate(entry.operations):
            # Of each region a face, also of one sample: what is around it may not serve it.
            area = sum(face.area for face, word in zip(again.faces, words, strict=True) if word == called[each.id])
            assert area == pytest.approx(each.area_mm2, abs=0.03 * whole)
            assert area > 0.0
            assert (found.label == number).any()


def test_no_face_has_an_operation_that_does_not_serve_the_samples_on_it(written):
    """The nearest triangle of the GLB says where a sample lies; what is beyond a border is counted in the plan."""
    result, document, out = written
    samples = result.samples
    for (entry, stem), found in zip(files(document), result.answers.operations.plans, strict=True):
        scene = trimesh.load(out / f"{stem}.glb")
        points, names = [], []
        for name, mesh in scene.geometry.items():
            dense, _ = trimesh.sample.sample_surface(mesh, max(50, int(mesh.area * 1e6 * 4)), seed=1)
            points.append(np.asarray(dense) * 1000.0)
            names += [re.sub(r"_\d+$", "", name.split()[0].partition("_")[2])] * len(dense)
        cloud = np.concatenate(points)[:, [0, 2, 1]] * (1.0, -1.0, 1.0)
        near = cKDTree(cloud).query(samples.point)[1]
        ids = list(words_of(document, entry).values())
        wrong = 0
        for row in np.flatnonzero(found.label >= 0).tolist():
            word = names[near[row]]
            assert word in ids
            wrong += not found.serves[row, ids.index(word)]
        told = sum(each.dropped for each in entry.split.values())
        assert wrong <= told + 0.01 * len(samples)
        assert all(each.rung == "contour" for each in entry.split.values())


def test_glb_says_the_operation_of_each_piece_and_passes_the_khronos_validator(written):
    _, document, out = written
    for entry, stem in files(document):
        data = (out / f"{stem}.glb").read_bytes()
        tree = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
        said = [node for node in tree["nodes"] if "operation" in node.get("extras", {})]
        known, called = {each.id: each for each in entry.operations}, words_of(document, entry)
        assert {node["extras"]["operation"] for node in said} - {None} == set(known)
        for node in said:
            extras = node["extras"]
            if extras["operation"]:
                assert extras["cutter"] == known[extras["operation"]].cutter
                assert node["name"].startswith(f"{extras['face']}_{called[extras['operation']]}")
                assert called[extras["operation"]] in (f"step{extras['step']}", extras["operation"])
            else:
                assert node["name"].startswith(f"{extras['face']}_{extras['verdict']}")
    done = subprocess.run(
        ["node", str(ROOT / "tests" / "support" / "gltf_validate.js"), *(str(out / f"{s}.glb") for _, s in files(document))],
        capture_output=True, text=True, check=True, env={**os.environ, "NODE_PATH": str(ROOT / "node_modules")},
    )  # fmt: skip
    for line in done.stdout.splitlines():
        issues = json.loads(line)
        assert (issues["numErrors"], issues["numWarnings"]) == (0, 0), issues


@pytest.mark.slow("plans whole parts", only=("peaks",))
def test_files_are_whole_or_named_and_written_with_the_formats_asked_for(written, tmp_path, monkeypatch):
    result, document, out = written
    names = {"operations_step", "operations_glb", "fastest_step", "fastest_glb"}
    assert names <= document.files.keys()
    assert not document.not_written
    assert all((out / entry.name).is_file() for entry in document.files.values())
    few = result.write(tmp_path / "few", ["json", "glb"])
    assert names & few.files.keys() == {"operations_glb", "fastest_glb"}

    def fails(*_):
        raise RuntimeError("no halves")

    monkeypatch.setattr(models, "split_by_turns", fails)
    lost = result.write(tmp_path / "lost", ["json", "step", "glb"])
    assert {"step", "glb"} <= lost.files.keys()
    assert set(lost.not_written) == names
    assert all("no halves" in why for why in lost.not_written.values())


def brute(positions, rate):
    """The least time over all orders and solutions."""
    best = math.inf
    for order in permutations(range(len(positions))):
        for ways in product(*(positions[i] for i in order)):
            places = [(0.0, 0.0), *ways]
            best = min(best, sum(max(abs(b - a) / r for a, b, r in zip(p, q, rate, strict=True)) for p, q in pairwise(places)))
    return best


@given(st.lists(st.lists(st.tuples(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5)), min_size=1, max_size=2), min_size=1, max_size=4))
@settings(max_examples=60, deadline=None)
def test_index_times_are_those_of_the_best_of_all_orders(positions):
    rate = np.array([0.5, 2.0])
    found = index_times([np.array(each) for each in positions], np.array([[-1.6, 1.6]] * 2), rate)
    assert found.sum() == pytest.approx(brute(positions, rate), abs=1e-9)


def test_an_endless_axis_takes_the_shorter_way_and_a_limited_one_does_not():
    places = [np.radians([[170.0, 0.0]]), np.radians([[-170.0, 0.0]])]
    rate = np.radians([10.0, 10.0])
    endless = index_times(places, np.array([[-math.inf, math.inf], [-2.0, 2.0]]), rate)
    limited = index_times(places, np.radians([[-180.0, 180.0], [-90.0, 90.0]]), rate)
    turning = index_times(places, np.radians([[-360.0, 360.0], [-90.0, 90.0]]), rate)
    assert (endless.sum(), limited.sum(), turning.sum()) == pytest.approx((19.0, 51.0, 19.0))


def test_more_positions_than_all_orders_can_be_tried_of_take_the_nearest_next():
    places = [np.array([[0.1 * k, 0.0]]) for k in range(MOST + 3)]
    found = index_times(places, np.array([[-3.0, 3.0]] * 2), np.array([1.0, 1.0]))
    assert found.sum() == pytest.approx(0.1 * (MOST + 2))


RATED = replace(TRUNNION := Machine.parse("trunnion-ac"),
                axes=tuple(replace(each, rate=math.radians(30.0)) for each in TRUNNION.axes))  # fmt: skip


@pytest.mark.slow("plans whole parts", but=("machine0",))
@pytest.mark.parametrize(
    ("machine", "given", "source"),
    [(RATED, None, "rates"), (RATED, 7.0, "given"), (TRUNNION, 7.0, "given"), (TRUNNION, None, "assumed")],
)
def test_seconds_of_orientations_follow_from_rates_unless_they_are_given(machine, given, source):
    result = plan(
        box(), cutters=BALL, faces="all", grid=4, operations="both", feed=1000.0, machine=machine, index_time=given,
        area_budget=0,
    )  # fmt: skip
    entry = result.plan.operations
    assert (entry.assumed.index_from, entry.assumed.index_s) == (source, given or 5.0)
    for each in entry.plans:
        found = each.operations
        assert {one.index_from for one in found} == {source}
        assert each.other_seconds == pytest.approx(sum(one.index_s for one in found))
        for one in found:
            assert 0.0 <= one.index_s <= 180.0 / 30.0 + 1e-9 if source == "rates" else one.index_s == (given or 5.0)
    assert entry.fastest.bound_seconds <= entry.fastest.seconds * (1.0 + 1e-9)


@pytest.fixture(scope="module")
def rated():
    return Orientations.of(plan(box(), cutters=BALL, grid=2, machine=RATED, area_budget=0).ready.setups[0])


@pytest.mark.parametrize("seed", range(10))
def test_any_orientations_together_take_at_least_the_turn_to_each(rated, seed):
    rng = np.random.default_rng(seed)
    indexing = Indexing((rated,), None)
    axis = rng.normal(size=(8, 3)) * (1.0, 1.0, 0.3) + (0.0, 0.0, 1.0)
    angle, held = indexing.orientations[0].near(axis / np.linalg.norm(axis, axis=1)[:, None])
    columns = columns_of(held, angle)
    reach = indexing.from_zero(columns)
    assert len(columns) > 3
    assert reach.max() > 0.5
    for count in range(1, len(columns) + 1):
        some = rng.choice(len(columns), count, replace=False)
        assert indexing.together(columns.of(some)) >= reach[some].max() - 1e-9
    alone = [indexing.together(columns.of(np.array([k]))) for k in range(len(columns))]
    assert np.allclose(reach, alone, atol=1e-3)


def test_the_table_has_a_line_for_each_operation(written):
    """Numbers are rounded for people; an axis still points where the plan says."""
    _, document, out = written
    with (out / "operations.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    wanted = [(plan.name, each) for plan in document.operations.plans for each in plan.operations]
    assert [(row["plan"], row["operation"]) for row in rows] == [(name, each.id) for name, each in wanted]
    ours = {row["operation"]: row["step"] for row in rows if row["plan"] == document.process.plan}
    assert [ours[step.operation] for step in document.process.steps] == [str(k) for k in range(1, len(ours) + 1)]
    assert {row["step"] for row in rows if row["plan"] != document.process.plan} <= {""}
    for row, (_, each) in zip(rows, wanted, strict=True):
        assert float(row["area_mm2"]) == pytest.approx(each.area_mm2, abs=5e-4)
        assert len(row["area_mm2"].partition(".")[2]) <= 3
        assert row["faces"].split() == [face.face for face in each.faces]
        assert int(row["setup"]) == each.setup + 1
        found = [row[name] for name in ("axis_x", "axis_y", "axis_z")]
        assert found == ["", "", ""] if each.axis is None else np.allclose([float(x) for x in found], each.axis, atol=1e-9)
        assert "-0.0" not in row.values()
