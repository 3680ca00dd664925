"""Helpers of tests: parts, machine and tool files, slow twins, readers of results. No test module imports another one."""
