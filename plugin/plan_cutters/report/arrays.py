"""Samples, verdicts, postures and operations as arrays and tables: npz, CSV, VTK and pandas, which is loaded here alone."""

import base64
import csv
import io
import json
import math
import zipfile
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from cad_io.arrays import Floats
from plan_cutters.domain.assembly import part_words
from plan_cutters.domain.travel import tips
from plan_cutters.domain.verdicts import CONCAVE, CONVEX, NO_REASON, REASONS, SADDLE, UNJUDGED, WORDS
from plan_cutters.errors import OptionError, PlanError
from plan_cutters.plan_file.shares import VERDICTS, AreaShare, VerdictCounts
from plan_cutters.plan_file.words.cutters import main_reason
from plan_cutters.plan_file.words.operations import steps_of
from plan_cutters.report.protocol import Judged
from plan_cutters.report.question import question_of
from plan_cutters.scene.conditions import rotations_of

if TYPE_CHECKING:
    from pandas import DataFrame

#: Parts of unit vectors are written to so many binary places at this tolerance, mm, and to more at smaller ones: rounding moves
#: the far end of a tool of 180 mm by less than 2 % of it.
_PLACES, _AT, _MOST_PLACES = 20, 0.01, 24
#: Positions of the machine are written of all cutters where there are no more than so many, else of those of the answer.
_MACHINE_CUTTERS = 8
#: Arrays of more bytes than this in all are packed harder: three times the time for a third less.
_LARGE = 20 << 20


def rounded(vector: Floats, tolerance: float) -> NDArray[np.float32]:
    """Unit vectors (n, 3) as files have them, for postures that hold to a tolerance, mm.

    >>> rounded(np.array([[0.6, 0.8, np.nan]]), 0.01).tolist()
    [[0.6000003814697266, 0.8000001907348633, nan]]
    """
    places = min(_MOST_PLACES, _PLACES + max(0, math.ceil(math.log2(_AT / tolerance))))
    return np.ldexp(np.rint(np.ldexp(vector, places)), -places).astype(np.float32)


def write_npz(result: Judged, _split: object, path: Path) -> None:
    """Write `samples.npz`: the samples, and per cutter verdict, axis, tilt_direction and reason with its id as suffix.

    Postures are `rounded`, in 32 bits, but for those of tools that slid: with many cutters they are nearly all of the file.

    `shift_ID`, where a flank or a flat that is not quite square serves, goes from the samples to where the tool is put down.

    Over several setups what one or another reaches, with the posture of the first that does: `setup_ID` is its index into
    `setups`, -1 where none does, and `reached_in_ID` says which do. `inside_bodies`: what is no surface of the finished part;
    `exempt`, where some is: what is not required at sharp inside edges.

    With a machine of rotary axes, also their positions at the posture found, in degrees: both solutions, axis by axis from the
    part to the tool, nan where one is beyond a limit, and which of them is to be taken, -1 where there is none. Where linear
    travel is judged, also the positions of the linear axes, mm, in the machine's order, for the solution to be taken. Where they
    were requested, also the largest radii with `flat` and `ball` as suffix.
    """
    samples, tolerance = result.samples, result.plan.effective.tolerance_mm
    machined = _machined(result)
    columns = ("point", "normal", "direction_max", "curvature", "uv", "face", "area")
    arrays: dict[str, Any] = {name: getattr(samples, name) for name in columns}
    arrays |= {"surface_class": result.surface_class, "inside_bodies": result.inside_bodies}
    if len(question := question_of(result)):
        arrays["question"] = question
    if result.exempt is not None:
        arrays["exempt"] = result.exempt
    for name, verdicts in result.reaches.items():
        arrays[f"verdict_{name}"] = verdicts.verdict
        # A tool that slid touches where its axis says: rounded, it would touch elsewhere.
        slid = bool(verdicts.shift.any())
        for word, vector in (("axis", verdicts.axis), ("lean", verdicts.tilt_direction)):
            arrays[f"{word}_{name}"] = vector if slid else rounded(vector, tolerance)
        arrays[f"reason_{name}"] = verdicts.reason
        if slid:
            arrays[f"shift_{name}"] = verdicts.shift
        if result.kinematics is not None and name in machined:
            angles, taken = result.rotary(name)
            if name in result.travels:
                arrays[f"travel_{name}"] = result.travels[name].position
            arrays[f"rotary_{name}"], arrays[f"rotary_taken_{name}"] = np.degrees(angles), taken
    if result.served_in:
        arrays["setups"] = np.array([axis for axis, _ in result.over_setups.each])
        for name, which in result.served_in.items():
            arrays[f"setup_{name}"] = which
            arrays[f"reached_in_{name}"] = np.stack([there[name].reached for _, there in result.over_setups.each], axis=1)
    for radii in result.answers.radius_maps:
        words = {"": radii.radius, "beyond_": radii.beyond, "axis_": radii.axis, "lean_": radii.tilt_direction}
        arrays |= {f"radius_{word}{radii.shape}": each for word, each in words.items()}
    write_arrays(arrays, path)


def state(result: Judged) -> tuple[Any, ...]:
    """All that samples of a part whose verdicts stand may still differ by."""
    return len(result.answers.radius_maps), sorted(_machined(result))


def _machined(result: Judged) -> set[str]:
    """Ids of the cutters whose positions of the machine are written: of many those of all steps, and the one shown."""
    plan = result.plan
    if len(result.reaches) <= _MACHINE_CUTTERS:
        return set(result.reaches)
    operations = [each for one in (plan.operations.plans if plan.operations else []) for each in one.operations]
    return {result.shown, *(each.cutter for each in plan.process.steps), *(each.cutter for each in operations)}


def write_postures(result: Judged, _split: object, path: Path) -> None:
    """Write `postures.npz`: the free tilts of every sample at every rotation, as in PostureMaps, for the cutter shown.

    Whatever the machine: what one holds of them is for the reader to find. `missing`: obstacles that are missing or guessed.
    """
    maps = result.maps
    assert maps is not None, "written where posture maps were requested"
    name = maps.cutter
    about = {"format": "plan-cutters-postures", "version": 3, "cutter": name, "part": maps.part, "tilt": maps.tilt,
             "tolerance": maps.tolerance, "missing": maps.missing, "unmapped": maps.unmapped}  # fmt: skip
    write_arrays({"about": np.array(json.dumps(about)), "rotation": maps.rotations, "normal": maps.normal,
            "direction_max": maps.direction_max, "inside": maps.inside, f"offset_{name}": maps.offset,
            f"free_{name}": maps.free, f"undecided_{name}": maps.undecided, f"verdict_{name}": maps.verdict,
            f"reason_{name}": maps.reason}, path)  # fmt: skip


def write_arrays(arrays: dict[str, Any], path: Path) -> None:
    way = zipfile.ZIP_LZMA if sum(np.asarray(array).nbytes for array in arrays.values()) > _LARGE else zipfile.ZIP_DEFLATED
    # numpy's own writer stamps the time: two runs would differ.
    with zipfile.ZipFile(path, "w") as archive:
        for key, array in arrays.items():
            buffer = io.BytesIO()
            np.lib.format.write_array(buffer, np.ascontiguousarray(array), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{key}.npy", (1980, 1, 1, 0, 0, 0)), buffer.getvalue(), way, compresslevel=1)


def write_operations(result: Judged, _split: object, path: Path) -> None:
    """Write `operations.npz`: of each plan what each sample goes with, and the candidates that the proof is about.

    Of the first plan, and of others with `_` and their name behind the words: `operation` (n,) int16, an index into its
    operations, -1 for none; `strip_mm`, the width of a pass; `seconds`, nan without a feed; `exclusive`, that no other operation
    serves it; `lean` (n, 3), where the tool leans, on a floor the side of its bottom that touches; `strategy`, 0: in a point,
    1: on a floor, 2: along a wall; `contact` (n, 3), where the tool touches as it cuts a sample of a wall, or one that it slid to
    along its flank or its upper face, else nan;
    `moving_axis` (n, 3), the axes proposed for simultaneous operations, else nan, and `moving_piece`, the proved piece of the
    operation about the sample, the largest first, -1 for none.
    `candidate_cutter` and `candidate_setup` (m,) are indices into the plan's cutters and setups, `candidate_angle` (m, k) is in
    degrees; beside a process of the planner's own there are none.
    """
    operations = result.answers.operations
    assert operations is not None, "written where operations were requested"
    ids, columns = [entry.id for entry in result.cutters], operations.candidates
    number = np.array([ids.index(cutter.id) for cutter in operations.cutters], np.int32)
    arrays: dict[str, Any] = {
        "candidate_cutter": number[columns.cutter], "candidate_setup": columns.setup, "candidate_angle": columns.angle,
        "candidate_axis": columns.axis, "chosen": operations.chosen,
    }  # fmt: skip
    for k, plan in enumerate(operations.plans):
        axis, piece = np.full((len(plan.label), 3), np.nan), np.full(len(plan.label), -1, np.int32)
        for each in plan.operations:
            if each.moving is not None:
                axis[each.rows], piece[each.rows] = (mine[each.rows] for mine in each.moving)
        made = {
            "operation": plan.label.astype(np.int16), "strip_mm": plan.strip, "path_mm": plan.length, "seconds": plan.seconds,
            "link_s": plan.link, "exclusive": plan.alone, "lean": plan.lean, "strategy": plan.strategy,
            "contact": plan.contact, "moving_axis": axis, "moving_piece": piece,
        }  # fmt: skip
        behind = f"_{plan.name.replace(' ', '_')}" if k else ""
        arrays |= {f"{word}{behind}": column for word, column in made.items()}
    write_arrays(arrays, path)


def write_operations_csv(result: Judged, _split: object, path: Path) -> None:
    """Write `operations.csv`: a header line, then a line for each operation of each plan; numbers have a point."""
    entry = result.plan.operations
    assert entry is not None, "written where operations were requested"
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\r\n")
        rows.writerow(["plan", "operation", "mode", "strategy", "cutter", "setup", *(f"{name}_deg" for name in entry.rotary),
                       "axis_x", "axis_y", "axis_z", "area_mm2", "share", "exclusive_mm2", "cut_length_mm", "seconds",
                       "link_seconds", "faces", "g68_2", "g53_1", "rotary_words", "step", "diameter_mm", "depth_mm", "pitch_mm",
                       "mouths_mm"])  # fmt: skip
        for plan in entry.plans:
            step = steps_of(result.plan, plan)
            for each in plan.operations:
                angles = each.angles_deg or {}
                axis = ("", "", "") if each.axis is None else [_rounded(x, 9) for x in each.axis]
                turned = [angles.get(name, "") for name in entry.rotary]
                rows.writerow([plan.name, each.id, each.mode, each.strategy, each.cutter, each.setup + 1, *turned, *axis,
                               _rounded(each.area_mm2), _rounded(each.share, 6), _rounded(each.exclusive_mm2),
                               _rounded(each.cut_length_mm), _rounded(each.seconds), _rounded(each.link_seconds),
                               " ".join(face.face for face in each.faces), each.g68_2 or "", each.g53_1 or "",
                               each.rotary_words or "", step.get(each.id, ""), "", "", "", ""])  # fmt: skip
        process = result.plan.process
        for number, bores in enumerate(process.drilling, len(process.steps) + 1):
            turned = [(bores.angles_deg or {}).get(name, "") for name in entry.rotary]
            faces = dict.fromkeys(face for stroke in bores.holes for face in result.plan.holes[stroke.hole].faces)
            mouths = "; ".join(" ".join(f"{_rounded(x)}" for x in stroke.mouth_mm) for stroke in bores.holes)
            rows.writerow(["drilling", f"step {number}", "fixed", bores.kind, bores.tool, bores.setup + 1, *turned,
                           *(_rounded(x, 9) for x in bores.axis), "", "", "", "", _rounded(bores.seconds),
                           _rounded(bores.link_seconds), " ".join(faces), bores.g68_2 or "", bores.g53_1 or "",
                           bores.rotary_words or "", number, _rounded(bores.diameter_mm), _rounded(bores.depth_mm),
                           _rounded(bores.pitch_mm), mouths])  # fmt: skip


def _rounded(value: float | None, digits: int = 3) -> float | str:
    """A number as people read it in a table: plan.json has all digits. Nothing is empty."""
    return "" if value is None else round(value, digits) + 0.0


CLASSES = {CONVEX: "convex", CONCAVE: "concave", SADDLE: "saddle", UNJUDGED: "unjudged"}
#: Digits behind the point of lengths, mm, angles, deg, and parts of unit vectors.
_MM, _DEG, _UNIT = 6, 6, 9


@dataclass(frozen=True, slots=True)
class Column:
    """One column, or three of a vector. A name has its unit at the end where it has one: `tilt_deg`."""

    name: str
    values: NDArray[Any]  #: (n,) or (n, 3).
    digits: int = 0  #: Behind the point, for text.
    words: dict[int, str] | None = None  #: Of codes, for text.

    @property
    def names(self) -> list[str]:
        """One name for each column of text: a vector's parts stand before its unit, as in `point_x_mm`."""
        if self.values.ndim == 1:
            return [self.name]
        stem, dash, unit = self.name.rpartition("_") if self.name.endswith("_mm") else (self.name, "", "")
        return [f"{stem}_{axis}{dash}{unit}" for axis in "xyz"]


def columns(result: Judged, cutter_id: str | None = None) -> list[Column]:
    """The columns, in their order, a row for each sample in the order of `samples.npz`; default of the cutter shown."""
    samples, name = result.samples, cutter_id or result.shown
    verdicts, cutter = result.reaches[name], result.judged(name)
    near = result.clearances if name == result.shown else result.clearances_of(name)
    surroundings = result.conditions.surroundings
    n = len(samples)
    rotation = np.degrees(rotations_of(samples.normal, samples.direction_max, verdicts.tilt_direction))
    rotation[~verdicts.reached] = np.nan
    faces = {number: surroundings.called(number) for number in np.unique(near.face).tolist() if number}
    table = [
        Column("sample", np.arange(n, dtype=np.int32)),
        Column("face", samples.face, words={f: f"F{f}" for f in np.unique(samples.face).tolist()}),
        Column("point_mm", samples.point, _MM),
        Column("normal", samples.normal, _UNIT),
        Column("area_mm2", samples.area, _MM),
        Column("surface_class", result.surface_class, words=CLASSES),
        Column("verdict", verdicts.verdict, words=WORDS),
        Column("reason", verdicts.reason, words=dict(enumerate(REASONS)) | {NO_REASON: ""}),
        Column("axis", verdicts.axis, _UNIT),
        Column("lean", verdicts.tilt_direction, _UNIT),
        Column("tilt_deg", np.degrees(verdicts.tilt), _DEG),
        Column("rotation_deg", rotation, _DEG),
        Column("tip_mm", tips(cutter, samples.point, samples.normal, verdicts), _MM),
        Column("clearance_mm", near.distance, _MM),
        Column("nearest_part", near.part, words={-1: "", **part_words()}),
        Column("nearest_face", near.face, words={0: "", **faces}),
    ]
    if name in result.served_in:
        setups = range(len(result.over_setups.each))
        table.append(Column("setup", result.served_in[name], words={-1: "", **{k: str(k) for k in setups}}))
    # Positions of the machine's axes: those to take, then the rotary ones of the other solution; linear ones where judged.
    machine = result.conditions.machine
    if result.kinematics is None:
        return table
    angles, taken = result.rotary(name)
    first, rows = np.maximum(taken, 0).astype(np.int64), np.arange(len(taken))
    for word, way in (("", first), ("_other", 1 - first)):
        each = np.where((taken >= 0)[:, None], np.degrees(angles[rows, way]), np.nan).T
        table += [Column(f"{axis.name}{word}_deg", own.copy(), _DEG) for axis, own in zip(machine.rotary, each, strict=False)]
    if (moved := result.travels.get(name)) is not None:
        each = moved.position.T
        table += [Column(f"{axis.name}_mm", own.copy(), _MM) for axis, own in zip(machine.linear, each, strict=False)]
    return table


def write_csv(result: Judged, _split: object, path: Path) -> None:
    """Write `axes.csv`: a header line, then a line for each sample, for the cutter shown; what is not known is empty.

    Lines end as RFC 4180 has it, numbers have a point, units stand at the end of the names. `docs/cam_outputs.md` has the
    columns.
    """
    table = columns(result)
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\r\n")
        rows.writerow(["cutter", *(name for column in table for name in column.names)])
        cells = (text for column in table for text in _cells(column))
        rows.writerows(zip([result.shown] * len(result.samples), *cells, strict=True))


def _worded(column: Column, empty: Any = "") -> NDArray[Any]:
    assert column.words is not None
    codes, index = np.unique(column.values, return_inverse=True)
    words: NDArray[Any] = np.array([column.words[code] or empty for code in codes.tolist()], object)[index]
    return words


def _cells(column: Column) -> list[list[Any]]:
    values = column.values
    if column.words is not None:
        return [_worded(column).tolist()]
    if values.dtype.kind != "f":
        return [values.tolist()]
    # Adding zero turns -0.0 into 0.0.
    rounded = np.round(values, column.digits) + 0.0
    cells = rounded.astype(object)
    cells[~np.isfinite(rounded)] = ""
    return [each.tolist() for each in np.atleast_2d(cells.T)]


_TYPE = {"float64": "Float64", "float32": "Float32", "int64": "Int64", "int32": "Int32", "int8": "Int8", "uint8": "UInt8"}
#: Bytes of a block that is deflated by itself.
_BLOCK = 1 << 20


def write_vtk(result: Judged, _split: object, path: Path) -> None:
    """Write `axes.vtp`: a vertex for each sample, with the columns of `axes.csv` as point data; codes stay numbers.

    What the codes mean stands in the field data, as texts: `verdicts`, `reasons`, `classes`, `parts`, `fixtures`,
    `cutter`, `part`.
    """
    arrays = {column.name: column.values for column in columns(result)}
    point, n = arrays.pop("point_mm"), len(result.samples)
    about = {
        "cutter": [result.shown],
        "part": [Path(result.part.file).name if result.part.file else ""],
        "verdicts": [f"{code} {word}" for code, word in sorted(WORDS.items())],
        "reasons": [f"{code} {word}" for code, word in enumerate(REASONS)],
        "classes": [f"{code} {word}" for code, word in sorted(CLASSES.items())],
        "parts": [f"{code} {word}" for code, word in sorted(part_words().items())],
        "fixtures": [f"{each.number} {each.name}" for each in result.conditions.surroundings.fixtures],
    }
    text = [
        '<?xml version="1.0"?>',
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64" '
        'compressor="vtkZLibDataCompressor">',
        "<PolyData>", "<FieldData>", *(_texts(name, lines) for name, lines in about.items()), "</FieldData>",
        f'<Piece NumberOfPoints="{n}" NumberOfVerts="{n}" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0">',
        '<PointData Scalars="verdict" Vectors="axis" Normals="normal">',
        *(_array(name, values) for name, values in arrays.items()),
        "</PointData>", "<CellData></CellData>", "<Points>", _array("Points", point), "</Points>",
        "<Verts>", _array("connectivity", np.arange(n, dtype=np.int64)), _array("offsets", np.arange(1, n + 1, dtype=np.int64)),
        "</Verts>", "</Piece>", "</PolyData>", "</VTKFile>",
    ]  # fmt: skip
    path.write_text("\n".join(text) + "\n", encoding="ascii", errors="xmlcharrefreplace")


def _array(name: str, values: NDArray[Any]) -> str:
    """An array in blocks that are deflated one by one, behind their sizes: both in base64, each by itself."""
    kind = _TYPE[values.dtype.name]
    parts = f' NumberOfComponents="{values.shape[1]}"' if values.ndim == 2 else ""
    data = np.ascontiguousarray(values, values.dtype.newbyteorder("<")).tobytes()
    blocks = [zlib.compress(data[start : start + _BLOCK], 6) for start in range(0, len(data), _BLOCK)]
    sizes = np.array([len(blocks), _BLOCK, len(data) % _BLOCK, *map(len, blocks)], "<u8")
    packed = "".join(base64.b64encode(each).decode() for each in (sizes.tobytes(), b"".join(blocks)))
    return f'<DataArray type="{kind}" Name={quoteattr(name)}{parts} format="binary">{packed}</DataArray>'


def _texts(name: str, lines: list[str]) -> str:
    """An array of texts: the codes of their bytes, a zero behind each."""
    codes = b"".join(line.encode() + b"\0" for line in lines)
    numbers = " ".join(map(str, codes))
    return f'<Array type="String" Name={quoteattr(name)} NumberOfTuples="{len(lines)}" format="ascii">{numbers}</Array>'


def frame(result: Judged, of: str, cutter: str | None) -> "DataFrame":
    """A table of the rows asked for: `samples` or `faces`, both of one cutter, or `cutters`.

    An OptionError where there is no such table or cutter, a PlanError where pandas is not installed.
    """
    if of not in _TABLES:
        raise OptionError(f"there is no table of {of!r}; give one of {', '.join(_TABLES)}")
    if of == "cutters" and cutter is not None:
        raise OptionError("the table of cutters has all of them: leave out cutter=")
    try:
        import pandas
    except ImportError:
        raise PlanError("tables need the package pandas: pip install pandas") from None
    table = pandas.DataFrame(_TABLES[of](result, result.judged(cutter).id))
    # A column of words knows them all, and keeps their order.
    plan = result.plan
    in_order = {
        "verdict": list(WORDS.values()), "reason": plan.reasons, "surface_class": list(CLASSES.values()),
        "face": [face.id for face in plan.faces], "cutter": [each.id for each in plan.cutters],
    }  # fmt: skip
    for name, words in in_order.items():
        if name in table:
            others = [word for word in table[name].dropna().unique() if word not in words]
            table[name] = pandas.Categorical(table[name], categories=[*words, *others])
    if "feasible" in table:
        table["feasible"] = table["feasible"].astype("boolean")  # which knows "not decided"
    return table


def _samples(result: Judged, cutter: str) -> dict[str, Any]:
    """The columns of `axes.csv`; None where a word is empty."""
    table: dict[str, Any] = {"cutter": [cutter] * len(result.samples)}
    for column in columns(result, cutter):
        if column.words is not None:
            table[column.name] = _worded(column, None)
            continue
        values = column.values + 0.0 if column.values.dtype.kind == "f" else column.values  # -0.0 becomes 0.0
        table |= dict(zip(column.names, np.atleast_2d(values.T), strict=True)) if values.ndim > 1 else {column.name: values}
    return table


def _faces(result: Judged, cutter: str) -> list[dict[str, Any]]:
    """Give a row for each face of the part: shares are nan where it was not sampled."""
    entry, rows = next(each for each in result.cutters if each.id == cutter), []
    for face in result.plan.faces:
        about = {"face": face.id, "name": face.name, "component": face.component, "surface": face.surface, "shape": face.shape,
                 "target": face.target, "ignored": face.ignored, "area_mm2": face.area_mm2, "samples": face.samples,
                 "unjudged_why": face.unjudged, "cutter": entry.id}  # fmt: skip
        known = entry.faces.get(face.id)
        deep = [w for w in entry.witnesses if w.face == face.id and not w.inside_bodies and w.depth_mm is not None]
        worst = max(deep, key=lambda w: w.depth_mm or 0.0, default=None) if known else None
        rows.append({
            **about, **_verdicts(known or VerdictCounts(), known.area_share if known else None),
            "reason": (main_reason(known.area_share) or None) if known else None,
            "depth_mm": worst.depth_mm if worst else np.nan, "obstacle": worst.obstacle_face if worst else None,
        })  # fmt: skip
    return rows


def _cutters(result: Judged, _cutter: str) -> list[dict[str, Any]]:
    """Give a row for each cutter, from the most wanted down; `feasible` is missing where it is not decided."""
    return [
        {"cutter": c.id, "name": c.name, "shape": c.shape, "radius_mm": c.radius, "corner_radius_mm": c.corner_radius,
         "length_mm": c.length, "holder": c.holder or None, "selected": c.id == result.selected, "feasible": c.feasible,
         **_verdicts(c, c.area_share), "reason": main_reason(c.area_share) or None}
        for c in result.cutters
    ]  # fmt: skip


def _verdicts(counts: VerdictCounts, share: AreaShare | None) -> dict[str, Any]:
    """Counts of samples by verdict, and shares of the area, 0 to 1."""
    shares = {f"{word}_share": getattr(share, word) if share else np.nan for word in VERDICTS}
    return {**{word: counts.of(word) for word in WORDS.values()}, "inside_bodies": counts.inside_bodies, **shares}


_TABLES: dict[str, Callable[[Judged, str], Any]] = {"samples": _samples, "faces": _faces, "cutters": _cutters}
