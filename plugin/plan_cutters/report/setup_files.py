"""The setups that were proposed as setup files, which `--setup` reads: `setup-1.toml` and so on."""

import json
from functools import partial
from pathlib import Path

from plan_cutters.plan_file.setups import ProposedSetup
from plan_cutters.report.protocol import Judged


def setup_toml(setup: ProposedSetup) -> str:
    """Write a proposed setup as TOML: the part stands on a table across its axis, or in a vise or chuck.

    >>> print(setup_toml(ProposedSetup(axis=(0.0, 0.6, 0.8), stands_on=["F2"], promised=1.0)), end="")
    # Proposed by --setup auto: add the vise or the clamps to `fixtures`.
    unit = "mm"
    axis = [0.0, 0.6, 0.8]
    clamped = ["F2"]
    fixtures = ["table"]
    """
    first = "add the vise or the clamps to `fixtures`."
    if setup.clamping != "table":
        first = f"the {setup.clamping} grips {', '.join(setup.grips)}; put your own into `fixtures`."
    return (
        f'# Proposed by --setup auto: {first}\nunit = "mm"\naxis = {json.dumps(list(setup.axis))}\n'
        f"clamped = {json.dumps(setup.stands_on)}\nfixtures = {json.dumps(setup.fixtures)}\n"
    )


def _write(number: int, result: Judged, _split: object, path: Path) -> None:
    proposal = result.plan.setup_proposal
    assert proposal is not None, "written where setups were proposed"
    path.write_text(setup_toml(proposal.setups[number]), encoding="utf-8")


write_first, write_second, write_third = (partial(_write, number) for number in range(3))
