"""FreeCAD runs a script in its own Python."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

from tests.support.places import ROOT

CONSOLE = next(filter(None, map(shutil.which, ("freecadcmd", "FreeCADCmd", "freecad.cmd"))), None)

#: A script begins with the macro of operations, whose lines are in `said`.
HEAD = f"""
import json, os, shutil, sys
import FreeCAD as App, Part
macro, said, found = {{"__name__": "macro"}}, [], {{}}
text = open({str(ROOT / "freecad" / "PlanOperations.FCMacro")!r}, encoding="utf-8").read()
exec(compile(text, "PlanOperations.FCMacro", "exec"), macro)
macro["say"] = said.append
FOLDER = os.environ["PLAN_FOLDER"]
"""

#: What a session in FreeCAD's window begins with: it defines `session`, which fills `found`, and lets the event loop call `work`.
IN_WINDOW = """
import json, os, sys, time, traceback
from PySide import QtCore, QtGui
found = {}

def pump(until=lambda: False, seconds=0.4):
    end = time.monotonic() + seconds
    while time.monotonic() < end and not until():
        QtGui.QApplication.processEvents(QtCore.QEventLoop.AllEvents, 50)
        time.sleep(0.02)

def shot(name):
    pump()
    QtGui.QApplication.primaryScreen().grabWindow(0).save(name)

def work():
    try:
        session()
    except BaseException:
        traceback.print_exc()
    else:
        json.dump(found, open("found.json", "w"))
    sys.stdout.flush()
    os._exit(0)
"""


def run(words, script, folder, **more):
    """Run a script in FreeCAD with a home of its own; what it put into `found`."""
    (folder / "home").mkdir()
    (folder / "script.py").write_text(script + "\njson.dump(found, open('found.json', 'w'))\n", encoding="utf-8")
    # The command is that of this Python, and not one that FreeCAD's could import; compiled code is where it always is.
    ours = ["env", f"HOME={Path.home()}", f"PYTHONPATH={ROOT / 'plugin'}{os.pathsep}{ROOT}", sys.executable, "-m", "plan_cutters"]
    environment = {**os.environ, "PLAN_CUTTERS": " ".join(ours), "HOME": str(folder / "home"), **more}
    done = subprocess.run([*words, "script.py"], cwd=folder, env=environment, stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, timeout=200)  # fmt: skip
    if not (folder / "found.json").exists():
        raise AssertionError(done.stdout[-2000:] + done.stderr[-2000:])
    return json.loads((folder / "found.json").read_text())
