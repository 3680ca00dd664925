"""FreeCAD runs this when it starts, with or without a window."""

from freecad.plan_cutters import watch

watch.start()
