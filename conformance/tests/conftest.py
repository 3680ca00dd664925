"""A small suite to work with: one part, made once a session."""

from pathlib import Path

import pytest

from conformance.made import generate
from conformance.made.parts import PARTS
from conformance.suite import Suite, read


@pytest.fixture(scope="session")
def small_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with the groove and 24 postures of each of its tools."""
    pytest.importorskip("cadquery")
    folder = tmp_path_factory.mktemp("suite")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(generate, "PARTS", {"v_groove": PARTS["v_groove"]})
        # Bounds have tests of their own (`test_bound`), and take seconds.
        patch.setattr(generate, "confirmed", lambda around, table: (table, 0))
        generate.generate(folder, 72)
    return folder


@pytest.fixture(scope="session")
def small(small_folder: Path) -> Suite:
    """Return the same, read."""
    return read("made", small_folder)
