"""Load what all cases need, once, before they run in copies of this process."""

import tempfile

from cad_io.kernel import silence
from plan_cutters import posture_map
from tests.soak.cases import Mill, Part, Setting, Tool
from tests.soak.solids import Body


def warm() -> None:
    """Plan one part with tools of several kinds, map a point, plan operations and check them."""
    silence()
    part = Part(((1, Body("box", (20.0, 20.0, 10.0))), (-1, Body("ball", (6.0,), at=(10.0, 10.0, 11.0)))))
    for kind in ("flat", "bull", "form re-entrant"):
        setting = Setting(part, Tool(kind, 1, bare=kind == "flat"), grid=3, step=45.0, tolerance=0.1)
        result = setting.planned(posture_maps=True, area_budget=100)
        posture_map(result.scene, point=tuple(result.samples.point[0]), cutter=setting.tool.cutter, rotations=[0.0])
    with tempfile.TemporaryDirectory() as folder:
        Setting(part, Tool("flat", 1), Mill(), grid=3, step=45.0, tolerance=0.1).planned(
            operations="both", feed=1000.0).write(folder, ["json", "npz"])  # fmt: skip
