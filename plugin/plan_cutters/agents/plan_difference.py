"""Two plans as an agent compares them: what was lost and won, face by face and cutter by cutter."""

from plan_cutters.agents.answers import ChangedRow, PlanDifferenceAnswer, first
from plan_cutters.comparison.plans import compare
from plan_cutters.comparison.wording import called, cutter_rows, face_rows, headline, mark, remarks
from plan_cutters.plan_file.model import Plan


def difference(old: Plan, new: Plan, most: int) -> PlanDifferenceAnswer:
    """What became of the faces and cutters; of plans that are not comparable the reasons alone."""
    found = compare(old, new, name=new.part.file or "part")
    texts = [row[-2:] for row in face_rows(found)]
    faces = [
        ChangedRow(name=called(each.old, each.new), what=mark(each), was=was, now=now)
        for each, (was, now) in zip(found.faces, texts, strict=False)
    ]
    cutters = [
        ChangedRow(name=row[1], what=mark(each), was=row[2], now=row[3], changed=row[-1])
        for each, row in zip(found.cutters, cutter_rows(found), strict=False)
    ]
    shown, more_faces = first(faces, most)
    named, more_cutters = first(cutters, most)
    open_faces, more_open = first(found.unreachable if found.comparable else [], most)
    return PlanDifferenceAnswer(
        part=new.part.file or "", told="\n".join([headline(found), *found.why_not, *remarks(found)]), comparable=found.comparable,
        why_not=found.why_not, lost=found.lost if found.comparable else None, won=found.won if found.comparable else None,
        selected=[*found.selected], faces=shown, more_faces=more_faces, cutters=named, more_cutters=more_cutters,
        unreachable=open_faces, more_unreachable=more_open,
    )  # fmt: skip
