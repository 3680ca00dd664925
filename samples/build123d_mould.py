"""A mould half in build123d: which cutter finishes the cavity, and what is in the way of the one that does not?

`python samples/build123d_mould.py`; with ocp_vscode it shows the verdicts with the tool at the worst spot.
"""

import build123d as bd

from plan_cutters import Cutter, plan
from plan_cutters.hosts import holder
from plan_cutters.hosts.build123d import compound

# The part: a block with a deep, drafted cavity whose floor is rounded.
block = bd.Pos(0, 0, -20) * bd.Box(80, 60, 40)
cavity = bd.extrude(bd.RectangleRounded(50, 30, 10), -28, taper=5)
half = block - bd.fillet(cavity.faces().sort_by(bd.Axis.Z)[0].edges(), 4)
half.label = "mould half"

# The targets: all faces of the cavity, that is, those which lie within the block.
targets = half.faces().filter_by(lambda face: face.bounding_box().size.X < 55 and face.bounding_box().size.Y < 55)

# The holder as a sketch in a plane through its axis; its nose is at the bottom.
with bd.BuildSketch(bd.Plane.XZ) as section:
    with bd.BuildLine():
        bd.Polyline((0, 0), (12, 0), (16, 8), (16, 60), (0, 60), (0, 0))
    bd.make_face()
chuck = holder(section.sketch, name="shrink chuck")

# What holds the part: two clamps on the block's top.
clamp = bd.Box(12, 20, 12, align=(bd.Align.CENTER, bd.Align.CENTER, bd.Align.MIN))
clamp.label = "clamp"
clamps = [bd.Pos(x, 0, 0) * clamp for x in (-34, 34)]

cutters = [Cutter.ball(radius=4, length=length, flutes=8.0, shank_radius=4.0, holder=chuck) for length in (20, 60)]
result = plan(half, faces=targets, cutters=cutters, fixtures=clamps, machine="tilt:60", spacing=3.0, tolerance=0.02,
              area_budget=0)  # fmt: skip

print(f"{len(targets)} faces of the cavity; take {result.selected}")
for cutter in result.cutters:
    worst = min(result.faces(cutter=cutter.id), key=lambda face: face.reached)
    print(f"{cutter.id}: reaches least of {worst.id}, {worst.reached:.0%}; lost for: {worst.reason}")
    if worst.worst is not None:
        depth, obstacle = worst.worst.depth_mm or 0.0, worst.worst.obstacle_face
        print(f"  at {worst.worst.point}: {obstacle} reaches {depth:.2f} mm into the tool at the best posture")

failing = next((cutter.id for cutter in result.cutters if not cutter.feasible), result.shown)
spots = [face.worst for face in result.faces(cutter=failing) if face.worst and face.worst.best_posture]
verdicts = compound(result, cutter=failing, at=spots[0] if spots else None)
if __name__ == "__main__":
    try:
        from ocp_vscode import show
    except ImportError:
        print(verdicts.show_topology(limit_class="Compound"))
    else:
        show(verdicts)
