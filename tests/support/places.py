"""Where the tests find things: the project, its samples, and real files that lie beside the project or not at all."""

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SAMPLES = ROOT / "samples"
SHARED = ROOT.parent / "shared"
DATA = SHARED / "data"
#: The packages, by name.
PACKAGES = {path.parent.name: path.parent for path in (*ROOT.glob("plugin/*/__init__.py"), ROOT / "cad_io/__init__.py")}


def real_file(name: str) -> Path:
    """A real file by its place below `shared/data`; the test is skipped where it is not at hand."""
    if not (DATA / name).is_file():
        pytest.skip(f"the real file {Path(name).name} is not at hand (shared/data/{Path(name).parent})")
    return DATA / name


def git(*words: str) -> str:
    """What git says of this checkout; empty where it is none."""
    return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True).stdout.strip()
