"""Steps inside CAD hosts. Nothing here registers itself at import."""
