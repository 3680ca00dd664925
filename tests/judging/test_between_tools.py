"""The area between samples for tools of other kinds: random contacts in served cells, against the exact surface."""

import numpy as np
import pytest

from cad_io import read_part
from plan_cutters import Cutter
from tests.support import shapes
from tests.support.contacts import dense, served
from tests.support.places import SAMPLES
from tests.support.tool_kinds import TOOLS
from tests.support.tool_profile import deepest


@pytest.mark.slow("draws many surfaces", but=("tapered bull",))
@pytest.mark.parametrize("kind", TOOLS)
def test_no_contact_of_a_served_cell_gouges_a_random_surface(kind):
    cutter = TOOLS[kind]
    rng = np.random.default_rng(1)
    part = read_part(shapes.shell(shapes.Patch.random(rng, height=4.0).face()))
    # Of a lens little is served where samples are far apart.
    budget, grid = (8000, 81) if kind == "lens" else (3000, 51)
    found, geometry, whole = served(part, cutter, budget=budget, grid=grid)
    print(kind, found.share, found.contacts)
    assert found.cells.face.size > 50, "nothing to look at"
    assert deepest(found, geometry, whole, cutter, dense(whole, 0.5), 120, rng) < 0.01 + 2e-3


def test_no_contact_between_samples_gouges_deeper_than_is_allowed():
    """A ball of twice the radius of a shallow trough: the border of the trough lies deepest in it, whatever the axis.

    At an angle phi from the contact the surface lies `r - sqrt(R^2 + d^2 + 2 R d cos(phi))` deep, d = r - R. The samples near the
    middle are reached. In the outer part of the cells of the last of them a contact gouges too deep: there, less than a cell is
    served.
    """
    R, r, half = 100.0, 200.0, 0.05
    d = r - R

    def depth(phi):
        return r - np.sqrt(R * R + d * d + 2.0 * R * d * np.cos(phi))

    allowed = float(depth(1.44 * half))
    part = read_part(shapes.shell(shapes.trough(R, half * R, 2.0 * half)))
    found, _, whole = served(part, Cutter.ball(radius=r, length=6 * r), budget=2000, grid=7, tolerance=allowed,
                             chord=0.01 * allowed)  # fmt: skip
    u0, u1 = whole.trim(1).box[:2]
    to_border = np.abs(found.cells.uv[:, 0] - 0.5 * (u0 + u1)) + 0.5 * found.cells.span[:, 0] + half
    assert found.share > 0.15
    assert depth(to_border).max() <= allowed


@pytest.mark.slow("judges thousands of contacts on a sample part")
@pytest.mark.parametrize("kind", TOOLS)
def test_no_contact_of_a_served_cell_gouges_a_sample_part(kind):
    cutter = TOOLS[kind]
    found, geometry, whole = served(SAMPLES / "blade.step", cutter, budget=60_000)
    worst = deepest(found, geometry, whole, cutter, dense(whole, 0.4), 2000, np.random.default_rng(1))
    print(kind, found.share, found.contacts, f"deepest {worst:.4f} mm")
    assert worst < 0.01 + 2e-3
