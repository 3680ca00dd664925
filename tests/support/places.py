"""Where the tests find things: the project, its samples, and real files that lie beside the project or not at all."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SAMPLES = ROOT / "samples"
SHARED = ROOT.parent / "shared"
DATA = SHARED / "data"
