"""Is there a posture? Searches for one, and what they share. May use: tool, linear, material, limits, intervals."""
