"""Where the commands begin: nothing heavy is imported before an interrupt is one line and not a traceback."""

import os
import sys
from importlib import import_module

#: The commands, and the modules that they are in.
MODULES = {
    "plan-cutters": "cli",
    "plan-cutters-tools": "tools",
    "plan-cutters-machines": "machines",
    "plan-cutters-map": "map",
}


def plan_cutters() -> None:
    _begin("plan-cutters")


def tools() -> None:
    _begin("plan-cutters-tools")


def machines() -> None:
    _begin("plan-cutters-machines")


def point_map() -> None:
    _begin("plan-cutters-map")


def _begin(name: str) -> None:
    try:
        if name == "plan-cutters":
            from plan_cutters.command.worker import begin_early

            begin_early(sys.argv[1:])
        import_module(f"plan_cutters.command.{MODULES[name]}").main()
    except KeyboardInterrupt:
        os.write(2, f"{name}: interrupted; no file is half-written\n".encode())
        os._exit(130)
