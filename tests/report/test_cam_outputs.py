"""What CAM takes: axes as CSV and VTK, clearances, posture maps; against dense points and brute force."""

import csv
import math
import re
import shutil
from itertools import pairwise

import cadquery as cq
import numpy as np
import pytest
import trimesh

import plan_cutters.report.arrays as to_csv
from plan_cutters import Cutter, plan, posture_map
from plan_cutters.domain.assembly import MOST, grown
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.holder import Holder
from plan_cutters.domain.kinematics import Kinematics
from plan_cutters.domain.posture import tilt_direction
from plan_cutters.domain.shapes import flute_length
from plan_cutters.domain.travel import tips
from plan_cutters.domain.verdicts import ACCESSIBLE, INTERFERENCE_FREE
from plan_cutters.report.arrays import write_csv, write_vtk
from plan_cutters.scene.conditions import Context, rotations_of
from tests.support.places import ROOT
from tests.support.serving import serves

HELD = Cutter.parse("R3L36rc3F8N2.5x10S3").asked(0.0, 0.0, Holder.parse("R10:14L10+R16L30"))


@pytest.fixture(scope="module")
def peaks():
    return plan("samples/peaks_and_valleys.step", cutters=HELD, grid=15, area_budget=0, machine="trunnion-ac",
                fixtures=["box:20,20,90@20,-10,-40"], posture_maps=True, tilt=(0.0, 0.6))  # fmt: skip


def to_band(q, w, low, high, lower, upper):
    """Distance of points (q, w) of the meridian plane from a truncated cone; 0 within."""
    corners = np.array([[0.0, low], [lower, low], [upper, high], [0.0, high]])
    inside = (w >= low) & (w <= high) & (q <= lower + (upper - lower) * (w - low) / (high - low))
    best = np.full(q.shape, np.inf)
    for a, b in pairwise(corners):
        side = b - a
        share = np.clip(((q - a[0]) * side[0] + (w - a[1]) * side[1]) / (side @ side), 0.0, 1.0)
        best = np.minimum(best, np.hypot(q - a[0] - share * side[0], w - a[1] - share * side[1]))
    return np.where(inside, 0.0, best)


def bands(cutter):
    """What of an end mill counts, as truncated cones."""
    low, top = 2.0 * cutter.radius, flute_length(cutter)
    flutes = [(low, top, cutter.radius, cutter.radius)] if top > low and not cutter.stages else []
    return flutes + [(at, at + s.length, s.radius, s.upper_radius) for _, at, s in cutter.stages]


def true_clearance(cutter, tip, axis, points):
    """Least distance of points from what counts of a tool."""
    w = (points - tip) @ axis
    q = np.linalg.norm(points - tip - w[:, None] * axis, axis=1)
    return min(float(to_band(q, w, *band).min()) for band in bands(cutter))


def dense(result, spacing):
    """Points all over the obstacles, with which the triangles are covered to half a spacing or so."""
    triangles = result.scene.surround().possible.triangles.vertex
    mesh = trimesh.Trimesh(triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3), process=False)
    count = int(4.0 * mesh.area / spacing**2)
    points, _ = trimesh.sample.sample_surface(mesh, count, seed=1)
    return np.concatenate([np.asarray(points), triangles.reshape(-1, 3)])


@pytest.mark.slow("plans whole parts")
@pytest.mark.parametrize("spec", ["", "R6L80", "R2L60rc0.5F30S4"])
def test_a_clearance_is_never_more_than_the_distance_and_little_less(peaks, spec):
    result = peaks
    if spec:
        cutter = Cutter.parse(spec)
        result = plan("samples/peaks_and_valleys.step", cutters=cutter, grid=21, area_budget=0)
    cutter, reach = result.judged(result.shown), result.reaches[result.shown]
    found, points = result.clearances, dense(result, 0.8)
    tip = tips(cutter, result.samples.point, result.samples.normal, reach)
    rows = np.flatnonzero(reach.reached)[:: max(1, int(reach.reached.sum()) // 16)]
    distances = set()
    for row in rows.tolist():
        true = true_clearance(cutter, tip[row], reach.axis[row], points)
        told = found.distance[row]
        assert told <= true + 1e-9, (row, told, true)
        # Flutes have square edges at their lower end: what is near these is told nearer by up to 1 - 1 / sqrt 2.
        share = 0.7 if found.part[row] == 0 else 0.975
        assert told == MOST or told >= share * true - 0.8 - 0.02, (row, told, true)
        distances.add(told)
    assert len(distances) > 5


@pytest.mark.slow("plans whole parts")
def test_clearances_stay_unknown_where_there_is_no_posture_or_nothing_that_counts(peaks):
    reach = peaks.reaches[peaks.shown]
    assert np.isfinite(peaks.clearances.distance[reach.reached]).all()
    assert (~reach.reached).any()
    assert np.isnan(peaks.clearances.distance[~reach.reached]).all()
    short = plan("samples/v_groove.step", cutters="R8L14", grid=5, area_budget=0, faces="all")
    assert short.reaches["R8L14"].reached.any()
    assert np.isnan(short.clearances.distance).all()
    assert not grown(Cutter.parse("R8L14"), 0.1).piece.size


def test_more_fixtures_leave_less_room(peaks):
    bare = plan("samples/peaks_and_valleys.step", cutters=HELD, grid=15, area_budget=0, machine="trunnion-ac",
                tilt=(0.0, 0.6))  # fmt: skip
    both = peaks.reaches[peaks.shown].axis == bare.reaches[bare.shown].axis
    same = both.all(axis=1)
    with_box, without = peaks.clearances.distance[same], bare.clearances.distance[same]
    assert (with_box <= without).all()
    assert (with_box < without).any()
    assert (peaks.clearances.face[same][with_box < without] < 0).all()


def rows_of(path):
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_the_table_says_what_the_arrays_say(peaks, tmp_path):
    write_csv(peaks, None, tmp_path / "a.csv")
    write_csv(peaks, None, tmp_path / "b.csv")
    data = (tmp_path / "a.csv").read_bytes()
    assert data == (tmp_path / "b.csv").read_bytes()
    assert data.count(b"\r\n") == data.count(b"\n") == len(peaks.samples) + 1
    assert b"nan" not in data
    assert b"-0.0," not in data
    rows, reach = rows_of(tmp_path / "a.csv"), peaks.reaches[peaks.shown]
    numbers = {name: np.array([float(row[name] or "nan") for row in rows]) for name in rows[0] if re.search(
        r"(_mm2?|_deg|_[xyz])$", name)}  # fmt: skip
    axis = np.column_stack([numbers[f"axis_{x}"] for x in "xyz"])
    assert np.allclose(axis, reach.axis, atol=1e-9, equal_nan=True)
    assert np.allclose(np.column_stack([numbers[f"point_{x}_mm"] for x in "xyz"]), peaks.samples.point, atol=1e-6)
    assert np.allclose(numbers["tilt_deg"], np.degrees(reach.tilt), atol=1e-6, equal_nan=True)
    assert {row["verdict"] for row in rows} >= {"accessible", "inaccessible"}
    for row, verdict in zip(rows, reach.verdict.tolist(), strict=True):
        assert (row["verdict"] in ("accessible", "interference_free")) == (verdict in (ACCESSIBLE, INTERFERENCE_FREE))
        assert bool(row["axis_x"]) == bool(row["clearance_mm"]) == bool(row["C_deg"])
    # The axis at the rotary positions is the axis, for both solutions; the lean at the rotation is the lean.
    kinematics: Kinematics = peaks.kinematics
    for word in ("", "_other"):
        angle = np.radians(np.column_stack([numbers[f"C{word}_deg"], numbers[f"A{word}_deg"]]))
        known = np.isfinite(angle).all(axis=1)
        assert known.any()
        assert np.allclose(kinematics.axis(angle[known]), reach.axis[known], atol=1e-7)
    known = reach.reached
    f = tilt_direction(peaks.samples.normal, peaks.samples.direction_max, np.radians(numbers["rotation_deg"]))
    assert np.allclose(f[known], reach.tilt_direction[known], atol=1e-7)


def test_the_tip_lies_where_the_ball_touches(peaks, tmp_path):
    write_csv(peaks, None, tmp_path / "axes.csv")
    for row in rows_of(tmp_path / "axes.csv")[::17]:
        if row["axis_x"]:
            tip, axis, point, normal = (
                np.array([float(row[f"{word}_{x}{unit}"]) for x in "xyz"])
                for word, unit in (("tip", "_mm"), ("axis", ""), ("point", "_mm"), ("normal", ""))
            )
            assert np.allclose(tip + HELD.radius * axis, point + HELD.radius * normal, atol=1e-5)


def test_paraview_reads_the_points(peaks, tmp_path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    path = tmp_path / "axes.vtp"
    write_vtk(peaks, None, path)
    first = path.read_bytes()
    write_vtk(peaks, None, path)
    assert path.read_bytes() == first
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    assert reader.GetErrorCode() == 0
    data, n = reader.GetOutput(), len(peaks.samples)
    assert data.GetNumberOfPoints() == data.GetNumberOfVerts() == n
    assert [data.GetVerts().GetCellSize(i) for i in range(n)] == [1] * n
    assert np.array_equal(vtk_to_numpy(data.GetPoints().GetData()), peaks.samples.point)
    arrays = {data.GetPointData().GetArrayName(i): vtk_to_numpy(data.GetPointData().GetArray(i))
              for i in range(data.GetPointData().GetNumberOfArrays())}  # fmt: skip
    reach = peaks.reaches[peaks.shown]
    assert np.array_equal(arrays["axis"], reach.axis, equal_nan=True)
    assert np.array_equal(arrays["verdict"], reach.verdict)
    assert np.array_equal(arrays["reason"], reach.reason)
    assert np.array_equal(arrays["face"], peaks.samples.face)
    assert np.array_equal(arrays["clearance_mm"], peaks.clearances.distance, equal_nan=True)
    assert {"normal", "tilt_deg", "lean", "C_deg", "A_deg", "C_other_deg"} <= set(arrays)
    told = {}
    for i in range(data.GetFieldData().GetNumberOfArrays()):
        words = data.GetFieldData().GetAbstractArray(i)
        told[words.GetName()] = [words.GetValue(k) for k in range(words.GetNumberOfValues())]
    assert told["verdicts"][1] == "1 accessible"
    for name, column in (("classes", "surface_class"), ("parts", "nearest_part")):
        codes = {int(line.split()[0]) for line in told[name]}
        assert set(np.unique(arrays[column]).tolist()) <= codes | {-1}
    assert told["fixtures"] == ["-1 fixture:box"]
    assert -1 in arrays["nearest_face"]


def test_large_arrays_go_into_several_blocks(tmp_path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    from plan_cutters.report.arrays import _BLOCK, _array

    for n in (_BLOCK // 8 - 1, _BLOCK // 8, 3 * _BLOCK // 8 + 5, 0):
        values, point = np.arange(float(n)), np.zeros((n, 3), np.float32)
        (tmp_path / "x.vtp").write_text(
            '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64" '
            f'compressor="vtkZLibDataCompressor"><PolyData><Piece NumberOfPoints="{n}"><PointData>{_array("a", values)}'
            f"</PointData><Points>{_array('Points', point)}</Points></Piece></PolyData></VTKFile>"
        )
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(tmp_path / "x.vtp"))
        reader.Update()
        assert np.array_equal(vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("a")), values)


def test_every_posture_found_is_served_by_its_own_axis(peaks):
    reach, cutter = peaks.reaches[peaks.shown], peaks.judged()
    rows = np.flatnonzero(reach.reached)[::9]
    for row in rows.tolist():
        assert serves(np.array([row]), reach.axis[row], peaks.samples, Context.of(cutter, peaks.conditions))[0]


@pytest.mark.slow("plans whole parts")
def test_a_fixed_axis_serves_just_where_a_map_of_the_point_has_it_free(peaks):
    """The map of one point comes from other kernels: closed intervals in place of a test of one posture."""
    cutter, samples = peaks.judged(), peaks.samples
    rng, agreed = np.random.default_rng(5), {True: 0, False: 0}
    for row in rng.choice(len(samples), 14, replace=False).tolist():
        axis = samples.normal[row] + 0.35 * rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        f = axis - (axis @ samples.normal[row]) * samples.normal[row]
        turn = float(rotations_of(samples.normal[row], samples.direction_max[row], f / np.linalg.norm(f)))
        tilt = math.acos(axis @ samples.normal[row])
        found = posture_map(peaks.scene, point=samples.point[row], cutter=cutter, rotations=[turn], machine="trunnion-ac",
                            tilt=(0.0, 0.6))  # fmt: skip
        free = any(low <= tilt <= high for low, high in found.free[0])
        near = any(low - 1e-3 <= tilt <= high + 1e-3 for low, high in found.undecided[0]) or any(
            abs(tilt - end) < 1e-3 for interval in found.free[0] for end in interval
        )
        if not near:
            assert serves(np.array([row]), axis, samples, Context.of(cutter, peaks.conditions))[0] == free
            agreed[free] += 1
    assert agreed[True] + agreed[False] >= 8
    assert agreed[True]
    assert agreed[False]


@pytest.mark.slow("writes many files")
def test_names_that_no_file_can_hold_cost_no_file(tmp_path):
    part = cq.Assembly(cq.Workplane().box(20, 20, 5), name="half \ud800")
    fixture = Fixture(cq.Workplane().box(3, 3, 3).translate((14, 0, 2)), name='=1+1,"\n\udfff')
    cutter = Cutter.parse("R2L30").asked(0.0, 0.0, Holder.parse("R20L30"))
    result = plan(part, cutters=cutter, fixtures=[fixture], faces="all", grid=5, area_budget=0)
    formats = ["json", "csv", "vtk", "png", "step", "glb", "html", "npz"]
    assert not result.write(tmp_path, formats).not_written
    rows = rows_of(tmp_path / "axes.csv")
    assert len(rows) == len(result.samples)
    assert '=1+1,"\n?' in {row["nearest_face"].removeprefix("fixture:") for row in rows}
    assert not any(text.startswith(("=", "+", "@")) for row in rows for text in row.values())


def test_formats_are_written_on_request_and_a_failure_costs_one_file(tmp_path, monkeypatch):
    result = plan("samples/v_groove.step", cutters="R4L50", grid=7, area_budget=0)
    written = result.write(tmp_path / "a", ["json", "csv", "vtk"])
    names = {path.name for path in (tmp_path / "a").iterdir()}
    assert names == {"plan.json", "process.toml", "axes.csv", "axes.vtp"}
    assert set(written.files) == {"csv", "vtk", "process"}

    def refuses(result):
        raise ValueError("no columns today")

    monkeypatch.setattr(to_csv, "_cells", refuses)
    written = result.write(tmp_path / "b", ["json", "csv", "vtk"])
    assert set(written.files) == {"vtk", "process"}
    assert "no columns today" in written.not_written["csv"]
    assert not (tmp_path / "b/axes.csv").exists()


@pytest.mark.slow("plans whole parts")
def test_the_examples_of_the_page_run(tmp_path, monkeypatch, capsys):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "docs/cam_outputs.md").read_text(), re.DOTALL)
    assert len(blocks) >= 3
    shutil.copytree(ROOT / "samples", tmp_path / "samples")
    monkeypatch.chdir(tmp_path)
    names: dict = {}
    for block in blocks:
        exec(compile(block, "cam_outputs.md", "exec"), names)
    assert capsys.readouterr().out.strip()
