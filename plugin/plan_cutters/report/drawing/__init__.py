"""Draw the part, posture maps and tools on sheets of matplotlib. May use: the story, the document, domain, a result's arrays."""
