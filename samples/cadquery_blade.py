"""A blade in CadQuery: which ball end finishes it beside its platform, and how short can it be held?

`python samples/cadquery_blade.py`, or open it in CQ-editor: it shows the verdicts with the tool at the worst spot.
"""

import cadquery as cq

from plan_cutters import Cutter
from plan_cutters.hosts import holder
from plan_cutters.hosts.cadquery import assembly, register

# The part: a twisted blade that stands on a platform, with a fillet of 4 mm between them.
platform = cq.Workplane().box(60, 40, 8, centered=(True, True, False))
foot = cq.Workplane().workplane(offset=8).ellipse(20, 8)
blade = foot.workplane(offset=30).transformed(rotate=(0, 0, 25)).ellipse(17, 6).loft()
part = platform.union(blade).edges(cq.selectors.BoxSelector((-21, -9, 7.9), (21, 9, 8.1))).fillet(4)

# The holder as it is drawn: half of its section, turned about the z axis; its nose is at the bottom.
section = cq.Workplane("XZ").polyline([(0, 0), (10, 0), (14, 6), (14, 30), (22, 30), (22, 60), (0, 60)]).close()
chuck = holder(section, name="collet chuck")

# What holds the part: a jaw at each side of the platform.
jaw = cq.Workplane().box(70, 20, 20, centered=(True, False, False))
jaws = [jaw.translate((0, 20, -14)), jaw.translate((0, -40, -14))]

register()
cutters = [Cutter.ball(radius=r, length=length, flutes=2 * r, holder=chuck) for r, length in ((6, 30), (3, 45))]
# The targets: the blade and its fillet. A selector of CadQuery picks what is neither plane nor round.
result = part.faces("%BSPLINE").plan_cutters(cutters=cutters, fixtures=jaws, spacing=3.0, tolerance=0.02, area_budget=0)

for cutter in result.cutters:
    for face in result.faces(cutter=cutter.id, stick_out=cutter.id == result.selected):
        held = face.least_stick_out and f"{face.least_stick_out:.1f} mm"
        print(f"{cutter.id}: reaches {face.reached:.2%} of {face.id}; lost for: {face.reason}; least stick-out: {held}")

failing = next((cutter.id for cutter in result.cutters if not cutter.feasible), result.shown)
verdicts = assembly(result, cutter=failing, at=result.faces(cutter=failing)[0].worst)
if "show_object" in globals():  # in CQ-editor
    globals()["show_object"](verdicts, name="verdicts")
