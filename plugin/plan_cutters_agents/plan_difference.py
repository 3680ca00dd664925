"""Compare two plans for an agent, face by face and cutter by cutter."""

from plan_cutters.plan_file.model import Plan
from plan_cutters_agents.answers import ChangedRow, PlanDifferenceAnswer, first
from plan_cutters_ci.plans import compare
from plan_cutters_ci.wording import called, cutter_rows, face_rows, headline, mark, remarks


def difference(old: Plan, new: Plan, most: int) -> PlanDifferenceAnswer:
    """Say what became of the faces and cutters; of plans that are not comparable the reasons alone."""
    result = compare(old, new, name=new.part.file or "part")
    texts = [row[-2:] for row in face_rows(result)]
    faces = [
        ChangedRow(name=called(each.old, each.new), what=mark(each), was=was, now=now)
        for each, (was, now) in zip(result.faces, texts, strict=False)
    ]
    cutters = [
        ChangedRow(name=row[1], what=mark(each), was=row[2], now=row[3], changed=row[-1])
        for each, row in zip(result.cutters, cutter_rows(result), strict=False)
    ]
    shown, more_faces = first(faces, most)
    named, more_cutters = first(cutters, most)
    sentences = "\n".join([headline(result), *result.why_not, *remarks(result)])
    open_faces, more_open = first(result.unreachable if result.comparable else [], most)
    return PlanDifferenceAnswer(
        part=new.part.file or "", told=sentences, comparable=result.comparable,
        why_not=result.why_not, lost=result.lost if result.comparable else None, won=result.won if result.comparable else None,
        selected=[*result.selected], faces=shown, more_faces=more_faces, cutters=named, more_cutters=more_cutters,
        unreachable=open_faces, more_unreachable=more_open,
    )  # fmt: skip
