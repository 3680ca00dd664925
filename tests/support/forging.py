"""Other values for the leaves of a tree, and a tree with one of them."""


def forged(value):
    """Other values of the same kind, and null."""
    if isinstance(value, bool):
        return [not value]
    if isinstance(value, int):
        return [value + 1, value - 1, 10 * value + 50]
    if isinstance(value, float):
        return [1.07 * value + 0.5, 0.0 if abs(value) > 1e-6 else 1.0, float("nan")]
    if isinstance(value, str):
        return [f"{value} ", "other"]
    if isinstance(value, list):
        return [["more"]]
    if isinstance(value, dict):
        return [{"more": 1}]
    return [1, "more"]


def put(tree, path, value):
    """Set a leaf of a tree."""
    steps = path.replace("[", ".[").split(".")
    for step in steps[:-1]:
        tree = tree[int(step[1:-1]) if step.startswith("[") else step]
    last = steps[-1]
    tree[int(last[1:-1]) if last.startswith("[") else last] = value
