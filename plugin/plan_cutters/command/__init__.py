"""Words in, exit code out: the only room that prints and exits. May use everything."""
