"""Does a posture serve the surface between samples? May use: search and what that uses."""
