"""One tool and one point, one triangle, one tree: what reaches in, and the tilts at which it does. May use: linear."""
