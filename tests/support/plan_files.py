"""Plans without a part: made of faces and of the shares that cutters reach of them."""

from collections import Counter

from plan_cutters.plan_file.model import (
    NO_TEXT,
    CutterEntry,
    Effective,
    FaceEntry,
    MachineEntry,
    Plan,
    Run,
    SampleCounts,
    Selection,
    nearest,
)  # fmt: skip
from plan_cutters.plan_file.operations import ProcessEntry, ProcessStep, RemainingEntry
from plan_cutters.plan_file.part_info import OrientationInfo, PartInfo, Scope
from plan_cutters.plan_file.shares import AreaShare, FaceVerdicts

#: Samples of each face.
SAMPLES = 1000


def face(number, *, area=100.0, centre=None, name="", shape="sculptured", target=True, carrier=None, neighbours=None):
    """A face that is at a place of its own, unless one is given."""
    return FaceEntry(id=f"F{number}", name=name, surface="bspline", shape=shape, kind=shape, target=target, area_mm2=area,
                     centre_mm=(float(number), 0.0, 0.0) if centre is None else centre, component="", samples=SAMPLES,
                     unjudged=None, carrier=carrier, neighbours=neighbours)  # fmt: skip


def verdicts(inaccessible=0, undecided=0, reason="holder"):
    """Verdicts of a face of which so many samples of 1000 are not reached."""
    share = AreaShare(accessible=1 - (inaccessible + undecided) / SAMPLES, inaccessible=inaccessible / SAMPLES,
                      undecided=undecided / SAMPLES,
                      lost_by={reason: (inaccessible + undecided) / SAMPLES} if inaccessible + undecided else {})  # fmt: skip
    return FaceVerdicts(accessible=SAMPLES - inaccessible - undecided, inaccessible=inaccessible, undecided=undecided,
                        area_share=share)  # fmt: skip


def cutter(name, on_faces, *, radius=6.0, length=80.0, holder=""):
    """A cutter with its verdicts by face id."""
    lost = sum(v.inaccessible for v in on_faces.values())
    unsure = sum(v.undecided for v in on_faces.values())
    count = max(1, SAMPLES * len(on_faces))
    share = AreaShare(accessible=1 - (lost + unsure) / count, inaccessible=lost / count, undecided=unsure / count,
                      lost_by={"holder": (lost + unsure) / count} if lost + unsure else {})  # fmt: skip
    return CutterEntry(id=name, name="", group="flat", radius=radius, corner_radius=0.0, length=length, holder=holder,
                       feasible=False if lost else None if unsure else True, march_differs=0, by_reason={},
                       undecided_by_reason={}, faces=on_faces, area_share=share, witnesses=[], inaccessible=lost,
                       undecided=unsure, accessible=count - lost - unsure)  # fmt: skip


def process_of(faces, cutter):
    """The process of one cutter alone."""
    area, reached = sum(f.area_mm2 for f in faces if f.target), cutter.area_share.accessible
    names = [f.id for f in faces if f.target]
    left = [RemainingEntry(cause=cause, area_mm2=share * area, share=share, samples=1, faces=names, place_mm=None)
            for cause, share in cutter.area_share.lost_by.items()]  # fmt: skip
    step = ProcessStep(setup=0, mode="any", angles_deg=None, axis=None, cutter=cutter.id, faces=names, area_mm2=reached * area,
                       share=reached, seconds=None, clearance_mm=None)  # fmt: skip
    return ProcessEntry(steps=[step], finished_share=reached, finished_mm2=reached * area, asked_mm2=area, left=left,
                        seconds=None)  # fmt: skip


def scope_of(faces):
    """All faces by their kinds."""
    kinds, area = Counter(f.kind for f in faces if f.target), sum(f.area_mm2 for f in faces if f.target)
    return Scope(judged=kinds.total(), judged_mm2=area, not_judged=0, not_judged_mm2=0.0, judged_by_kind=kinds,
                 not_judged_by_kind={})  # fmt: skip


def made(faces, cutters, *, sha="a", size=(100.0, 100.0, 100.0), effective=None, **more):
    """A plan of faces and cutters; `effective`: options that are otherwise."""
    asked = Effective(cutters=[c.id for c in cutters], cutter_source="given", machine="unlimited", setup=(0.0, 0.0, 1.0),
                      faces="all", target_faces=[f.id for f in faces if f.target], grid=None, spacing_mm=None,
                      tilt_deg=(0.0, 90.0), rotation_deg=(0.0, 360.0), rotation_step_deg=10.0, tolerance_mm=0.01,
                      chord_error_mm=0.001, obstacle_triangles=1, flip=False, area_budget=0, posture_maps=False,
                      answers=[])  # fmt: skip
    chosen = min((c.id for c in cutters if c.feasible), default=None)
    shown = next((c for c in cutters if c.id == chosen), None) or nearest(cutters)
    more = {"process": process_of(faces, shown), "scope": scope_of(faces), "shown": shown.id, "note_codes": []} | more
    return Plan(
        text=NO_TEXT,
        part=PartInfo(file="part.step", sha256=sha, size_mm=size, solids=1, faces=len(faces),
                      orientation=OrientationInfo(method="solid", confident=True), warnings=[]),
        effective=asked.model_copy(update=effective or {}), versions={"plan_cutters": "0"},
        samples=SampleCounts(count=1, max_gap_mm=1.0, convex=1, concave=0, saddle=0, unjudged=0, regions=1), faces=faces,
        missing=[], reasons=[], machine=MachineEntry(name="unlimited", tilt_limit_deg=None, rotary=None, notes=[]),
        cutters=cutters, selected=chosen, selection=Selection(rule="", runner_up=None, why=""), notes=[], legend={},
        run=Run(time="", seconds={}), **more)  # fmt: skip
