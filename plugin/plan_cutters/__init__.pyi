"""What type checkers see of the names that `__init__.py` hands on lazily."""

from plan_cutters.calls import plan, posture_map
from plan_cutters.domain.cutter import Cutter
from plan_cutters.domain.fixture import Fixture
from plan_cutters.domain.holder import Holder, Segment
from plan_cutters.domain.machine import Axis, Machine
from plan_cutters.domain.placement import Placement
from plan_cutters.domain.posture import PostureRange
from plan_cutters.errors import CutterError, FixtureError, LibraryError, MachineError, OptionError, PlanError
from plan_cutters.judging.posture_maps import PostureMap, PostureMaps
from plan_cutters.options import Options
from plan_cutters.plan_file.model import Plan
from plan_cutters.result import Result
from plan_cutters.scene.scene import Scene
from plan_cutters_batch.run import plan_many

__version__: str
__all__ = [
    "Axis",
    "Cutter",
    "CutterError",
    "Fixture",
    "FixtureError",
    "Holder",
    "LibraryError",
    "Machine",
    "MachineError",
    "OptionError",
    "Options",
    "Placement",
    "Plan",
    "PlanError",
    "PostureMap",
    "PostureMaps",
    "PostureRange",
    "Result",
    "Scene",
    "Segment",
    "__version__",
    "plan",
    "plan_many",
    "posture_map",
]
