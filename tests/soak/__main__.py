import argparse
import os
import sys

os.environ["PLAN_CUTTERS_CACHE"] = ""

from tests.soak import commands, exact, files, laws  # noqa: F401
from tests.soak.run import LAWS, Soak, flushed
from tests.soak.warm import warm


def main() -> int:
    words = argparse.ArgumentParser(prog="python -m tests.soak", description="Laws at random, for long.")
    words.add_argument("--minutes", type=float, default=30.0)
    words.add_argument("--seed", type=int, default=0)
    words.add_argument("--jobs", type=int, default=1, help="processes, each with cases of its own")
    words.add_argument("--only", metavar="LAW", action="append", choices=sorted(LAWS), help="one law; repeatable")
    words.add_argument("--case", type=int, metavar="SEED", help="that case alone")
    words.add_argument("--shrink", type=float, default=120.0, metavar="S", help="seconds to make smaller what falls")
    words.add_argument("--list", action="store_true", help="the laws")
    given = words.parse_args()
    chosen = [LAWS[name] for name in given.only or LAWS]
    if given.list:
        flushed("\n".join(f"{each.name}: {each.words}" for each in chosen))
        return 0
    warm()
    if given.case is not None:
        soak = Soak(chosen, shrink=given.shrink, tell=flushed)
        for row in soak.rows:
            outcome = soak.one(row, given.case)
            flushed(f"{row.law.name} --case {given.case}: {outcome.kind} {outcome.why}")
        return int(any(row.fell for row in soak.rows))
    return _many(chosen, given)


def _many(chosen, given) -> int:
    """Each job takes every so manyth of the laws' cases: seeds of its own."""
    others = []
    for k in range(1, given.jobs):
        pid = os.fork()
        if pid == 0:
            held = Soak(chosen, 1000 * k + given.seed, shrink=given.shrink, tell=flushed).run(given.minutes)
            os._exit(0 if held else 1)
        others.append(pid)
    held = Soak(chosen, given.seed, shrink=given.shrink, tell=flushed).run(given.minutes)
    codes = [os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) for pid in others]
    return int(not held or any(codes))


if __name__ == "__main__":
    sys.exit(main())
