"""`python -m plan_cutters` is the command."""

from plan_cutters.command.entry import plan_cutters

plan_cutters()
