"""FreeCAD runs this when its window starts."""
