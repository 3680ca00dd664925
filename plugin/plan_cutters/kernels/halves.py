"""The two trees of obstacles, one of what is shared and one of what is added: kernels walk one after the other.

Kernels alone, no entry: what these hand on are arrays, which nobody counts.
"""

from plan_cutters.kernels.jit import kernel


@kernel
def half(tree, which):
    """Triangles, boxes and depth of the first (0) or the second tree (1), and the number of its first triangle."""
    if which == 0:
        return tree.vertex, tree.box, tree.depth, 0
    return tree.more_vertex, tree.more_box, tree.more_depth, len(tree.vertex)


@kernel
def half_of(tree, triangle):
    """The triangles of the tree that a triangle is in, and its row there."""
    first = len(tree.vertex)
    if triangle < first:
        return tree.vertex, triangle
    return tree.more_vertex, triangle - first
