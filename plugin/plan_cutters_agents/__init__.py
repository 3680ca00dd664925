"""Tools for agents and other programs, by the Model Context Protocol; the command does the work, in a process of its own."""
