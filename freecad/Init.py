"""Where this folder alone was copied into Mod: let FreeCAD find `freecad.plan_cutters` in it.

As a whole repository, with package.xml at its root, it is found without this. FreeCAD runs the text within a function, so no name
of it is seen in an inner scope.
"""

import os
import sys

import freecad

for each in sys.path:
    if each not in freecad.__path__ and os.path.isfile(os.path.join(each, "plan_cutters", "watch.py")):
        freecad.__path__.append(each)
