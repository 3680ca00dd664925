"""The index of a batch (`index.csv`, `summary.json`, `index.html`)."""

import json
from collections.abc import Callable, Mapping, Sequence

from plan_cutters.batch.row import PartRow


def write_index(
    rows: Sequence[PartRow], put: Callable[[str, bytes], None], *, title: str, seconds: float, cluster: Mapping[str, object]
) -> None:  # fmt: skip
    """Write the index of all parts."""
    content = {
        "title": title,
        "seconds": seconds,
        "cluster": dict(cluster),
        "parts": [row.model_dump() for row in rows],
    }
    put("summary.json", json.dumps(content, indent=1).encode())
