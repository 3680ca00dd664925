from plan_cutters.command.entry import plan_cutters

plan_cutters()
