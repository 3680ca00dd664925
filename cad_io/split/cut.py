"""Cut shapes by edges that lie on their faces, and tell whether the result can be trusted.

The kernel estimates how far an edge is from its face by projecting eleven points of it. On rough faces (slopes that
change by 45 deg within a span) a projection may end on another slope, millimetres off (OCCT 7.9), and the edge's
tolerance then swallows what is near it. So tolerances are among the things checked, and there is a remedy (`denser`).
"""

import io
import pickle
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple

from OCP.BinTools import BinTools
from OCP.BRep import BRep_Builder, BRep_Tool
from OCP.BRepAlgoAPI import BRepAlgoAPI_Splitter
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepTools import BRepTools
from OCP.OSD import OSD_ThreadPool
from OCP.ShapeAnalysis import ShapeAnalysis_ShapeTolerance
from OCP.TopAbs import TopAbs_COMPOUND, TopAbs_EDGE, TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID
from OCP.TopoDS import TopoDS, TopoDS_Shape, TopoDS_Shell, TopoDS_Solid
from OCP.TopTools import TopTools_ListOfShape

from cad_io.face.uv_region import uv_area
from cad_io.kernel import explore, shape_map
from cad_io.kernel.components import as_one, children, compound
from cad_io.kernel.limited import KERNEL_THREADS, ChildDied, TimeLimit, limited
from cad_io.split.denser import denser

#: Points closer than this are one, mm: what the kernel's splitter was tried with.
FUZZY = 1e-4
#: What a cut may add to the largest tolerance of a shape, mm.
_LOOSER = 0.1
#: Why a face is not cut if the limit ended the work.
TOO_LONG = "splitting it takes too long"
#: Relative error of a face's parameter area that is still the same area.
_SAME_AREA = 1e-5


@dataclass(frozen=True, slots=True)
class Job:
    """A shape, all its faces by number, and the edges on some of them that are to cut it.

    `rough` tells into how many parts the spans of a face's surface are cut while the kernel works.
    """

    shape: Any
    faces: dict[int, Any]
    edges: list[Any]
    rough: dict[int, int] = field(default_factory=dict)

    @property
    def work(self) -> int:
        """How much work the cut is, roughly in milliseconds; counted, not measured."""
        return 50 + 2 * len(self.faces) + 20 * len(self.edges)


@dataclass(frozen=True, slots=True)
class Cut:
    """A shape after the cut, and which of its faces each original face became (number -> TopoDS_Face list)."""

    shape: Any
    pieces: dict[int, list[Any]]


class Fault(NamedTuple):
    """Why a cut is no good, and the face that it is about, if it is about one."""

    reason: str
    face: int | None = None


def cut(jobs: Sequence[Job], seconds: float) -> list[Cut | Fault]:
    """Cut shapes by edges on their faces, in a process of its own with a limit of processor time.

    Parameters
    ----------
    jobs : sequence of Job
        The shapes are left as they are.
    seconds : float
        Of processor time, for all jobs together: a guard against calls that never end. What else the machine does has
        no say, or the same part would be shown otherwise on a busy one.

    Returns
    -------
    list of Cut or Fault
        For each job a copy of the shape, cut; or why the cut is no good: the kernel fails, hangs or crashes, the result
        is invalid where the shape was valid, solids, shells or their closedness differ, edges are much looser than
        they were, a face is lost, or the pieces of a face do not have its area. Areas are those of the region in the
        parameter plane, integrated exactly along its boundary: pieces that tile the region there tile the face, and
        the kernel's own areas in mm2 are off by up to 9 % on some surfaces.
    """
    try:
        answers = pickle.loads(limited(partial(_answers, jobs), seconds, processor=True))
    except TimeLimit:
        return [Fault(TOO_LONG)] * len(jobs)
    except ChildDied as error:
        return [Fault(f"splitting it fails: {error}")] * len(jobs)
    return [
        Fault(*answer) if isinstance(answer, tuple) else _unpacked(answer, job)
        for job, answer in zip(jobs, answers, strict=True)
    ]


def _answers(jobs: Sequence[Job]) -> bytes:
    return pickle.dumps([_cut(job) for job in jobs])


def _cut(job: Job) -> bytes | Fault:
    """What `_unpacked` takes, or why there is none."""
    tools, arguments = TopTools_ListOfShape(), TopTools_ListOfShape()
    skin = _skin(job.shape)
    arguments.Append(skin or job.shape)
    for edge in job.edges:
        tools.Append(edge)
    splitter = BRepAlgoAPI_Splitter()
    splitter.SetArguments(arguments)
    splitter.SetTools(tools)
    splitter.SetFuzzyValue(FUZZY)
    splitter.SetNonDestructive(True)
    # The result is the same, byte for byte.
    threads = KERNEL_THREADS.get()
    if threads > 1:
        OSD_ThreadPool.DefaultPool_s(threads)
        splitter.SetRunParallel(True)
    # In place, which a copy of the process may do.
    with denser((job.faces[n], parts) for n, parts in job.rough.items()):
        splitter.Build()
    if not splitter.IsDone():
        return Fault("the kernel cannot split it")
    result = splitter.Shape()
    # Ends of curves past the trim would stay as loose edges inside solids and faces.
    BRepTools.RemoveInternals_s(result, False)
    if result.ShapeType() == TopAbs_COMPOUND != job.shape.ShapeType() and len(inner := children(result)) == 1:
        result = inner[0]
    known = shape_map(result, TopAbs_FACE)
    pieces: dict[int, list[Any]] = {}
    for number, face in job.faces.items():
        images = list(splitter.Modified(face)) or [face]
        if splitter.IsDeleted(face) or not all(map(known.Contains, images)):
            return Fault(f"splitting loses a piece of F{number}", number)
        # From the map: with the orientation that the face has in the result.
        pieces[number] = [known.FindKey(known.FindIndex(f)) for f in images]
    if skin:
        result = _filled(job, pieces)
    fault = _wrong(job, result, pieces)
    if fault:
        return fault
    # One compound of the cut shape and, for every face, the compound of its pieces: sharing survives.
    stream = io.BytesIO()
    BinTools.Write_s(compound([result, *(compound(p) for p in pieces.values())]), stream)
    return stream.getvalue()


def _skin(shape: Any) -> Any | None:
    """The shells of a solid, if they hold nothing but faces, each once; else None.

    Of a solid, the kernel asks for every edge that cuts it whether it lies inside, and for that all faces: with hundreds of
    edges, nearly all of its time goes there (OCCT 7.9).
    """
    if shape.ShapeType() != TopAbs_SOLID:
        return None
    shells = children(shape)
    if any(shell.ShapeType() != TopAbs_SHELL for shell in shells):
        return None
    within = [face for shell in shells for face in children(shell)]
    if any(face.ShapeType() != TopAbs_FACE for face in within):
        return None
    return as_one(shells) if len(within) == shape_map(shape, TopAbs_FACE).Extent() else None


def _filled(job: Job, pieces: dict[int, list[Any]]) -> Any:
    """A solid again, of the pieces of its faces."""
    known, numbers = shape_map(job.shape, TopAbs_FACE), list(job.faces)
    builder, solid = BRep_Builder(), TopoDS_Solid()
    builder.MakeSolid(solid)
    for old in children(job.shape):
        shell = TopoDS_Shell()
        builder.MakeShell(shell)
        for face in children(old):
            for piece in pieces[numbers[known.FindIndex(face) - 1]]:
                builder.Add(shell, piece)
        shell.Closed(BRep_Tool.IsClosed_s(shell))
        builder.Add(solid, shell)
    return solid


def _unpacked(data: bytes, job: Job) -> Cut:
    whole = TopoDS_Shape()
    BinTools.Read_s(whole, io.BytesIO(data))
    result, *groups = children(whole)
    return Cut(result, {n: [TopoDS.Face_s(f) for f in children(g)] for n, g in zip(job.faces, groups, strict=True)})


def _wrong(job: Job, result: Any, pieces: dict[int, list[Any]]) -> Fault | None:
    """Why a result is not to be trusted, if so."""
    if _shells(job.shape) != _shells(result):
        return Fault("splitting changes solids or shells")
    tolerance = ShapeAnalysis_ShapeTolerance().Tolerance
    allowed = tolerance(job.shape, 1) + _LOOSER
    for number, face in job.faces.items():
        # The loose edge is on the face that spoils the cut; its vertices are on neighbours, too.
        loosest = max(tolerance(piece, 1, TopAbs_EDGE) for piece in pieces[number])
        if not loosest <= allowed:
            return Fault(f"splitting leaves gaps of up to {loosest:.2g} mm", number)
        if len(pieces[number]) == 1 and pieces[number][0].IsSame(face):
            continue
        before, after = uv_area(face), sum(uv_area(TopoDS.Face_s(p)) for p in pieces[number])
        if not abs(after - before) <= _SAME_AREA * abs(before):
            return Fault(f"the pieces of F{number} do not have its area", number)
    if (
        not BRepCheck_Analyzer(result, True, KERNEL_THREADS.get() > 1).IsValid()
        and BRepCheck_Analyzer(job.shape).IsValid()
    ):
        bad = (n for n in pieces if not all(BRepCheck_Analyzer(piece).IsValid() for piece in pieces[n]))
        return Fault("splitting makes the shape invalid", next(bad, None))
    return None


def _shells(shape: Any) -> tuple[int, list[bool]]:
    """Number of solids; closedness of all shells, sorted."""
    closed = [bool(BRep_Tool.IsClosed_s(shell)) for shell in explore(shape, TopAbs_SHELL)]
    return shape_map(shape, TopAbs_SOLID).Extent(), sorted(closed)
