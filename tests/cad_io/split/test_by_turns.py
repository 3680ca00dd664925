"""Faces split along labels without an order: what lies on a face's own border counts as what lies inside."""

import numpy as np
import pytest

from cad_io.part import Part
from cad_io.split import split_by_turns
from tests.support.split_parts import labels, patch

#: Labels of few nodes, most of them on the border of the face; and the labels that have to be shown.
FIELDS = {
    "a row of the border": ([[0, 0, 0], [-1, 2, -1], [-1, 2, -1]], {0, 2}),
    "two rows against one": ([[1, 1, 1], [1, 1, 1], [4, 4, 4]], {1, 4}),
    "a corner whose piece holds no node inside it": ([[0, 0, 0], [7, 7, 8], [7, 7, 8]], {0, 7}),
    "all in four corners": ([[0, 0, 1, 1], [0, 0, 1, 1], [2, 2, 3, 3], [2, 2, 3, 3]], {0, 1, 2, 3}),
}


@pytest.mark.parametrize("name", FIELDS)
def test_labels_of_border_nodes_have_pieces_or_are_counted(name):
    field, shown = np.array(FIELDS[name][0]), FIELDS[name][1]
    part = Part(patch())
    number = part.faces[0].number
    found = split_by_turns(part, [labels(part, number, lambda x, y: field, len(field))])
    assert {piece.label for piece in found.pieces} >= shown
    without = ~np.isin(field, [piece.label for piece in found.pieces])
    assert found.dropped.get(number, 0) == (without & (field >= 0)).sum()
    assert found.whole == {}
